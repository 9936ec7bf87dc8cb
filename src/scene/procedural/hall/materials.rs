//! What the hall is made of.

use glam::{Vec3, vec3};

use crate::scene::procedural::assembly::{Assembly, Maps};
use crate::scene::procedural::patterns::{self, Masonry};
use crate::scene::{AlphaMode, Material};

/// Indices into `Scene::materials`. All 0 by default, for counting triangles without painting.
#[derive(Default)]
pub struct Materials {
    pub floor: usize,
    pub aisle_floor: usize,
    pub stylobate: usize,
    pub carpet: usize,
    pub pale_shaft: usize,
    pub red_shaft: usize,
    pub base: usize,
    pub capital: usize,
    pub arch: usize,
    pub nave_wall: usize,
    pub frieze: usize,
    pub cornice: usize,
    pub vault: usize,
    pub rosette: usize,
    pub rib: usize,
    pub aisle_vault: usize,
    pub aisle_wall: usize,
    pub wainscot: usize,
    pub end_wall: usize,
    pub window: usize,
    pub rose_window: usize,
    pub grille: usize,
    pub iron: usize,
    pub brass: usize,
    pub glow: usize,
    pub door: usize,
    pub bench: usize,
    pub dais: usize,
    pub copper: usize,
    pub glaze: usize,
    pub gold: usize,
    pub silver: usize,
    pub jade: usize,
    pub veil: usize,
}

fn named(name: &str) -> Material {
    Material { name: name.to_owned(), metallic: 0.0, ..Material::default() }
}

fn plain(name: &str, color: Vec3, metallic: f32, roughness: f32) -> Material {
    Material { base_color: color.extend(1.0), metallic, roughness, ..named(name) }
}

fn window(name: &str, radiance: f32) -> Material {
    Material { emissive: Vec3::splat(radiance), roughness: 0.4, ..named(name) }
}

/// Adds all of them to the scene; `seed` chooses their grain.
pub fn add(assembly: &mut Assembly, seed: u32) -> Materials {
    let fine = |relief: f32| Maps { size_px: 512, relief: Some(relief), metallic_roughness: false };
    let full = |relief: f32| Maps { size_px: 512, relief: Some(relief), metallic_roughness: true };
    let small = |relief: f32| Maps { size_px: 256, relief: Some(relief), metallic_roughness: false };
    let polished = Maps { size_px: 512, relief: None, metallic_roughness: true };
    let ashlar = |columns: u32, rows: u32, dark: [f32; 3], light: [f32; 3]| Masonry {
        columns,
        rows,
        dark,
        light,
        mortar: [0.48, 0.43, 0.36],
        joint: 0.05,
    };
    let nave_stones = ashlar(4, 8, [0.64, 0.55, 0.43], [0.78, 0.70, 0.57]);
    let end_stones = ashlar(2, 4, [0.60, 0.54, 0.46], [0.74, 0.68, 0.58]);
    let bricks = Masonry {
        columns: 8,
        rows: 20,
        dark: [0.47, 0.24, 0.18],
        light: [0.69, 0.40, 0.29],
        mortar: [0.62, 0.56, 0.49],
        joint: 0.14,
    };
    let dusk = [[0.36, 0.52, 0.82], [0.44, 0.60, 0.86], [0.52, 0.64, 0.80], [0.62, 0.66, 0.74]];
    let jewels = [
        [0.85, 0.18, 0.14],
        [0.95, 0.66, 0.20],
        [0.20, 0.36, 0.90],
        [0.24, 0.62, 0.78],
        [0.30, 0.62, 0.32],
        [0.58, 0.28, 0.72],
        [0.96, 0.88, 0.66],
    ];
    let a = assembly;
    Materials {
        floor: a.textured(named("marble_floor"), full(0.002), |at| patterns::marble_floor(at, seed)),
        aisle_floor: a.textured(named("terracotta"), full(0.006), |at| patterns::terracotta(at, seed ^ 1)),
        stylobate: a.textured(Material { roughness: 0.4, ..named("dark_marble") }, polished, |at| {
            patterns::marble(at, [0.23, 0.25, 0.27], [0.52, 0.52, 0.50], seed ^ 2)
        }),
        carpet: a.textured(named("carpet"), fine(0.004), |at| patterns::carpet(at, seed ^ 3)),
        pale_shaft: a.textured(named("pale_marble"), polished, |at| {
            patterns::marble(at, [0.88, 0.84, 0.77], [0.66, 0.58, 0.50], seed ^ 4)
        }),
        red_shaft: a.textured(named("red_marble"), polished, |at| {
            patterns::marble(at, [0.56, 0.25, 0.19], [0.82, 0.63, 0.54], seed ^ 5)
        }),
        base: a.textured(Material { roughness: 0.7, ..named("limestone") }, small(0.004), |at| {
            patterns::plaster(at, [0.80, 0.74, 0.64], seed ^ 6)
        }),
        capital: a
            .textured(named("gilded_stone"), full(0.006), |at| patterns::hammered(at, [0.90, 0.74, 0.44], seed ^ 7)),
        arch: a.textured(named("arch_stones"), small(0.02), |at| patterns::arch_stones(at, seed ^ 8)),
        nave_wall: a.textured(named("nave_wall"), fine(0.008), |at| patterns::masonry(at, &nave_stones, seed ^ 9)),
        frieze: a.textured(named("mosaic"), full(0.004), |at| patterns::mosaic(at, seed ^ 10)),
        cornice: a.textured(Material { roughness: 0.6, ..named("cornice") }, small(0.003), |at| {
            patterns::plaster(at, [0.84, 0.79, 0.70], seed ^ 11)
        }),
        vault: a
            .textured(named("vault_plaster"), small(0.004), |at| patterns::plaster(at, [0.80, 0.75, 0.67], seed ^ 12)),
        rosette: a.material(plain("rosette_gold", vec3(0.93, 0.68, 0.30), 1.0, 0.35)),
        rib: a.textured(named("rib_stone"), small(0.01), |at| patterns::arch_stones(at, seed ^ 13)),
        aisle_vault: a
            .textured(named("aisle_plaster"), small(0.005), |at| patterns::plaster(at, [0.76, 0.73, 0.68], seed ^ 14)),
        aisle_wall: a.textured(named("brick"), fine(0.008), |at| patterns::masonry(at, &bricks, seed ^ 15)),
        wainscot: a.textured(named("green_marble"), polished, |at| {
            patterns::marble(at, [0.17, 0.30, 0.23], [0.46, 0.58, 0.48], seed ^ 16)
        }),
        end_wall: a.textured(named("end_wall"), fine(0.008), |at| patterns::masonry(at, &end_stones, seed ^ 17)),
        window: a.shining(window("dusk_window", 0.8), 512, |at| patterns::leaded_glass(at, 6, &dusk, seed ^ 18)),
        rose_window: a
            .shining(window("stained_glass", 1.3), 512, |at| patterns::leaded_glass(at, 10, &jewels, seed ^ 19)),
        grille: a.textured(
            Material { alpha: AlphaMode::Mask { cutoff: 0.5 }, double_sided: true, ..named("grille") },
            Maps { size_px: 256, relief: None, metallic_roughness: true },
            patterns::grille,
        ),
        iron: a.material(plain("iron", vec3(0.12, 0.11, 0.10), 1.0, 0.6)),
        brass: a.textured(named("brass"), full(0.004), |at| patterns::hammered(at, [0.92, 0.77, 0.47], seed ^ 20)),
        glow: a.material(Material {
            emissive: vec3(7.0, 4.6, 2.2),
            ..plain("lamp_glass", vec3(0.02, 0.02, 0.02), 0.0, 0.5)
        }),
        door: a.textured(named("oak_door"), full(0.01), |at| {
            patterns::boards(at, [0.26, 0.15, 0.09], [0.50, 0.33, 0.20], seed ^ 21)
        }),
        bench: a.textured(named("walnut"), full(0.006), |at| {
            patterns::boards(at, [0.34, 0.20, 0.12], [0.58, 0.39, 0.25], seed ^ 22)
        }),
        dais: a.textured(named("white_marble"), polished, |at| {
            patterns::marble(at, [0.90, 0.89, 0.86], [0.60, 0.61, 0.64], seed ^ 23)
        }),
        copper: a.textured(named("copper"), full(0.006), |at| patterns::hammered(at, [0.93, 0.62, 0.48], seed ^ 24)),
        glaze: a.material(plain("blue_glaze", vec3(0.04, 0.16, 0.40), 0.0, 0.18)),
        gold: a.material(plain("gold", vec3(1.0, 0.77, 0.34), 1.0, 0.22)),
        silver: a.material(plain("silver", vec3(0.91, 0.90, 0.88), 1.0, 0.28)),
        jade: a.material(plain("jade", vec3(0.14, 0.42, 0.27), 0.0, 0.25)),
        veil: a.textured(
            Material { alpha: AlphaMode::Blend, double_sided: true, ..named("veil") },
            Maps { size_px: 256, relief: None, metallic_roughness: false },
            |at| patterns::veil(at, seed ^ 25),
        ),
    }
}
