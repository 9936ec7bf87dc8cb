//! Indirect diffuse light (ID): Dubla 2009, section 3.2. Shader: components/id.glsl.
//!
//! Virtual point lights of a light walk, in N x M subsets, each as well spread as the whole, because the walk's order
//! is a low-discrepancy one. What emissive surfaces give straight is soft shadows' and not counted here.

use super::host::{Estimate, Given, HostComponent, Point};
use super::method::{ComponentMethod, PreparedComponent, SampleCount, Samples};
use crate::error::{Error, Result};
use crate::gpu::shader::structs::VplBlock;
use crate::lights::vpl;
use crate::settings::Values;
use crate::shading::light::vpl_irradiance;
use crate::techniques::Inputs;
use crate::techniques::adaptive_interleaved::resources::NAME;
use crate::techniques::adaptive_interleaved::settings::Mode;
use glam::{Vec3, Vec4};

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
            medium: inputs.medium(),
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

    fn host(&self, samples: &Samples) -> Box<dyn HostComponent> {
        Box::new(HostIndirect { vpls: samples.sources_as() })
    }
}

struct HostIndirect {
    vpls: Vec<VplBlock>,
}

impl HostComponent for HostIndirect {
    fn contribute(&self, given: &Given<'_>, point: &Point, slot: u32, iteration: u32, estimate: &mut Estimate) {
        let params = given.params;
        let [first, end] = params.id_stretch(slot, iteration).map(|index| index as usize);
        let (mut ray_count, mut missed_count, mut sum) = (0, 0, Vec3::ZERO);
        for light in &self.vpls[first..end] {
            let received = vpl_irradiance(light, point.position_ws, point.normal_ws, params.least_squared);
            if received == Vec3::ZERO {
                continue;
            }
            let to_light = Vec4::from_array(light.position_ws).truncate() - point.position_ws;
            let distance = to_light.length();
            let direction = to_light / distance.max(1e-12);
            ray_count += 1;
            if given.shadows.occluded(point.position_ws, point.normal_ws, direction, distance) {
                missed_count += 1;
            } else {
                sum += received * params.medium.passed(point.position_ws, direction, distance);
            }
        }
        // A subset stands for all N x M of them.
        estimate.sum += sum * params.tile_size() as f32;
        estimate.information += if ray_count > 0 { missed_count as f32 / ray_count as f32 } else { 0.0 };
        estimate.ray_count += ray_count;
    }

    fn is_penumbra(&self) -> bool {
        false
    }
}
