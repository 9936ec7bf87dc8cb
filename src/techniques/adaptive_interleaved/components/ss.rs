//! Soft shadows (SS): light straight from area lights, and from punctual ones, whose shadows are hard. Dubla 2009,
//! section 3.3. Shader: components/ss.glsl.

use super::area_samples::AreaSamples;
use super::method::{ComponentMethod, PreparedComponent, SampleCount, Samples};
use crate::error::{Error, Result};
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
        tile_px: [u32; 2],
        listed: bool,
    ) -> Result<Option<Box<dyn PreparedComponent>>> {
        let areas = AreaSamples::new(inputs, tile_px, self.most_iterations(inputs.values));
        if areas.light_count() == 0 && inputs.lights.lights.is_empty() {
            if !listed {
                return Ok(None);
            }
            let emissive = if inputs.emissive_lights() { "emissive surface and no" } else { "--emissive on and no" };
            return Err(Error::request(format!("{NAME}: --components ss: the scene has no {emissive} punctual light"))
                .note("--components id, or --lights N"));
        }
        Ok(Some(Box::new(PreparedSoftShadows { areas })))
    }
}

struct PreparedSoftShadows {
    areas: AreaSamples,
}

impl PreparedComponent for PreparedSoftShadows {
    fn count(&self) -> SampleCount {
        SampleCount { sources: self.areas.light_count(), source_bytes: self.areas.bytes(), has_lights: true }
    }

    fn samples(&self, inputs: &Inputs<'_>) -> Result<Samples> {
        let counts = [("area_lights", self.areas.light_count() as usize), ("lights", inputs.lights.lights.len())];
        Ok(Samples {
            sources: bytemuck::cast_slice(&self.areas.points(inputs)).to_vec(),
            counters: counts.map(|(key, count)| (key, count as f64)).to_vec(),
        })
    }
}
