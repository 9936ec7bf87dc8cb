//! Ambient occlusion (AO): light from all around that no surface stops. The fourth component, and not the paper's: its
//! section 3 says that others are added alike. Shader: components/ao.glsl.

use super::host::{Estimate, Given, HostComponent, Point};
use super::method::{ComponentMethod, PreparedComponent, SampleCount, Samples};
use crate::error::{Error, Result};
use crate::gpu::shader::frame::FAR;
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
        [x, y]: [u32; 2],
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
        Ok(Some(Box::new(PreparedOcclusion { direction_count: self.most_iterations(inputs.values) * x * y })))
    }
}

struct PreparedOcclusion {
    /// One for each pixel of a tile in each iteration.
    direction_count: u32,
}

impl PreparedComponent for PreparedOcclusion {
    fn count(&self) -> SampleCount {
        let source_bytes = u64::from(self.direction_count) * size_of::<[f32; 4]>() as u64;
        SampleCount { sources: self.direction_count, source_bytes, has_lights: false }
    }

    fn samples(&self, inputs: &Inputs<'_>) -> Result<Samples> {
        let seed = inputs.values.integer("seed") as u32;
        let directions: Vec<[f32; 4]> = (0..self.direction_count).map(|index| direction(index, seed)).collect();
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

/// A unit vector around z, as dense as its cosine with it, from an Owen-scrambled Sobol sequence: any stretch of them is
/// spread over the hemisphere.
pub fn direction(index: u32, seed: u32) -> [f32; 4] {
    let [u, v] = [0, 1].map(|dimension| sobol_burley::sample(index, dimension, seed));
    let (radius, angle) = (u.sqrt(), TAU * v);
    [radius * angle.cos(), radius * angle.sin(), (1.0 - u).max(0.0).sqrt(), 0.0]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A cosine's mean over directions as dense as itself is 2/3, and those to the sides cancel.
    #[test]
    fn directions_are_as_dense_as_their_cosine() {
        for (from, to) in [(0, 1024), (100, 612)] {
            let mean = (from..to).map(|index| glam::Vec4::from_array(direction(index, 7))).sum::<glam::Vec4>()
                / (to - from) as f32;
            assert!((mean - glam::vec4(0.0, 0.0, 2.0 / 3.0, 0.0)).abs().max_element() < 0.02, "{mean}");
        }
    }
}
