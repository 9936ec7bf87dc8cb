//! What the arena is made of: all stone and cloth with colour and normals from pictures, most with roughness too.

use glam::{Vec3, vec3, vec4};

use crate::scene::Material;
use crate::scene::procedural::assembly::{Assembly, Maps};
use crate::scene::procedural::patterns::{self, Masonry};

/// Indices into `Scene::materials`. All 0 by default, for counting triangles without painting.
#[derive(Default)]
pub struct Materials {
    pub pavement: usize,
    pub wall: usize,
    pub dressed: usize,
    pub pier: usize,
    pub arch: usize,
    pub web: usize,
    pub niche: usize,
    pub stage: usize,
    pub statue: usize,
    pub glass: [usize; 2],
    pub dusk: usize,
    pub iron: usize,
    pub bronze: usize,
    pub gold: usize,
    pub silver: usize,
    pub wood: usize,
    pub cloth: [usize; 2],
    pub glow: usize,
}

impl Materials {
    /// Adds all of them to the scene; `seed` chooses their grain.
    pub fn add(assembly: &mut Assembly, seed: u32) -> Self {
        let named = |name: &str| Material { name: name.to_owned(), metallic: 0.0, ..Material::default() };
        let metal = |name: &str, color: Vec3, roughness: f32| Material {
            base_color: color.extend(1.0),
            metallic: 1.0,
            roughness,
            ..named(name)
        };
        let window = |name: &str, radiance: f32| Material { emissive: Vec3::splat(radiance), ..named(name) };
        let full = |size_px: u32, relief: f32| Maps { size_px, relief: Some(relief), metallic_roughness: true };
        let stones = |columns: u32, rows: u32, dark: [f32; 3], light: [f32; 3]| Masonry {
            columns,
            rows,
            dark,
            light,
            mortar: [0.40, 0.37, 0.33],
            joint: 0.06,
        };
        let ashlar = stones(4, 8, [0.50, 0.46, 0.40], [0.68, 0.63, 0.55]);
        let rubble = stones(6, 12, [0.42, 0.38, 0.36], [0.60, 0.54, 0.48]);
        let jewels = |hue: [[f32; 3]; 4], seed: u32| move |at: [f32; 2]| patterns::leaded_glass(at, 8, &hue, seed);
        let a = assembly;
        Self {
            pavement: a.textured(named("pavement"), full(512, 0.003), |at| patterns::marble_floor(at, seed)),
            wall: a.textured(named("ashlar"), full(512, 0.010), |at| patterns::masonry(at, &ashlar, seed ^ 1)),
            dressed: a.textured(named("dressed_stone"), full(256, 0.004), |at| {
                patterns::plaster(at, [0.72, 0.67, 0.58], seed ^ 2)
            }),
            pier: a.textured(named("pier_stone"), full(256, 0.006), |at| {
                patterns::plaster(at, [0.60, 0.56, 0.50], seed ^ 3)
            }),
            arch: a.textured(named("arch_stones"), full(256, 0.012), |at| patterns::arch_stones(at, seed ^ 4)),
            web: a.textured(named("rubble"), full(256, 0.010), |at| patterns::masonry(at, &rubble, seed ^ 5)),
            niche: a.textured(named("niche_plaster"), full(256, 0.005), |at| {
                patterns::plaster(at, [0.55, 0.42, 0.36], seed ^ 6)
            }),
            stage: a.textured(named("dark_marble"), full(256, 0.001), |at| {
                patterns::marble(at, [0.20, 0.21, 0.24], [0.50, 0.47, 0.44], seed ^ 7)
            }),
            statue: a.textured(named("white_marble"), full(256, 0.001), |at| {
                patterns::marble(at, [0.82, 0.80, 0.76], [0.60, 0.58, 0.57], seed ^ 8)
            }),
            glass: [
                ([[0.9, 0.2, 0.12], [0.95, 0.62, 0.18], [0.7, 0.1, 0.25], [0.98, 0.85, 0.5]], "red_window"),
                ([[0.15, 0.3, 0.9], [0.2, 0.6, 0.8], [0.3, 0.2, 0.7], [0.6, 0.8, 0.9]], "blue_window"),
            ]
            .map(|(hues, name)| a.shining(window(name, 0.9), 256, jewels(hues, seed ^ 9))),
            dusk: a.shining(
                window("dusk_window", 0.35),
                256,
                jewels([[0.36, 0.46, 0.82], [0.3, 0.4, 0.7], [0.45, 0.5, 0.75], [0.5, 0.45, 0.7]], seed ^ 10),
            ),
            iron: a.material(metal("iron", vec3(0.20, 0.19, 0.19), 0.5)),
            bronze: a.textured(named("bronze"), full(256, 0.005), |at| {
                patterns::hammered(at, [0.80, 0.58, 0.34], seed ^ 11)
            }),
            gold: a.material(metal("gold", vec3(1.0, 0.77, 0.34), 0.28)),
            silver: a.material(metal("silver", vec3(0.88, 0.88, 0.90), 0.3)),
            wood: a.textured(named("oak"), full(256, 0.008), |at| {
                patterns::boards(at, [0.24, 0.15, 0.09], [0.46, 0.31, 0.20], seed ^ 12)
            }),
            cloth: [("red_banner", [0.55, 0.05, 0.06]), ("blue_banner", [0.08, 0.12, 0.42])].map(|(name, field)| {
                let maps = Maps { size_px: 256, relief: Some(0.004), metallic_roughness: false };
                let material = Material { double_sided: true, ..named(name) };
                a.textured(material, maps, |at| patterns::banner(at, field, seed ^ 13))
            }),
            glow: a.material(Material {
                base_color: vec4(0.02, 0.02, 0.02, 1.0),
                emissive: vec3(1.6, 0.75, 0.22),
                ..named("flame")
            }),
        }
    }
}
