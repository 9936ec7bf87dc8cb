//! Indirect diffuse light (ID): Dubla 2009, section 3.2. Shader: components/id.glsl.
//!
//! Virtual point lights of a light walk, in N x M subsets, each as well spread as the whole, because the walk's order
//! is a low-discrepancy one. What emissive surfaces give straight is soft shadows' and not counted here.

use super::host::{Estimate, Given, HostComponent, LUMINANCE, Point};
use super::method::{ComponentMethod, PreparedComponent, SampleCount, Samples};
use crate::error::{Error, Result};
use crate::gpu::shader::structs::VplBlock;
use crate::lights::vpl;
use crate::settings::Values;
use crate::shading::light::vpl_irradiance;
use crate::techniques::Inputs;
use crate::techniques::adaptive_interleaved::resources::NAME;
use crate::techniques::adaptive_interleaved::settings::{LightChoice, Mode};
use glam::{Vec3, Vec4};
use std::ops::Range;

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
        let choice = inputs.values.choice("id-choice");
        Ok(Some(Box::new(PreparedIndirect { vpl_count, choice })))
    }
}

struct PreparedIndirect {
    vpl_count: u32,
    choice: LightChoice,
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

    fn host(&self, samples: &Samples) -> Box<dyn HostComponent> {
        Box::new(HostIndirect { vpls: samples.sources_as(), choice: self.choice })
    }
}

struct HostIndirect {
    vpls: Vec<VplBlock>,
    choice: LightChoice,
}

/// What one iteration met.
#[derive(Default)]
struct Met {
    ray_count: u32,
    missed_count: u32,
}

impl Met {
    /// What arrives of `received` from a virtual light.
    fn arriving(&mut self, given: &Given<'_>, point: &Point, light: &VplBlock, received: Vec3) -> Vec3 {
        let to_light = Vec4::from_array(light.position_ws).truncate() - point.position_ws;
        let distance = to_light.length();
        let direction = to_light / distance.max(1e-12);
        self.ray_count += 1;
        if given.shadows.occluded(point.position_ws, point.normal_ws, direction, distance) {
            self.missed_count += 1;
            return Vec3::ZERO;
        }
        received * given.params.medium.passed(point.position_ws, direction, distance)
    }
}

fn unhidden(given: &Given<'_>, point: &Point, light: &VplBlock) -> Vec3 {
    vpl_irradiance(light, point.position_ws, point.normal_ws, given.params.least_squared)
}

impl HostIndirect {
    /// Light of a subset; it stands for all N x M of them.
    fn light_of_subset(&self, given: &Given<'_>, point: &Point, subset: Range<usize>, met: &mut Met) -> Vec3 {
        let mut sum = Vec3::ZERO;
        for light in &self.vpls[subset] {
            let received = unhidden(given, point, light);
            if received != Vec3::ZERO {
                sum += met.arriving(given, point, light, received);
            }
        }
        sum * given.params.tile_size() as f32
    }

    /// The same by as many rays at most, to lights drawn evenly over the sum of what all would give, from `part` on.
    fn light_of_drawn(&self, given: &Given<'_>, point: &Point, subset: Range<usize>, part: f32, met: &mut Met) -> Vec3 {
        let (mut all, mut look_count) = (0.0, 0);
        for (index, light) in self.vpls.iter().enumerate() {
            let weight = unhidden(given, point, light).dot(LUMINANCE);
            all += weight;
            look_count += u32::from(weight > 0.0 && subset.contains(&index));
        }
        let step = all / look_count.max(1) as f32;
        let (mut sum, mut before, mut drawn) = (Vec3::ZERO, 0.0, 0.0f32);
        for light in self.vpls.iter().filter(|_| step > 0.0) {
            let received = unhidden(given, point, light);
            let weight = received.dot(LUMINANCE);
            before += weight;
            let reached = (before / step - part).ceil().max(drawn);
            if reached > drawn && weight > 0.0 {
                sum += met.arriving(given, point, light, received * ((reached - drawn) * step / weight));
            }
            drawn = reached;
        }
        sum
    }
}

impl HostComponent for HostIndirect {
    fn contribute(&self, given: &Given<'_>, point: &Point, slot: u32, iteration: u32, estimate: &mut Estimate) {
        let params = given.params;
        let [first, end] = params.id_stretch(slot, iteration).map(|index| index as usize);
        let mut met = Met::default();
        estimate.sum += match self.choice {
            LightChoice::Even => self.light_of_subset(given, point, first..end, &mut met),
            LightChoice::Contribution => {
                let part = (slot as f32 + (iteration as f32 + 0.5) / params.most as f32) / params.tile_size() as f32;
                self.light_of_drawn(given, point, first..end, part, &mut met)
            }
        };
        let Met { ray_count, missed_count } = met;
        estimate.information += if ray_count > 0 { missed_count as f32 / ray_count as f32 } else { 0.0 };
        estimate.ray_count += ray_count;
    }

    fn is_penumbra(&self) -> bool {
        false
    }
}
