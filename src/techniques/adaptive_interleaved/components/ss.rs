//! Soft shadows (SS): light straight from area lights, and from punctual ones, whose shadows are hard. Dubla 2009,
//! section 3.3. Shader: components/ss.glsl.

use super::method::{ComponentMethod, SampleCount, Samples};
use crate::error::{Error, Result};
use crate::gpu::shader::structs::AreaSampleBlock;
use crate::lights::area::{AreaLight, area_lights};
use crate::settings::Values;
use crate::techniques::Inputs;
use crate::techniques::adaptive_interleaved::resources::NAME;
use crate::techniques::adaptive_interleaved::settings::Guidance;

pub struct SoftShadows;

impl ComponentMethod for SoftShadows {
    fn most_iterations(&self, values: &Values) -> u32 {
        values.integer("ss-max") as u32
    }

    fn guides_each(&self, values: &Values) -> bool {
        values.is("ss-guidance", Guidance::Each)
    }

    fn shines(&self, inputs: &Inputs<'_>) -> bool {
        !areas(inputs).is_empty() || !inputs.lights.lights.is_empty()
    }

    fn count(&self, inputs: &Inputs<'_>, tile_px: [u32; 2]) -> Result<SampleCount> {
        let (areas, lights) = (areas(inputs).len() as u32, inputs.lights.lights.len() as u32);
        if areas + lights == 0 {
            let emissive = if inputs.emissive_lights() { "emissive surface and no" } else { "--emissive on and no" };
            return Err(Error::request(format!("{NAME}: --components ss: the scene has no {emissive} punctual light"))
                .note("--components id, or --lights N"));
        }
        let points = self.point_count(inputs, tile_px);
        let source_bytes = u64::from(areas) * u64::from(points) * size_of::<AreaSampleBlock>() as u64;
        Ok(SampleCount { sources: areas, source_bytes, has_lights: true })
    }

    fn samples(&self, inputs: &Inputs<'_>, tile_px: [u32; 2]) -> Result<Samples> {
        let areas = areas(inputs);
        let count = self.point_count(inputs, tile_px);
        let seed = inputs.values.integer("seed") as u32;
        // A seed of its own for each light: points of two lights would be correlated.
        let points = |(index, light): (u32, &AreaLight)| {
            light.points(inputs.scene, count, seed ^ index.wrapping_mul(0x9e37_79b9))
        };
        let samples: Vec<AreaSampleBlock> = (1u32..).zip(&areas).flat_map(points).collect();
        Ok(Samples {
            sources: bytemuck::cast_slice(&samples).to_vec(),
            counters: vec![("area_lights", areas.len() as f64), ("lights", inputs.lights.lights.len() as f64)],
        })
    }
}

impl SoftShadows {
    /// Points of each area light: one for each pixel of a tile in each iteration.
    fn point_count(&self, inputs: &Inputs<'_>, [x, y]: [u32; 2]) -> u32 {
        self.most_iterations(inputs.values) * x * y
    }
}

fn areas(inputs: &Inputs<'_>) -> Vec<AreaLight> {
    let most = inputs.values.integer("ss-lights") as usize;
    if inputs.emissive_lights() { area_lights(inputs.scene, most) } else { Vec::new() }
}
