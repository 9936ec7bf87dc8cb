//! What the desk and its room are made of, and how large the desk is. Nothing is metal, and nothing shines but the
//! lamp's disc.

use glam::{DVec3, Vec3, dvec3};

use crate::scene::Material;
use crate::scene::procedural::assembly::{Assembly, Maps};
use crate::scene::procedural::patterns;
use crate::scene::procedural::room::Walls;

/// Width, height and depth of the desk.
pub const DESK_M: DVec3 = dvec3(1.5, 0.75, 0.8);

/// Indices into `Scene::materials`.
pub struct Materials {
    pub walls: Walls,
    pub oak: usize,
    pub lacquer: usize,
    /// The lamp.
    pub enamel: usize,
    pub charcoal: usize,
    pub steel: usize,
    pub paper: usize,
    pub china: usize,
    pub clay: usize,
    pub soil: usize,
    pub leaf: usize,
    pub wood: usize,
    /// Covers, pencils and what else has a colour.
    pub colors: [usize; 6],
}

impl Materials {
    pub fn add(assembly: &mut Assembly, seed: u32) -> Self {
        let maps = Maps { size_px: 256, relief: None, metallic_roughness: false };
        let named = |name: &str| Material::diffuse(name, Vec3::ONE);
        let a = assembly;
        let far = a.textured(named("blue_plaster"), maps, |at| patterns::plaster(at, [0.56, 0.68, 0.72], seed));
        let oak = a.textured(named("oak"), Maps { size_px: 512, ..maps }, |at| {
            patterns::boards(at, [0.52, 0.36, 0.22], [0.70, 0.52, 0.34], seed ^ 1)
        });
        let mut plain = |name: &str, albedo: [f32; 3]| a.material(Material::diffuse(name, Vec3::from_array(albedo)));
        let white = plain("white", [0.72, 0.70, 0.66]);
        let floor = plain("carpet", [0.24, 0.17, 0.14]);
        Self {
            walls: Walls { floor, ceiling: white, far, near: white, left: white, right: white },
            oak,
            lacquer: plain("lacquer", [0.70, 0.69, 0.66]),
            enamel: plain("enamel", [0.10, 0.30, 0.28]),
            charcoal: plain("charcoal", [0.05, 0.05, 0.055]),
            steel: plain("steel", [0.42, 0.43, 0.45]),
            paper: plain("paper", [0.78, 0.76, 0.71]),
            china: plain("china", [0.75, 0.73, 0.68]),
            clay: plain("clay", [0.55, 0.25, 0.14]),
            soil: plain("soil", [0.06, 0.04, 0.03]),
            leaf: plain("leaf", [0.10, 0.32, 0.08]),
            wood: plain("pencil_wood", [0.66, 0.47, 0.28]),
            colors: [
                plain("red", [0.55, 0.06, 0.04]),
                plain("navy", [0.05, 0.09, 0.27]),
                plain("green", [0.08, 0.28, 0.13]),
                plain("yellow", [0.70, 0.46, 0.06]),
                plain("cream", [0.70, 0.63, 0.48]),
                plain("teal", [0.06, 0.30, 0.34]),
            ],
        }
    }
}
