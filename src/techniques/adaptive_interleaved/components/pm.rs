//! Airlight (PM): light of area lights and punctual ones that a homogeneous medium scatters once, into the ray that is
//! seen. Dubla 2009, section 3.4. Shader: components/pm.glsl.

use super::area_samples::AreaSamples;
use super::method::{ComponentMethod, PreparedComponent, SampleCount, Samples};
use crate::error::{Error, Result};
use crate::gpu::shader::structs::AdaptiveParams;
use crate::scene::Medium;
use crate::settings::Values;
use crate::techniques::Inputs;
use crate::techniques::adaptive_interleaved::resources::NAME;
use glam::Vec4;

pub struct Airlight;

impl ComponentMethod for Airlight {
    fn most_iterations(&self, values: &Values) -> u32 {
        values.integer("pm-max") as u32
    }

    fn prepare(
        &self,
        inputs: &Inputs<'_>,
        tile_px: [u32; 2],
        listed: bool,
    ) -> Result<Option<Box<dyn PreparedComponent>>> {
        let values = inputs.values;
        let Some(medium) = inputs.medium_block().filter(|medium| medium.scattering > 0.0) else {
            if !listed {
                return Ok(None);
            }
            let text = Medium::text(inputs.medium());
            return Err(Error::request(format!("{NAME}: --components pm: --medium {text} scatters no light"))
                .note("--medium 0.1,0,0, or --components id,ss"));
        };
        let areas = AreaSamples::new(inputs, tile_px, self.most_iterations(values));
        if areas.light_count() == 0 && inputs.lights.lights.is_empty() {
            if !listed {
                return Ok(None);
            }
            let emissive = if inputs.emissive_lights() { "emissive surface and no" } else { "--emissive on and no" };
            return Err(Error::request(format!(
                "{NAME}: --components pm: nothing lights the medium, for the scene has no {emissive} punctual light"
            ))
            .note("--components id, or --lights N"));
        }
        let diagonal = (Vec4::from_array(medium.max_ws) - Vec4::from_array(medium.min_ws)).length();
        let march_step = diagonal / values.integer("pm-steps") as f32;
        // As printed: a length less a coefficient.
        let halo = values.number("pm-distance") as f32 - medium.extinction;
        Ok(Some(Box::new(PreparedAirlight { areas, march_step, halo })))
    }
}

struct PreparedAirlight {
    areas: AreaSamples,
    march_step: f32,
    halo: f32,
}

impl PreparedComponent for PreparedAirlight {
    fn count(&self) -> SampleCount {
        SampleCount { sources: self.areas.light_count(), source_bytes: self.areas.bytes(), has_lights: true }
    }

    fn write(&self, params: &mut AdaptiveParams) {
        params.march_step = self.march_step;
        params.halo = self.halo;
    }

    fn samples(&self, inputs: &Inputs<'_>) -> Result<Samples> {
        let counters = vec![("airlight_step_m", f64::from(self.march_step))];
        Ok(Samples { sources: bytemuck::cast_slice(&self.areas.points(inputs)).to_vec(), counters })
    }
}
