//! Ambient occlusion (AO): light from all around that no surface stops. The fourth component, and not the paper's: its
//! section 3 says that others are added alike. Shader: components/ao.glsl.

use super::host::{Estimate, Given, HostComponent, Point};
use super::method::{ComponentMethod, PreparedComponent, SampleCount, Samples};
use crate::error::{Error, Result};
use crate::gpu::shader::frame::FAR;
use crate::sampling::pairs::in_order;
use crate::settings::Values;
use crate::shading::scatter::around;
use crate::techniques::Inputs;
use crate::techniques::adaptive_interleaved::resources::NAME;
use glam::{Vec3, Vec4};
use std::f32::consts::{PI, TAU};

pub struct AmbientOcclusion;

impl ComponentMethod for AmbientOcclusion {
    fn most_iterations(&self, values: &Values) -> u32 {
        values.integer("ao-max") as u32
    }

    fn prepare(
        &self,
        inputs: &Inputs<'_>,
        tile_px: [u32; 2],
        listed: bool,
    ) -> Result<Option<Box<dyn PreparedComponent>>> {
        if !listed {
            return Ok(None);
        }
        if inputs.lights.ambient == Vec3::ZERO {
            return Err(Error::request(format!(
                "{NAME}: --components ao: there is no ambient light that surfaces could stop"
            ))
            .note("--ambient 0.3, or --components without ao"));
        }
        Ok(Some(Box::new(PreparedOcclusion { tile_px, iterations: self.most_iterations(inputs.values) })))
    }
}

/// A direction for each pixel of a tile in each iteration.
struct PreparedOcclusion {
    tile_px: [u32; 2],
    iterations: u32,
}

impl PreparedComponent for PreparedOcclusion {
    fn count(&self) -> SampleCount {
        let direction_count = self.iterations * self.tile_px[0] * self.tile_px[1];
        let source_bytes = u64::from(direction_count) * size_of::<[f32; 4]>() as u64;
        SampleCount { sources: direction_count, source_bytes, has_lights: false }
    }

    fn samples(&self, inputs: &Inputs<'_>) -> Result<Samples> {
        let (seed, sampler) = (inputs.values.integer("seed") as u32, inputs.values.choice("sampler"));
        let pairs = in_order(sampler, self.tile_px, self.iterations, seed);
        let directions: Vec<[f32; 4]> = pairs.into_iter().map(direction).collect();
        Ok(Samples { sources: bytemuck::cast_slice(&directions).to_vec(), counters: Vec::new() })
    }

    fn host(&self, samples: &Samples) -> Box<dyn HostComponent> {
        Box::new(HostOcclusion { directions: samples.sources_as() })
    }
}

struct HostOcclusion {
    /// Around z.
    directions: Vec<[f32; 4]>,
}

impl HostComponent for HostOcclusion {
    fn contribute(&self, given: &Given<'_>, point: &Point, slot: u32, iteration: u32, estimate: &mut Estimate) {
        let params = given.params;
        let local = self.directions[(iteration * params.tile_size() + slot) as usize];
        let direction = around(point.normal_ws, Vec4::from_array(local).truncate());
        estimate.ray_count += 1;
        if given.shadows.occluded(point.position_ws, point.normal_ws, direction, FAR) {
            estimate.information += 1.0;
            return;
        }
        let passed = params.medium.passed(point.position_ws, direction, FAR);
        estimate.sum += Vec4::from_array(given.frame.ambient).truncate() * (PI * passed);
    }

    fn is_penumbra(&self) -> bool {
        true
    }
}

/// The unit vector around z of two numbers, 0 to 1 without 1, as dense as its cosine with it.
pub fn direction([u, v]: [f32; 2]) -> [f32; 4] {
    let (radius, angle) = (u.sqrt(), TAU * v);
    [radius * angle.cos(), radius * angle.sin(), (1.0 - u).max(0.0).sqrt(), 0.0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::sampler::Sampler;

    /// A cosine's mean over directions as dense as itself is 2/3, and those to the sides cancel.
    #[test]
    fn directions_are_as_dense_as_their_cosine() {
        let pairs = in_order(Sampler::Sobol, [1, 1], 1024, 7);
        for (from, to) in [(0, 1024), (100, 612)] {
            let mean = pairs[from..to].iter().map(|pair| glam::Vec4::from_array(direction(*pair))).sum::<glam::Vec4>()
                / (to - from) as f32;
            assert!((mean - glam::vec4(0.0, 0.0, 2.0 / 3.0, 0.0)).abs().max_element() < 0.02, "{mean}");
        }
    }
}
