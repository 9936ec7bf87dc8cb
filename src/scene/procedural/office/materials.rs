//! What the office is made of. Nothing is metal and nothing shines but its panels; no albedo is above 0.8.

use glam::{Vec3, vec3};

use crate::scene::Material;
use crate::scene::procedural::assembly::{Assembly, Maps};
use crate::scene::procedural::patterns;
use crate::scene::procedural::room::Walls;

/// Indices into `Scene::materials`.
pub struct Materials {
    pub walls: Walls,
    /// White lacquer: skirting, door, window frame, cases of the panels.
    pub lacquer: usize,
    /// What is seen through the window: the sky of an evening, as a screen.
    pub dusk: usize,
    pub slats: usize,
    /// Desks and seats.
    pub beech: usize,
    /// Shelves.
    pub oak: usize,
    pub steel: usize,
    pub charcoal: usize,
    pub cushion: usize,
    pub screen: usize,
    pub keys: usize,
    pub paper: usize,
    pub china: usize,
    pub clay: usize,
    pub soil: usize,
    pub leaf: usize,
    pub cork: usize,
    pub painting: usize,
    /// Covers of books, and binders.
    pub covers: [usize; 6],
}

impl Materials {
    pub fn add(assembly: &mut Assembly, seed: u32) -> Self {
        let maps = |size_px: u32| Maps { size_px, relief: None, metallic_roughness: false };
        let named = |name: &str| Material::diffuse(name, Vec3::ONE);
        let a = assembly;
        let white = a.textured(named("plaster"), maps(256), |at| patterns::plaster(at, [0.85, 0.84, 0.81], seed));
        let warm = a.textured(named("terracotta"), maps(256), |at| patterns::plaster(at, [0.78, 0.44, 0.31], seed ^ 1));
        let floor = a.textured(named("parquet"), maps(512), |at| {
            patterns::boards(at, [0.60, 0.47, 0.34], [0.80, 0.67, 0.51], seed ^ 2)
        });
        let ceiling = a.material(Material::diffuse("ceiling", vec3(0.78, 0.78, 0.76)));
        let mut plain = |name: &str, albedo: [f32; 3]| a.material(Material::diffuse(name, Vec3::from_array(albedo)));
        Self {
            walls: Walls { floor, ceiling, far: warm, near: white, left: white, right: white },
            lacquer: plain("lacquer", [0.74, 0.73, 0.70]),
            dusk: plain("dusk", [0.16, 0.25, 0.42]),
            slats: plain("slats", [0.72, 0.70, 0.64]),
            steel: plain("steel", [0.36, 0.37, 0.39]),
            charcoal: plain("charcoal", [0.055, 0.055, 0.06]),
            cushion: plain("cushion", [0.08, 0.20, 0.33]),
            screen: plain("screen", [0.02, 0.025, 0.03]),
            keys: plain("keys", [0.16, 0.16, 0.17]),
            paper: plain("paper", [0.78, 0.77, 0.73]),
            china: plain("china", [0.76, 0.74, 0.70]),
            clay: plain("clay", [0.52, 0.23, 0.13]),
            soil: plain("soil", [0.06, 0.04, 0.03]),
            leaf: plain("leaf", [0.09, 0.30, 0.07]),
            covers: [
                plain("red_cover", [0.48, 0.06, 0.05]),
                plain("navy_cover", [0.05, 0.09, 0.24]),
                plain("green_cover", [0.07, 0.24, 0.13]),
                plain("ochre_cover", [0.60, 0.38, 0.09]),
                plain("cream_cover", [0.70, 0.64, 0.50]),
                plain("grey_cover", [0.22, 0.22, 0.24]),
            ],
            beech: a.textured(named("beech"), maps(256), |at| {
                patterns::boards(at, [0.70, 0.54, 0.38], [0.80, 0.66, 0.49], seed ^ 3)
            }),
            oak: a.textured(named("oak"), maps(256), |at| {
                patterns::boards(at, [0.42, 0.29, 0.18], [0.58, 0.43, 0.28], seed ^ 4)
            }),
            cork: a.textured(named("cork"), maps(128), |at| patterns::plaster(at, [0.66, 0.47, 0.30], seed ^ 5)),
            painting: a.textured(named("painting"), maps(256), |at| {
                patterns::marble(at, [0.16, 0.36, 0.46], [0.86, 0.74, 0.48], seed ^ 6)
            }),
        }
    }
}
