//! A power station's hall: POWER of Clarberg & Munkberg 2014, table 1 (111,000 triangles, 286 draws, one light with
//! shadows, defocus), made anew. Valves and pipes at arm's length, turbines and tanks behind, forty metres to the far
//! wall: everything that a lens throws out of focus. Surfaces have a texture of colour and no other, as the paper's.
//!
//! The light is a floodlight in the yard that shines in through the open front, along the hall. z runs from the far wall (-28 m) to the
//! front (+12 m), x across, the floor is y = 0; metres.

mod building;
mod machines;

use glam::{DVec3, Mat4, dvec3, vec3, vec4};

use super::Values;
use super::assembly::{Assembly, Maps};
use super::patch::Detail;
use super::patterns::{self, Masonry};
use super::pieces::{Piece, count, divided, grid};
use super::shapes::{Mapping, face_of};
use crate::scene::Material;

/// With fewer the pipes would not be round.
pub const LEAST_TRIANGLES: u64 = 30_000;

const BAY_M: f64 = 4.0;
const BAY_COUNT: u32 = 10;
const FRONT_M: f64 = 12.0;
const BACK_M: f64 = FRONT_M - BAY_M * BAY_COUNT as f64;
/// From the middle to the side walls.
const HALF_WIDTH_M: f64 = 9.0;
/// Where the trusses of the roof lie.
const EAVES_M: f64 = 9.6;

/// Indices into `Scene::materials`. All 0 by default, for counting triangles without painting.
#[derive(Default)]
struct Materials {
    floor: usize,
    brick: usize,
    concrete: usize,
    roof: usize,
    steel: usize,
    green: usize,
    grey: usize,
    red: usize,
    yellow: usize,
    copper: usize,
    rust: usize,
    wood: usize,
    pane: usize,
}

fn materials(assembly: &mut Assembly, seed: u32) -> Materials {
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
struct Details {
    /// Pipes, valves, machines.
    fine: Detail,
    /// Flat walls and sheets.
    broad: Detail,
}

/// The middles of the bays along z, from the front.
fn bays() -> impl Iterator<Item = f64> {
    (0..BAY_COUNT).map(|bay| FRONT_M - (f64::from(bay) + 0.5) * BAY_M)
}

/// All pieces, with `wanted` triangles within 1 %.
fn plan(materials: &Materials, wanted: u64) -> Vec<Piece> {
    let all_but_floor = |edge_m: f64| {
        let details = Details { fine: Detail { edge_m }, broad: Detail { edge_m: 8.0 * edge_m } };
        let mut pieces = building::pieces(materials, details);
        pieces.extend(machines::pieces(materials, details));
        pieces
    };
    let mut pieces = divided(wanted - wanted / 30, [0.005, 4.0], all_but_floor);
    let length_m = FRONT_M - BACK_M + 6.0;
    let [columns, rows] = grid([2.0 * HALF_WIDTH_M, length_m], wanted.saturating_sub(count(&pieces)));
    let corner = |x: f64, z: f64| dvec3(x * HALF_WIDTH_M, 0.0, z);
    let (near, far) = (BACK_M + length_m, BACK_M);
    let corners = [corner(-1.0, near), corner(1.0, near), corner(1.0, far), corner(-1.0, far)];
    let patches = vec![face_of(corners, Mapping::Repeat { tile_m: 4.0 }, columns, rows)];
    pieces.push(Piece { name: "floor", material: materials.floor, patches, places: vec![Mat4::IDENTITY] });
    pieces
}

/// The scene for `triangles`; the seed chooses grain and stains.
pub fn make(values: &Values, seed: u64) -> Assembly {
    let mut assembly = Assembly::default();
    let materials = materials(&mut assembly, seed as u32);
    for Piece { name, material, patches, places } in plan(&materials, values.get("triangles")) {
        let mesh = assembly.mesh(name, material, &patches);
        for place in places {
            assembly.draw(mesh, place);
        }
    }
    // A tower in the yard, so far that near and far are not too unlike, and so low that it reaches under the roof.
    let ends = [dvec3(-2.6, 5.4, 38.0), dvec3(0.4, 4.2, 0.0)];
    assembly.spot_light("floodlight".to_owned(), ends, vec3(1.0, 0.88, 0.70) * FLOODLIGHT_CD, [0.36, 0.48]);
    for (name, eye, target, y_fov) in [
        ("valves", dvec3(0.9, 1.72, 11.4), dvec3(-0.5, 1.95, -6.0), 0.95),
        ("catwalk", dvec3(7.0, 5.0, 7.5), dvec3(-1.5, 1.6, -10.0), 0.9),
        ("crane", dvec3(-5.2, 8.6, 10.5), dvec3(1.0, 2.0, -9.0), 0.85),
    ] {
        assembly.camera(name, eye, target, y_fov);
    }
    assembly
}

/// White paint at the front that faces it is about white in the picture.
const FLOODLIGHT_CD: f32 = 6500.0;

/// A copy at each of these places.
fn at(places: impl IntoIterator<Item = DVec3>) -> Vec<Mat4> {
    places.into_iter().map(super::assembly::shifted).collect()
}
