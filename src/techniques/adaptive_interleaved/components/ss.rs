//! Soft shadows (SS): light straight from area lights, and from punctual ones, whose shadows are hard. Dubla 2009,
//! section 3.3. Shader: components/ss.glsl.

use super::method::{ComponentMethod, PreparedComponent, SampleCount, Samples};
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

    fn prepare(
        &self,
        inputs: &Inputs<'_>,
        [x, y]: [u32; 2],
        listed: bool,
    ) -> Result<Option<Box<dyn PreparedComponent>>> {
        let is_emissive = inputs.emissive_lights();
        let most = inputs.values.integer("ss-lights") as usize;
        let areas = if is_emissive { area_lights(inputs.scene, most) } else { Vec::new() };
        if areas.is_empty() && inputs.lights.lights.is_empty() {
            if !listed {
                return Ok(None);
            }
            let emissive = if is_emissive { "emissive surface and no" } else { "--emissive on and no" };
            return Err(Error::request(format!("{NAME}: --components ss: the scene has no {emissive} punctual light"))
                .note("--components id, or --lights N"));
        }
        // One for each pixel of a tile in each iteration.
        let point_count = self.most_iterations(inputs.values) * x * y;
        Ok(Some(Box::new(PreparedSoftShadows { areas, point_count })))
    }
}

struct PreparedSoftShadows {
    areas: Vec<AreaLight>,
    /// Points of each area light.
    point_count: u32,
}

impl PreparedComponent for PreparedSoftShadows {
    fn count(&self) -> SampleCount {
        let sources = self.areas.len() as u32;
        let bytes = u64::from(sources) * u64::from(self.point_count) * size_of::<AreaSampleBlock>() as u64;
        SampleCount { sources, source_bytes: bytes, has_lights: true }
    }

    fn samples(&self, inputs: &Inputs<'_>) -> Result<Samples> {
        let seed = inputs.values.integer("seed") as u32;
        // A seed of its own for each light: points of two lights would be correlated.
        let points = |(index, light): (u32, &AreaLight)| {
            light.points(inputs.scene, self.point_count, seed ^ index.wrapping_mul(0x9e37_79b9))
        };
        let samples: Vec<AreaSampleBlock> = (1u32..).zip(&self.areas).flat_map(points).collect();
        let counts = [("area_lights", self.areas.len()), ("lights", inputs.lights.lights.len())];
        Ok(Samples {
            sources: bytemuck::cast_slice(&samples).to_vec(),
            counters: counts.map(|(key, count)| (key, count as f64)).to_vec(),
        })
    }
}
