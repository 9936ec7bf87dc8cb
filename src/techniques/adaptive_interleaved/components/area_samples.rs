//! Points that stand for the scene's area lights (Dubla 2009, section 3.3), of the components that send rays to them.
//! Shader: area_samples.glsl.

use crate::gpu::shader::shading::light::LEAST_DISTANCE_SQUARED;
use crate::gpu::shader::structs::{AdaptiveParams, AreaSampleBlock, LightBlock};
use crate::lights::area::{AreaLight, area_lights};
use crate::sampling::pairs::in_order;
use crate::sampling::sobol;
use crate::shading::light::incident_from_sphere;
use crate::techniques::Inputs;
use glam::{Vec3, Vec4};

/// Area lights, and how many points each has.
pub struct AreaSamples {
    areas: Vec<AreaLight>,
    tile_px: [u32; 2],
    iterations: u32,
}

impl AreaSamples {
    /// The lights of `--emissive` and `--ss-lights`, each with a point for each pixel of a tile in each of `most`
    /// iterations.
    pub fn new(inputs: &Inputs<'_>, tile_px: [u32; 2], most: u32) -> Self {
        let light_count = inputs.values.integer("ss-lights") as usize;
        let areas = if inputs.emissive_lights() { area_lights(inputs.scene, light_count) } else { Vec::new() };
        Self { areas, tile_px, iterations: most }
    }

    /// Area lights.
    pub fn light_count(&self) -> u32 {
        self.areas.len() as u32
    }

    /// Bytes of all points.
    pub fn bytes(&self) -> u64 {
        let point_count = self.iterations * self.tile_px[0] * self.tile_px[1];
        u64::from(self.light_count()) * u64::from(point_count) * size_of::<AreaSampleBlock>() as u64
    }

    /// All points, light by light, as `--sampler` spreads them. A seed of its own for each light: points of two lights would be
    /// correlated.
    pub fn points(&self, inputs: &Inputs<'_>) -> Vec<AreaSampleBlock> {
        let (seed, sampler) = (inputs.values.integer("seed") as u32, inputs.values.choice("sampler"));
        let points = |(index, light): (u32, &AreaLight)| {
            let seed = seed ^ index.wrapping_mul(0x9e37_79b9);
            light.points(inputs.scene, &in_order(sampler, self.tile_px, self.iterations, seed))
        };
        (1u32..).zip(&self.areas).flat_map(points).collect()
    }
}

/// What a place receives of the index-th punctual light, from the point of its sphere that has the number `own`: direction
/// to it, distance, and irradiance of what faces it.
pub fn incident_of(
    params: &AdaptiveParams,
    light: &LightBlock,
    index: u32,
    position_ws: Vec3,
    own: u32,
) -> (Vec3, f32, Vec3) {
    incident_from_sphere(light, position_ws, sobol::pair(own, sobol::pair_seed(params.seed, index)))
}

/// Cosine at the light times the distance: 0 where it does not shine.
fn leaving_towards(light: &AreaSampleBlock, to_light: Vec3) -> f32 {
    let leaving = -Vec4::from_array(light.normal_ws).truncate().dot(to_light);
    if light.normal_ws[3] != 0.0 { leaving.abs() } else { leaving.max(0.0) }
}

/// Irradiance of a surface of this normal.
pub fn area_irradiance(light: &AreaSampleBlock, normal_ws: Vec3, to_light: Vec3) -> Vec3 {
    let facing = normal_ws.dot(to_light).max(0.0) * leaving_towards(light, to_light);
    // Both cosines carry one factor 1/d.
    let squared = to_light.length_squared().max(LEAST_DISTANCE_SQUARED);
    Vec4::from_array(light.intensity).truncate() * (facing / (squared * squared))
}

/// Irradiance of what faces the light.
pub fn facing_irradiance(light: &AreaSampleBlock, to_light: Vec3) -> Vec3 {
    let squared = to_light.length_squared().max(LEAST_DISTANCE_SQUARED);
    Vec4::from_array(light.intensity).truncate() * (leaving_towards(light, to_light) / (squared * squared.sqrt()))
}
