//! A flat plate of rings that shine, a metre wide and high, in a black frame, seen from straight before it: the signal by which
//! samplers are judged. The phase is `growth` d^2 / 2 cycles at distance d from the rings' middle, so that their frequency grows
//! evenly, by `growth` cycles a metre for each metre, and is `frequency` cycles a metre in the middle of the plate, across. The
//! rings' middle lies `frequency` / `growth` metres to the left of it. Half of each cycle shines.
//!
//! A picture H pixels high shows a metre: its pixel frequency is H cycles a metre.
//!
//! The plate stands in z = 0, its middle at the origin, y up; metres.

use glam::{DVec2, DVec3, Vec3, Vec4, dvec2, dvec3};

use super::assembly::Assembly;
use super::patch::{Detail, Patch, Point, sin_cos_turns};
use super::shapes::{Mapping, face};
use crate::scene::Material;
use crate::scene::procedural::values::Values;

const HALF_M: f64 = 0.5;
/// How wide the frame is, and how far before the plate.
const FRAME_M: f64 = 0.5;
const BEFORE_M: f64 = 0.01;

/// Greatest `frequency` and `growth`, and least `growth`, cycles a metre and for each metre.
pub const MOST_FREQUENCY: u64 = 2048;
pub const MOST_GROWTH: u64 = 2048;
pub const LEAST_GROWTH: u64 = 32;

/// The plate; the seed changes nothing.
pub fn make(values: &Values, _seed: u64) -> Assembly {
    let mut assembly = Assembly::default();
    let [frequency, growth] = ["frequency", "growth"].map(|key| values.get(key) as f64);
    let black = Vec4::new(0.0, 0.0, 0.0, 1.0);
    let shining = Material {
        name: "rings".to_owned(),
        base_color: black,
        emissive: Vec3::ONE,
        metallic: 0.0,
        ..Material::default()
    };
    let rings = assembly.material(shining);
    assembly.fixed("rings", rings, &bright(dvec2(-frequency / growth, 0.0), growth));
    let frame = assembly.material(Material { base_color: black, ..Material::diffuse("frame", Vec3::ZERO) });
    assembly.fixed("frame", frame, &around());
    // Half a metre high at half a metre is half a right angle.
    assembly.camera("straight", dvec3(0.0, 0.0, HALF_M), DVec3::ZERO, std::f32::consts::FRAC_PI_2);
    assembly
}

/// The half cycles that shine, where they are on the plate, with less than a segment beyond it.
fn bright(middle: DVec2, growth: f64) -> Vec<Patch> {
    let far = middle.abs() + HALF_M;
    let near = (middle.abs() - HALF_M).max(DVec2::ZERO);
    let cycles = |distance: f64| 0.5 * growth * distance * distance;
    let mut patches = Vec::new();
    for cycle in cycles(near.length()).floor() as u32..=cycles(far.length()).floor() as u32 {
        let radius = |half_cycles: u32| (f64::from(2 * cycle + half_cycles) / growth).sqrt();
        let radii = [radius(0), radius(1)];
        // A chord is nowhere farther from its arc than a 256th of a half cycle.
        let segments = ((16.0 * std::f64::consts::PI * radii[1] * growth.sqrt()) as u32).max(48);
        let corner = move |segment: u32, radius: f64| {
            let (sine, cosine) = sin_cos_turns(f64::from(segment % segments) / f64::from(segments));
            middle + radius * dvec2(cosine, sine)
        };
        let is_seen = |segment: u32| {
            let corners = [0, 1].map(|end| radii.map(|radius| corner(segment + end, radius)));
            let all = || corners.iter().flatten().copied();
            let [least, most] =
                [all().reduce(DVec2::min), all().reduce(DVec2::max)].map(|end| end.expect("four corners"));
            least.max_element() < HALF_M && most.min_element() > -HALF_M
        };
        let seen: Vec<u32> = (0..segments).filter(|segment| is_seen(*segment)).collect();
        for run in seen.chunk_by(|segment, next| segment + 1 == *next) {
            let (first, count) = (run[0], run.len() as u32);
            let patch = Patch::new(count, 1, move |s, t| {
                let turns = (f64::from(first) + s * f64::from(count)) / f64::from(segments);
                let (sine, cosine) = sin_cos_turns(turns);
                // s runs counter-clockwise: to its left is the middle.
                let at = middle + (radii[1] * (1.0 - t) + radii[0] * t) * dvec2(cosine, sine);
                Point { position: at.extend(0.0), uv: dvec2(s, 1.0 - t) }
            });
            patches.push(patch.collapsed(false, cycle == 0));
        }
    }
    patches
}

/// The frame's four sides.
fn around() -> Vec<Patch> {
    let end = HALF_M + FRAME_M;
    let side = |[left, bottom]: [f64; 2], [right, top]: [f64; 2]| {
        let corners = [[left, bottom], [right, bottom], [right, top], [left, top]];
        face(corners.map(|[x, y]| dvec3(x, y, BEFORE_M)), Mapping::Fit, Detail::COARSE)
    };
    vec![
        side([-end, HALF_M], [end, end]),
        side([-end, -end], [end, -HALF_M]),
        side([-end, -HALF_M], [-HALF_M, HALF_M]),
        side([HALF_M, -HALF_M], [end, HALF_M]),
    ]
}
