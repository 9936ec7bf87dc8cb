//! Indirect diffuse light (ID): Dubla 2009, section 3.2. Shader: components/id.glsl.
//!
//! Virtual point lights of a light walk, in N x M subsets, each as well spread as the whole, because the walk's order
//! is a low-discrepancy one. What emissive surfaces give straight is soft shadows' and not counted here.

use super::method::{ComponentMethod, PreparedComponent, SampleCount, Samples};
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

    fn prepare(&self, inputs: &Inputs<'_>, [x, y]: [u32; 2], _: bool) -> Result<Option<Box<dyn PreparedComponent>>> {
        let vpl_count = inputs.values.integer("vpls") as u32;
        let (most, subset_count) = (self.most_iterations(inputs.values), x * y);
        if most > subset_count {
            return Err(Error::request(format!(
                "{NAME}: --id-max {most} with --tile {x}x{y}: a pixel has {subset_count} subsets of the virtual lights, \
                 and uses none twice"
            ))
            .note(format!("--id-max {subset_count}, or a larger --tile")));
        }
        if vpl_count < subset_count {
            return Err(Error::request(format!(
                "{NAME}: --vpls {vpl_count} for the {subset_count} subsets of --tile {x}x{y}: each needs one"
            ))
            .note(format!("--vpls {subset_count} or more, or a smaller --tile")));
        }
        Ok(Some(Box::new(PreparedIndirect { vpl_count })))
    }
}

struct PreparedIndirect {
    vpl_count: u32,
}

impl PreparedComponent for PreparedIndirect {
    fn count(&self) -> SampleCount {
        let source_bytes = u64::from(self.vpl_count) * size_of::<VplBlock>() as u64;
        SampleCount { sources: self.vpl_count, source_bytes, has_lights: false }
    }

    fn samples(&self, inputs: &Inputs<'_>) -> Result<Samples> {
        let (values, count) = (inputs.values, self.vpl_count);
        let walk = vpl::Walk {
            count,
            bounces: values.integer("vpl-bounces") as u32,
            emissive: inputs.emissive_lights(),
            starts: false,
            medium: inputs.medium_block(),
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
