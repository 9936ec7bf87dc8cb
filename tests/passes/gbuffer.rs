//! What the G-buffer says of each pixel beside its surface: the material's id (Segovia 2006, section 4.1).

use crate::support::boxes::{camera, rectangle};
use crate::support::choices::words;
use crate::support::placing_steps;
use crate::support::seen::{self, Seen};
use crate::support::watched::{Watched, both};
use glam::{Vec3, Vec4, vec3};
use quincunx::scene::{Material, Scene};
use std::collections::BTreeSet;

/// Tiles a row and rows of them: more materials than eight bits can distinguish.
const TILES: [usize; 2] = [24, 14];
/// Has no factor in common with the count of tiles.
const STRIDE: usize = 143;

/// A wall of tiles, each with a material of its own, in another order than the draws'; every 11th tile is missing.
fn tiles(changed: impl Fn(usize, &mut Scene)) -> Scene {
    let mut scene = Scene { name: "tiles".to_owned(), ..Scene::default() };
    let [across, down] = TILES;
    let count = across * down;
    for tile in 0..count {
        let center = vec3((tile % across) as f32, (tile / across) as f32, 0.0);
        let grey = Material::diffuse("tile", Vec3::splat(0.2 + 0.6 * tile as f32 / count as f32));
        rectangle(&mut scene, center, 0.5 * Vec3::X, 0.5 * Vec3::Y, grey);
        changed(tile, &mut scene);
    }
    for (tile, mesh) in scene.meshes.iter_mut().enumerate() {
        mesh.material = (tile * STRIDE + 5) % count;
    }
    scene.draws.retain(|draw| draw.mesh % 11 != 4);
    let middle = vec3(0.5 * across as f32, 0.5 * down as f32, 0.0);
    scene.cameras.push(camera(middle + vec3(3.0, 2.0, 12.0), middle, 0.9));
    scene
}

/// The ids of `changes` are those of the materials that rays see. Returns how many materials are seen.
fn require_ids(watched: &Watched, technique: &str, changes: &[(&str, &str)]) -> usize {
    let renderer = watched.render_stages(technique, changes, &["gbuffer.color.id"]);
    let ids = watched.integers(&renderer, "gbuffer.color.id");
    let scene = &watched.session.scene;
    let sources = seen::sources(watched, &renderer.view);
    let width = renderer.view.extent.width as usize;
    let mut found = BTreeSet::new();
    let mut unclear = 0;
    for (index, (id, seen)) in ids.iter().zip(&sources).enumerate() {
        let expected = match seen {
            Seen::Unclear => {
                unclear += 1;
                continue;
            }
            Seen::Nothing => 0,
            Seen::Surface(source) => scene.meshes[scene.draws[source.draw as usize].mesh].material,
        };
        let place = (index % width, index / width);
        assert_eq!(*id as usize, expected, "{technique} with {changes:?}: {place:?}, which shows {seen:?}");
        found.insert(expected);
    }
    assert_eq!(ids.len(), sources.len());
    // One in twenty, or more where edges are placed more coarsely.
    let most = 0.05 * placing_steps(&watched.session.gpu.caps);
    assert!((unclear as f64) < most * ids.len() as f64, "{unclear} of {} pixels show an edge", ids.len());
    found.len()
}

#[test]
fn each_pixel_has_the_id_of_the_material_that_it_shows() {
    // A tile that shines adds an image; colours of vertices are read by other variants of the shaders.
    let shines = |tile: usize, scene: &mut Scene| {
        if tile == 40 {
            scene.materials[tile].emissive = Vec3::ONE;
        }
    };
    let colored = |tile: usize, scene: &mut Scene| {
        if tile == 41 {
            scene.meshes[tile].colors = vec![Vec4::new(0.5, 1.0, 1.0, 1.0); 4];
        }
    };
    let common = [("size", "150x90")];
    let plain = Watched::with_scene(tiles(|_, _| {}));
    for position in words("deferred", "position") {
        let changes = both(&common, &[("position", position)]);
        assert!(require_ids(&plain, "deferred", &changes) > 256, "more than eight bits tell apart are seen");
    }
    require_ids(&plain, "interleaved_deferred", &both(&common, &[("vpls", "16")]));
    for watched in [Watched::with_scene(tiles(shines)), Watched::with_scene(tiles(colored))] {
        require_ids(&watched, "deferred", &common);
    }
    let lamps = Watched::open("lamps");
    assert!(require_ids(&lamps, "deferred", &common) > 3, "materials of the lamps are seen");
}
