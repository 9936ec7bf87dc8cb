//! Soft shadows as many hard ones, one a member (Keller and Heidrich 2001, sections 3 and 3.4, after Brotman and Badler 1984): each
//! light shines from one place of it.
//!
//! Places of an emissive surface are drawn by power, and each is a patch that shines for all of its light. Places of a sphere
//! (`--light-radius`) are drawn within it, each a point light of the light's own intensity: three coordinates of points that are
//! spread evenly over a sphere of four dimensions lie in a ball so that from everywhere far off they fill a disc evenly, as a
//! sphere does that is alike bright all over. Such a ball lights what lies outside it as its middle would (the shell theorem), so
//! that nothing but a shadow's edge has noise.
//!
//! Shadows of many lights would lie alike, were all of them at the same place of theirs: each turns the numbers of the member by
//! its own amounts.
//!
//! Why not places on the sphere's surface: half of them face away from any one point, and all that is lit is noisy (`chess` with
//! `--light-radius 0.2` at 160x90, one sample: RMSE 0.091 instead of 0.054).

use crate::error::{Error, Result};
use crate::gpu::shader::shading::light::LIGHT_PATCH;
use crate::gpu::shader::structs::{AreaSampleBlock, LightBlock};
use crate::lights::LightSet;
use crate::lights::area::{AreaLight, area_lights};
use crate::passes::direct::light_blocks;
use crate::sampling::basis::below_one;
use crate::sampling::sampler::recurrence;
use crate::scene::{Light, LightKind, Scene};
use crate::settings::{DirectShadow, Values};
use crate::techniques::Inputs;
use crate::techniques::interleaved_sampling::resources::NAME;
use glam::{Vec3, Vec4};
use std::f32::consts::TAU;

/// Emissive surfaces that are lights of their own; all beyond them are one more.
const MOST_AREA_LIGHTS: usize = 16;
/// Metres: farther than anything is.
const ENDLESS_M: f32 = 1e18;

/// Lights that are larger than a point.
pub struct SoftLights {
    areas: Vec<AreaLight>,
    typical: LightSet,
    /// Lights that have a size.
    pub count: usize,
    /// Steps from light to light.
    steps: Vec<f64>,
}

/// The lights of a member: each at one place.
pub struct MemberLights {
    pub set: LightSet,
    /// Those of them that are patches: the last ones.
    patches: Vec<AreaSampleBlock>,
}

impl SoftLights {
    /// Errors: lamps cast no shadows (exit code 2).
    pub fn new(inputs: &Inputs<'_>) -> Result<Self> {
        let values = inputs.values;
        let shadow: DirectShadow = values.choice("direct-shadow");
        if !matches!(shadow, DirectShadow::Ray | DirectShadow::Map) {
            let word = shadow.name();
            let why = format!("--effect soft-shadow with --direct-shadow {word}: lamps cast no shadows");
            return Err(Error::request(why).within(NAME).note("--direct-shadow ray and map let every light cast one"));
        }
        let areas = if inputs.emissive_lights() { area_lights(inputs.scene, MOST_AREA_LIGHTS) } else { Vec::new() };
        let is_soft = |light: &&Light| light.radius > 0.0 && !light.kind.is_directional();
        let count = areas.len() + inputs.lights.lights.iter().filter(is_soft).count();
        let steps = recurrence::steps(3);
        let typical = at(&areas, &steps, inputs.lights.clone(), inputs.scene, [0.5; 3]).set;
        Ok(Self { areas, typical, count, steps })
    }

    /// As many lights as any member has, of the same kinds.
    pub fn typical(&self) -> &LightSet {
        &self.typical
    }

    /// The lights of a member of these numbers, 0 to 1 without 1. `lights` and `scene`: at the member's moment.
    pub fn at(&self, lights: LightSet, scene: &Scene, numbers: [f32; 3]) -> MemberLights {
        at(&self.areas, &self.steps, lights, scene, numbers)
    }
}

fn at(areas: &[AreaLight], steps: &[f64], mut lights: LightSet, scene: &Scene, numbers: [f32; 3]) -> MemberLights {
    let start = numbers.map(f64::from);
    let mut own = (0..)
        .map(|index| recurrence::point(index, &start, steps))
        .map(|point| [0, 1, 2].map(|at| below_one(point[at])));
    for (light, numbers) in lights.lights.iter_mut().zip(own.by_ref()) {
        if !light.kind.is_directional() {
            light.position += light.radius * in_ball(numbers);
            light.radius = 0.0;
        }
    }
    let patches: Vec<AreaSampleBlock> =
        areas.iter().zip(own).map(|(area, [pick, along, _])| area.at(scene, [pick, along])).collect();
    lights.lights.extend(patches.iter().map(light_of));
    MemberLights { set: lights, patches }
}

/// Within the ball of radius 1: three of the four coordinates of a place on the sphere of four dimensions.
fn in_ball([u, v, w]: [f32; 3]) -> Vec3 {
    let (one, other) = ((1.0 - u).max(0.0).sqrt(), u.max(0.0).sqrt());
    Vec3::new(one * (TAU * v).cos(), one * (TAU * v).sin(), other * (TAU * w).cos())
}

fn three(v: [f32; 4]) -> Vec3 {
    Vec4::from_array(v).truncate()
}

/// A patch as the lights of maps are: it may shine to all sides.
fn light_of(patch: &AreaSampleBlock) -> Light {
    Light {
        name: String::new(),
        kind: LightKind::Point,
        intensity: three(patch.intensity),
        position: three(patch.position_ws),
        direction: three(patch.normal_ws),
        range: Some(ENDLESS_M),
        radius: 0.0,
    }
}

impl MemberLights {
    /// As shaders read them, each with its index.
    pub fn blocks(&self, values: &Values) -> Vec<LightBlock> {
        let mut blocks = light_blocks(&self.set, values);
        let first = blocks.len() - self.patches.len();
        for (block, patch) in blocks[first..].iter_mut().zip(&self.patches) {
            // The normal, and whether both sides shine.
            *block = LightBlock { kind: LIGHT_PATCH, direction_ws: patch.normal_ws, ..*block };
        }
        blocks
    }
}

impl From<LightSet> for MemberLights {
    /// Lights none of which is a patch.
    fn from(set: LightSet) -> Self {
        Self { set, patches: Vec::new() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Seen from anywhere a disc is filled evenly: as many places within each radius as its part of the disc has, and a quarter
    /// of the squared radius along each axis.
    #[test]
    fn places_of_a_sphere_fill_a_disc_evenly() {
        let count = 40_000u32;
        let numbers = |index| [0, 1, 2].map(|dimension| sobol_burley::sample(index, dimension, 5));
        let places: Vec<Vec3> = (0..count).map(|index| in_ball(numbers(index))).collect();
        assert!(places.iter().all(|place| place.length() <= 1.0 + 1e-5));
        for direction in [Vec3::X, Vec3::Z, Vec3::new(0.48, -0.6, 0.64)] {
            for radius in [0.3f32, 0.6, 0.9] {
                let is_within = |place: &&Vec3| place.reject_from_normalized(direction).length() < radius;
                let part = places.iter().filter(is_within).count() as f32 / count as f32;
                assert!((part - radius * radius).abs() < 0.01, "{part} within {radius} across {direction}");
            }
            let squared = places.iter().map(|place| place.dot(direction).powi(2)).sum::<f32>() / count as f32;
            assert!((squared - 0.25).abs() < 0.003, "{squared} along {direction}");
        }
    }

    /// What they give a point outside the sphere is what its middle does, along every axis.
    #[test]
    fn places_of_a_sphere_light_as_its_middle() {
        let count = 20_000u32;
        for at in [Vec3::new(1.6, 0.0, 0.0), Vec3::new(0.9, -1.1, 1.7)] {
            let numbers = |index| [0, 1, 2].map(|dimension| sobol_burley::sample(index, dimension, 9));
            let from = |place: Vec3| (place - at) / (place - at).length().powi(3);
            let mean = (0..count).map(|index| from(in_ball(numbers(index)))).sum::<Vec3>() / count as f32;
            let middle = from(Vec3::ZERO);
            assert!(mean.distance(middle) < 0.01 * middle.length(), "{mean} and {middle} at {at}");
        }
    }
}
