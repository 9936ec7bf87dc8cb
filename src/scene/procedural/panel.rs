//! A flat square panel, parted into triangles of one size and seen from straight before it, two metres away, on black: nothing hides any of
//! it, and a lens that is focused elsewhere blurs all of it alike, within the picture up to 0.23 m. What shading rates depend on can
//! be seen alone on it.
//!
//! Its edges are turned against those of the picture, so that pixels cut triangles in all ways. A picture H pixels high shows 1.237 m, and
//! each square of two triangles is 0.8 / `parts` metres wide.
//!
//! The panel stands in z = 0, its middle at the origin, y up; metres.

use glam::{DVec3, Vec3, dvec2, dvec3, vec3};

use super::assembly::Assembly;
use super::patch::{Patch, Point, sin_cos_turns};
use crate::scene::procedural::values::Values;
use crate::scene::{Light, LightKind, Material};

/// Length of its sides.
pub const SIDE_M: f64 = 0.8;
const EYE_M: f64 = 2.0;
/// Angle of the picture's height, radians.
const Y_FOV: f32 = 0.6;
/// A part of a turn of which no small multiple is a quarter.
const TURNS: f64 = 0.0484;
/// A lamp before the upper left part; candela.
const LAMP_M: DVec3 = dvec3(-0.3, 0.25, 0.5);
const LAMP_CD: Vec3 = vec3(1.0, 0.95, 0.85);

/// Most squares along a side: 7.2 million triangles.
pub const MOST_PARTS: u64 = 1900;

/// How high the picture is where the panel stands, metres.
pub fn picture_height_m() -> f64 {
    2.0 * EYE_M * (0.5 * f64::from(Y_FOV)).tan()
}

/// How wide blur may be that is within the picture, metres.
pub fn most_blur_m() -> f64 {
    let (sine, cosine) = sin_cos_turns(TURNS);
    picture_height_m() - SIDE_M * (cosine + sine)
}

/// The panel; the seed changes nothing.
pub fn make(values: &Values, _seed: u64) -> Assembly {
    let mut assembly = Assembly::default();
    let parts = values.get("parts") as u32;
    let plaster = assembly.material(Material::diffuse("plaster", vec3(0.72, 0.70, 0.66)));
    let (sine, cosine) = sin_cos_turns(TURNS);
    let panel = Patch::new(parts, parts, move |s, t| {
        let at = SIDE_M * (dvec2(s, t) - 0.5);
        Point { position: dvec3(at.x * cosine - at.y * sine, at.x * sine + at.y * cosine, 0.0), uv: dvec2(s, 1.0 - t) }
    });
    assembly.fixed("panel", plaster, &[panel]);
    assembly.scene.lights.push(Light {
        name: "lamp".to_owned(),
        kind: LightKind::Point,
        intensity: LAMP_CD,
        position: LAMP_M.as_vec3(),
        direction: Vec3::NEG_Z,
        range: None,
        radius: 0.0,
    });
    assembly.camera("straight", dvec3(0.0, 0.0, EYE_M), DVec3::ZERO, Y_FOV);
    assembly
}
