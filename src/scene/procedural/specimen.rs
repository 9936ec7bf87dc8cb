//! Thin bars along the edges of a cube: a frame for a volume (`--volume`), which fits into it. Some bars lie behind the volume
//! and some before it. With `rod=on` a bar goes through its middle, so that there is a surface within.
//!
//! The cube is centred at the origin and a metre wide, y up; metres.

use glam::{DVec3, Vec3, dvec3, vec3};

use super::assembly::Assembly;
use super::patch::Patch;
use super::shapes::{bar, tube};
use crate::scene::procedural::values::Values;
use crate::scene::{Light, LightKind, Material};

/// From the middle to the middle of a bar; half of a bar's width.
const HALF_M: f64 = 0.5;
const HALF_BAR_M: f64 = 0.006;
const ROD_RADIUS_M: f64 = 0.03;
/// From the upper left before the cube; lux.
const SUN_LUX: Vec3 = vec3(2.6, 2.5, 2.3);

/// The frame; the seed changes nothing.
pub fn make(values: &Values, _seed: u64) -> Assembly {
    let mut assembly = Assembly::default();
    let brass = assembly.material(Material::diffuse("brass", vec3(0.80, 0.62, 0.26)));
    assembly.fixed("frame", brass, &frame());
    if values.get("rod") == 1 {
        let steel = assembly.material(Material::diffuse("steel", vec3(0.62, 0.65, 0.70)));
        let end = dvec3(0.62, 0.46, 0.30);
        assembly.fixed("rod", steel, &tube(-end, end, ROD_RADIUS_M, 24));
    }
    assembly.scene.lights.push(Light {
        name: "key".to_owned(),
        kind: LightKind::Directional,
        intensity: SUN_LUX,
        position: Vec3::ZERO,
        direction: vec3(0.5, -0.7, -0.6).normalize(),
        range: None,
        radius: 0.0,
    });
    for (name, eye, y_fov) in [
        ("front", dvec3(0.42, 0.30, 2.1), 0.74),
        ("straight", dvec3(0.0, 0.0, 2.2), 0.64),
        ("above", dvec3(-1.1, 1.35, 1.3), 0.86),
        ("inside", dvec3(0.02, 0.05, 0.42), 1.2),
    ] {
        assembly.camera(name, eye, DVec3::ZERO, y_fov);
    }
    assembly
}

/// The twelve edges, which overlap in the corners by less than a bar's width.
fn frame() -> Vec<Patch> {
    let mut patches = Vec::new();
    for axis in 0..3 {
        for [i, j] in [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]] {
            let at = |along: f64| {
                let mut place = [0.0; 3];
                place[axis] = along;
                place[(axis + 1) % 3] = i * HALF_M;
                place[(axis + 2) % 3] = j * HALF_M;
                DVec3::from(place)
            };
            // Corners belong to the bars along x: no two faces lie in one plane.
            let end = HALF_M + if axis == 0 { HALF_BAR_M } else { -HALF_BAR_M };
            patches.extend(bar(at(-end), at(end), HALF_BAR_M));
        }
    }
    patches
}
