//! Indirect diffuse light (ID): Dubla 2009, section 3.2. Shader: components/id.glsl.
//!
//! Virtual point lights of a light walk, in N x M subsets, each as well spread as the whole, because the walk's order
//! is a low-discrepancy one. What emissive surfaces give straight is soft shadows' and not counted here.

use super::method::{ComponentMethod, SampleCount, Samples};
use crate::error::{Error, Result};
use crate::gpu::shader::structs::VplBlock;
use crate::lights::vpl;
use crate::settings::Values;
use crate::techniques::Inputs;
use crate::techniques::adaptive_interleaved::resources::NAME;
use crate::techniques::adaptive_interleaved::settings::Mode;

pub struct IndirectDiffuse;

impl ComponentMethod for IndirectDiffuse {
    fn most_iterations(&self, values: &Values) -> u32 {
        values.integer("id-max") as u32
    }

    fn scale(&self, values: &Values) -> u32 {
        let auto = if values.is("mode", Mode::Igi) { 1 } else { 2 };
        values.unless_auto("id-scale", Values::integer).map_or(auto, |scale| scale as u32)
    }

    fn count(&self, inputs: &Inputs<'_>, [x, y]: [u32; 2]) -> Result<SampleCount> {
        let count = inputs.values.integer("vpls") as u32;
        let (most, subset_count) = (self.most_iterations(inputs.values), x * y);
        if most > subset_count {
            return Err(Error::request(format!(
                "{NAME}: --id-max {most} with --tile {x}x{y}: a pixel has {subset_count} subsets of the virtual lights, \
                 and uses none twice"
            ))
            .note(format!("--id-max {subset_count}, or a larger --tile")));
        }
        if count < subset_count {
            return Err(Error::request(format!(
                "{NAME}: --vpls {count} for the {subset_count} subsets of --tile {x}x{y}: each needs one"
            ))
            .note(format!("--vpls {subset_count} or more, or a smaller --tile")));
        }
        let source_bytes = u64::from(count) * size_of::<VplBlock>() as u64;
        Ok(SampleCount { sources: count, source_bytes, has_lights: false })
    }

    fn samples(&self, inputs: &Inputs<'_>, _: [u32; 2]) -> Result<Samples> {
        let values = inputs.values;
        let count = values.integer("vpls") as u32;
        let walk = vpl::Walk {
            count,
            bounces: values.integer("vpl-bounces") as u32,
            emissive: inputs.emissive_lights(),
            starts: false,
            seed: values.integer("seed") as u32,
        };
        let found = vpl::walk(inputs.scene, inputs.bvh.over(inputs.scene)?, &inputs.lights.lights, &walk);
        Ok(Samples {
            sources: bytemuck::cast_slice(&found.vpls).to_vec(),
            counters: vec![
                ("vpls", f64::from(count)),
                ("vpls_found", f64::from(found.found_count)),
                ("light_walks", f64::from(found.walk_count)),
            ],
        })
    }
}
