//! `--depth-prepass`: the same bits with and without it, where surfaces lie in one place too.

use crate::support;
use crate::support::watched::{Changes, Watched, both};
use glam::{Vec4, vec4};
use quincunx::scene::{self, AlphaMode, Scene};

const TECHNIQUES: [&str; 2] = ["forward", "inferred_lighting"];
const SIZE: (&str, &str) = ("size", "161x91");
const OFF: (&str, &str) = ("depth-prepass", "off");
const ON: (&str, &str) = ("depth-prepass", "on");

#[track_caller]
fn require_one_picture(watched: &Watched, technique: &str, common: Changes<'_>, variants: &[Changes<'_>]) -> String {
    let first = watched.hash(technique, &both(common, variants[0]));
    for variant in &variants[1..] {
        let found = watched.hash(technique, &both(common, variant));
        assert_eq!(found, first, "{technique}, {variant:?} with {common:?}");
    }
    first
}

#[test]
fn pictures_are_the_same_without_it() {
    let everything = [("geometry", "all"), ("alias", "off")];
    let variants = [vec![OFF], vec![ON], both(&[OFF], &everything), both(&[ON], &everything)];
    let variants: Vec<Changes<'_>> = variants.iter().map(Vec::as_slice).collect();
    // The last has BLEND surfaces, which are tested against what the pre-pass left.
    for scene in ["cornell", "lamps:objects=40,lights=60", "hall:triangles=8000", "fence:lights=6"] {
        let watched = Watched::open(scene);
        for technique in TECHNIQUES {
            require_one_picture(&watched, technique, &[SIZE], &variants);
        }
    }
    // With several samples a driver may look for the place that is shaded among those that pass the depth test.
    let watched = Watched::open("lamps:objects=40,lights=60");
    for technique in TECHNIQUES {
        for prepass in [ON, OFF] {
            let variants: [Changes<'_>; 2] = [&[("geometry", "all")], &[("geometry", "culled")]];
            require_one_picture(&watched, technique, &[SIZE, ("msaa", "4"), prepass], &variants);
        }
    }
}

/// Every surface once more in its own place, in another colour and, where `alpha` says so, cut out nowhere.
fn doubled(colors: &[(Vec4, AlphaMode)]) -> Scene {
    let mut scene = scene::load("cornell", 1).unwrap();
    let drawn = scene.draws.clone();
    for (color, alpha) in colors {
        let mut material = scene.materials[0].clone();
        (material.base_color, material.base_color_texture, material.alpha) = (*color, None, *alpha);
        scene.materials.push(material);
        for draw in &drawn {
            let mut mesh = scene.meshes[draw.mesh].clone();
            mesh.material = scene.materials.len() - 1;
            scene.meshes.push(mesh);
            scene.draws.push(scene::Draw { mesh: scene.meshes.len() - 1, ..*draw });
        }
    }
    scene
}

#[test]
fn of_surfaces_in_one_place_the_same_is_seen() {
    let red = (vec4(0.8, 0.1, 0.1, 1.0), AlphaMode::Opaque);
    let cut = (vec4(0.1, 0.1, 0.8, 1.0), AlphaMode::Mask { cutoff: 0.5 });
    for colors in [&[red][..], &[cut], &[cut, red]] {
        let watched = Watched::with_scene(doubled(colors));
        for technique in TECHNIQUES {
            require_one_picture(&watched, technique, &[SIZE, ("brdf", "lambert")], &[&[OFF], &[ON]]);
        }
    }
}

/// Triangles of one mesh in one place: the last one is seen, in G-buffers and in what is shaded as it is drawn.
#[test]
fn of_triangles_in_one_place_the_last_is_seen() {
    let mut scene = scene::load("cornell", 1).unwrap();
    for mesh in &mut scene.meshes {
        let (vertices, corners) = (mesh.positions.len(), mesh.indices.len());
        mesh.colors = vec![Vec4::ONE; vertices];
        for vertex in 0..vertices {
            mesh.repeat_vertex(vertex);
        }
        mesh.colors[vertices..].fill(vec4(1.0, 0.0, 0.0, 1.0));
        mesh.indices.extend_from_within(..);
        mesh.indices[corners..].iter_mut().for_each(|index| *index += vertices as u32);
    }
    let watched = Watched::with_scene(scene);
    let others = ["deferred", "interleaved_deferred", "interleaved_sampling"];
    let mut ways: Vec<(&str, Changes<'_>)> = others.iter().map(|technique| (*technique, &[] as Changes<'_>)).collect();
    ways.extend(TECHNIQUES.iter().flat_map(|technique| [(*technique, &[ON] as Changes<'_>), (technique, &[OFF])]));
    for (technique, changes) in ways {
        let picture = watched.picture(technique, &both(&[SIZE, ("brdf", "lambert"), ("lights", "3")], changes));
        // The lamp's own face is brighter.
        let lit = |channel: usize| picture.pixels.iter().filter(|pixel| (1e-3..2.0).contains(&pixel[channel])).count();
        let (red, green) = (lit(0), lit(1));
        assert!(red > picture.pixels.len() / 2, "{technique}, {changes:?}: {red} pixels are red");
        assert_eq!(green, 0, "{technique}, {changes:?}: pixels that are not");
    }
}

/// Holes, vertex colours, glass and grates.
#[test]
fn real_maps_have_one_picture_too() {
    let Some(folder) = support::shared_scenes() else { return };
    for map in ["maps/kaos.glb", "maps/pul1duel-oa.glb"] {
        let watched = Watched::open(folder.join(map).to_str().unwrap());
        let common = [SIZE, ("lights", "60"), ("sun", "off")];
        require_one_picture(&watched, "inferred_lighting", &common, &[&[OFF], &[ON]]);
        require_one_picture(&watched, "inferred_lighting", &both(&common, &[("alpha", "test")]), &[&[OFF], &[ON]]);
    }
}
