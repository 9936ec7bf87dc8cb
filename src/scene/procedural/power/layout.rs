//! Where the power plant's parts stand, how many triangles each gets, and what they are made of.

use crate::scene::Material;
use crate::scene::procedural::assembly::{Assembly, Maps};
use crate::scene::procedural::patch::Detail;
use crate::scene::procedural::patterns::{self, Masonry};
use glam::{DVec3, Mat4, vec3, vec4};

pub const BAY_M: f64 = 4.0;

pub const BAY_COUNT: u32 = 10;

pub const FRONT_M: f64 = 12.0;

pub const BACK_M: f64 = FRONT_M - BAY_M * BAY_COUNT as f64;

/// From the middle to the side walls.
pub const HALF_WIDTH_M: f64 = 9.0;

/// Where the trusses of the roof lie.
pub const EAVES_M: f64 = 9.6;

/// Indices into `Scene::materials`. All 0 by default, for counting triangles without painting.
#[derive(Default)]
pub struct Materials {
    pub(super) floor: usize,
    pub(super) brick: usize,
    pub(super) concrete: usize,
    pub(super) roof: usize,
    pub(super) steel: usize,
    pub(super) green: usize,
    pub(super) grey: usize,
    pub(super) red: usize,
    pub(super) yellow: usize,
    pub(super) copper: usize,
    pub(super) rust: usize,
    pub(super) wood: usize,
    pub(super) pane: usize,
}

pub fn materials(assembly: &mut Assembly, seed: u32) -> Materials {
    let maps = Maps { size_px: 256, relief: None, metallic_roughness: false };
    let named = |name: &str, roughness: f32| Material {
        name: name.to_owned(),
        metallic: 0.0,
        roughness,
        ..Material::default()
    };
    let bricks = Masonry {
        columns: 6,
        rows: 14,
        dark: [0.44, 0.24, 0.18],
        light: [0.66, 0.42, 0.32],
        mortar: [0.56, 0.52, 0.48],
        joint: 0.13,
    };
    let a = assembly;
    // Paint that has been rubbed and stained.
    let mut paint = |name: &str, roughness: f32, color: [f32; 3], seed: u32| {
        a.textured(named(name, roughness), maps, |at| patterns::plaster(at, color, seed))
    };
    let painted = Materials {
        concrete: paint("concrete", 0.9, [0.60, 0.58, 0.55], seed),
        roof: paint("sheet_metal", 0.6, [0.36, 0.37, 0.38], seed ^ 1),
        steel: paint("steel", 0.45, [0.30, 0.33, 0.37], seed ^ 2),
        green: paint("green_paint", 0.35, [0.22, 0.46, 0.38], seed ^ 3),
        grey: paint("grey_paint", 0.4, [0.66, 0.68, 0.68], seed ^ 4),
        red: paint("red_paint", 0.35, [0.68, 0.12, 0.08], seed ^ 5),
        yellow: paint("yellow_paint", 0.4, [0.86, 0.60, 0.10], seed ^ 6),
        ..Materials::default()
    };
    Materials {
        floor: a.textured(named("tiles", 0.5), Maps { size_px: 512, ..maps }, |at| {
            patterns::checker(at, 8, [[0.62, 0.60, 0.56], [0.50, 0.46, 0.42]], seed ^ 7)
        }),
        brick: a.textured(named("brick", 0.9), maps, |at| patterns::masonry(at, &bricks, seed ^ 8)),
        copper: a.textured(named("copper", 0.4), maps, |at| patterns::hammered(at, [0.80, 0.50, 0.36], seed ^ 9)),
        rust: a.textured(named("rust", 0.9), maps, |at| {
            patterns::marble(at, [0.46, 0.26, 0.17], [0.64, 0.44, 0.30], seed ^ 10)
        }),
        wood: a.textured(named("boards", 0.8), maps, |at| {
            patterns::boards(at, [0.40, 0.28, 0.18], [0.66, 0.50, 0.34], seed ^ 11)
        }),
        pane: a.material(Material {
            base_color: vec4(0.02, 0.02, 0.02, 1.0),
            emissive: vec3(0.42, 0.55, 0.70),
            ..named("sky_pane", 0.3)
        }),
        ..painted
    }
}

/// The edge lengths of the hall's parts, for one common scale.
#[derive(Clone, Copy)]
pub struct Details {
    /// Pipes, valves, machines.
    pub(super) fine: Detail,
    /// Flat walls and sheets.
    pub(super) broad: Detail,
}

/// The middles of the bays along z, from the front.
pub fn bays() -> impl Iterator<Item = f64> {
    (0..BAY_COUNT).map(|bay| FRONT_M - (f64::from(bay) + 0.5) * BAY_M)
}

/// A copy at each of these places.
pub fn at(places: impl IntoIterator<Item = DVec3>) -> Vec<Mat4> {
    places.into_iter().map(crate::scene::procedural::assembly::shifted).collect()
}
