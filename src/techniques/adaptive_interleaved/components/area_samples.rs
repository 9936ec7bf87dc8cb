//! Points that stand for the scene's area lights (Dubla 2009, section 3.3), of the components that send rays to them.
//! Shader: area_samples.glsl.

use crate::gpu::shader::structs::AreaSampleBlock;
use crate::lights::area::{AreaLight, area_lights};
use crate::techniques::Inputs;

/// Area lights, and how many points each has.
pub struct AreaSamples {
    areas: Vec<AreaLight>,
    point_count: u32,
}

impl AreaSamples {
    /// The lights of `--emissive` and `--ss-lights`, each with a point for each pixel of a tile in each of `most`
    /// iterations.
    pub fn new(inputs: &Inputs<'_>, tile_px: [u32; 2], most: u32) -> Self {
        let light_count = inputs.values.integer("ss-lights") as usize;
        let areas = if inputs.emissive_lights() { area_lights(inputs.scene, light_count) } else { Vec::new() };
        Self { areas, point_count: most * tile_px[0] * tile_px[1] }
    }

    /// Area lights.
    pub fn light_count(&self) -> u32 {
        self.areas.len() as u32
    }

    /// Bytes of all points.
    pub fn bytes(&self) -> u64 {
        u64::from(self.light_count()) * u64::from(self.point_count) * size_of::<AreaSampleBlock>() as u64
    }

    /// All points, light by light. A seed of its own for each light: points of two lights would be correlated.
    pub fn points(&self, inputs: &Inputs<'_>) -> Vec<AreaSampleBlock> {
        let seed = inputs.values.integer("seed") as u32;
        let points = |(index, light): (u32, &AreaLight)| {
            light.points(inputs.scene, self.point_count, seed ^ index.wrapping_mul(0x9e37_79b9))
        };
        (1u32..).zip(&self.areas).flat_map(points).collect()
    }
}
