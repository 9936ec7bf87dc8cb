//! The host's part: the atlas of every mesh that is drawn, as shaders read it. What has none is refused.

use crate::error::{Error, Result};
use crate::gpu::shader::techniques::deep_shading::baseline::texture_space::atlas::{CHART_LEVEL_BITS, OWNER_RANK_BITS};
use crate::resident::groups_of;
use crate::scene::atlas::{Atlas, Flaw};
use crate::scene::{Mesh, Scene, procedural};
use crate::techniques::deep_shading::resources::NAME;
use glam::Vec2;
use rayon::prelude::*;

/// Owners' words hold one more than a triangle beside a rank.
const MOST_TRIANGLES: usize = (u32::MAX >> OWNER_RANK_BITS) as usize;

/// Atlases of all meshes in the order of `Geometry`: vertices one after the other, triangles by cluster.
pub struct Atlases {
    /// A place a vertex.
    pub coordinates: Vec<Vec2>,
    /// A word a triangle: its chart, and the coarsest level at which that is a texel wide.
    pub charts: Vec<u32>,
}

impl Atlases {
    /// For textures of `side_px` texels, a power of two. Meshes that nothing draws have an empty one.
    ///
    /// Errors: a mesh has no atlas; more triangles than an owner's word can name (exit code 2).
    pub fn of(scene: &Scene, side_px: u32) -> Result<Self> {
        let triangles: usize = scene.meshes.iter().map(Mesh::triangle_count).sum();
        if triangles > MOST_TRIANGLES {
            return Err(Error::request(format!(
                "--shading texture-space: {}: {triangles} triangles, and at most {MOST_TRIANGLES} can be told apart",
                scene.name
            ))
            .within(NAME));
        }
        let mut is_drawn = vec![false; scene.meshes.len()];
        scene.draws.iter().for_each(|draw| is_drawn[draw.mesh] = true);
        let meshes: Vec<_> = scene.meshes.iter().zip(is_drawn).collect();
        let made: Result<Vec<_>> =
            meshes.into_par_iter().map(|(mesh, is_drawn)| of_mesh(scene, mesh, is_drawn, side_px)).collect();
        let mut all = Self { coordinates: Vec::new(), charts: Vec::with_capacity(triangles) };
        for (coordinates, charts) in made? {
            all.coordinates.extend(coordinates);
            all.charts.extend(charts);
        }
        Ok(all)
    }
}

fn of_mesh(scene: &Scene, mesh: &Mesh, is_drawn: bool, side_px: u32) -> Result<(Vec<Vec2>, Vec<u32>)> {
    if !is_drawn {
        return Ok((vec![Vec2::ZERO; mesh.positions.len()], vec![0; mesh.triangle_count()]));
    }
    let atlas = Atlas::of(mesh, side_px).map_err(|flaws| refusal(&mesh.name, &flaws))?;
    let groups = groups_of(scene, mesh);
    let words = groups.iter().flatten().map(|triangle| {
        let chart = atlas.charts[*triangle as usize];
        chart << CHART_LEVEL_BITS | coarsest_level(atlas.sides[chart as usize], side_px)
    });
    let words = words.collect();
    Ok((atlas.coordinates, words))
}

/// The coarsest level at which a chart is as wide as a texel, so that a middle of one lies in it beside each of its places.
/// `side`: the chart's, a part of the texture's.
fn coarsest_level(side: f32, side_px: u32) -> u32 {
    let texels = (side * side_px as f32) as u32;
    texels.max(1).ilog2()
}

fn refusal(name: &str, flaws: &[(&str, Flaw)]) -> Error {
    let what: Vec<String> = flaws.iter().map(|(set, flaw)| format!("{set}: {flaw}")).collect();
    let what = if what.is_empty() { "it has no texture coordinates".to_owned() } else { what.join("; ") };
    let named: Vec<&str> = procedural::ALL.iter().map(|built_in| built_in.name).collect();
    Error::request(format!("--shading texture-space: mesh {name} has no atlas ({what})"))
        .within(NAME)
        .note("each triangle needs a place of a texture to itself, all within 0 to 1")
        .note(format!("the built-in scenes have it: {}; --shading deep needs none", named.join(", ")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::resident::Geometry;

    #[test]
    fn a_chart_ends_its_levels_where_it_is_a_texel_wide() {
        let levels = [1.0, 0.5, 0.01, 1.0 / 2048.0, 1e-6].map(|side| coarsest_level(side, 2048));
        assert_eq!(levels, [11, 10, 4, 0, 0]);
    }

    /// Words are of the triangles where the index buffer has them: neighbours there share what their meshes' lists share.
    #[test]
    fn words_follow_the_index_buffer() {
        let scene = procedural::build("lamps:objects=8", 1).unwrap().unwrap();
        assert!(scene.meshes.iter().any(|mesh| groups_of(&scene, mesh).len() > 1), "nothing is in another order");
        let (atlases, geometry) = (Atlases::of(&scene, 512).unwrap(), Geometry::of(&scene));
        assert_eq!(atlases.coordinates.len(), geometry.positions.len());
        assert_eq!(3 * atlases.charts.len(), geometry.indices.len());
        for call in geometry.calls(&scene) {
            let mesh = &scene.meshes[scene.draws[call.draw as usize].mesh];
            let atlas = Atlas::of(mesh, 512).unwrap();
            for triangle in call.first_index / 3..(call.first_index + call.index_count) / 3 {
                let corners = &geometry.indices[3 * triangle as usize..3 * triangle as usize + 3];
                let own =
                    (0..mesh.triangle_count()).find(|own| mesh.indices[3 * own..3 * own + 3] == *corners).unwrap();
                assert_eq!(atlases.charts[triangle as usize] >> CHART_LEVEL_BITS, atlas.charts[own], "{}", mesh.name);
            }
        }
    }

    #[test]
    fn a_mesh_without_an_atlas_is_named_with_what_is_wrong() {
        let mut scene = procedural::build("cornell", 1).unwrap().unwrap();
        for mesh in &mut scene.meshes {
            mesh.atlas.clear();
        }
        scene.meshes[2].uvs.fill(Vec2::ZERO);
        let error = Atlases::of(&scene, 512).map(|_| ()).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        let text = error.to_string();
        assert!(text.contains("has no atlas (first coordinates: triangle"), "{text}");
        scene.draws.clear();
        assert!(Atlases::of(&scene, 512).is_ok(), "nothing is drawn");
    }
}
