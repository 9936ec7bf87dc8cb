//! Soft shadows (SS): light straight from area lights, and from punctual ones, whose shadows are hard. Dubla 2009,
//! section 3.3. Shader: components/ss.glsl.

use super::area_samples::{AreaSamples, area_irradiance, incident_of};
use super::host::{Estimate, Given, HostComponent, Point, mean_of};
use super::method::{ComponentMethod, PreparedComponent, SampleCount, Samples};
use crate::error::{Error, Result};
use crate::gpu::shader::structs::{AdaptiveParams, AreaSampleBlock};
use crate::gpu::shader::techniques::adaptive_interleaved::components::ss::LIGHT_BITS;
use crate::settings::Values;
use crate::techniques::Inputs;
use crate::techniques::adaptive_interleaved::resources::NAME;
use crate::techniques::adaptive_interleaved::settings::Guidance;
use glam::{Vec3, Vec4};

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

    fn host(&self, samples: &Samples) -> Box<dyn HostComponent> {
        Box::new(HostShadows { points: samples.sources_as() })
    }
}

struct HostShadows {
    /// Points of the area lights, light by light.
    points: Vec<AreaSampleBlock>,
}

/// What a point meets in one iteration.
#[derive(Default)]
struct Met {
    missed_count: u32,
    light_count: u32,
    /// A bit a light: 1 where nothing hides it. Of lights that share a bit it changes where one of them does.
    lit: u32,
}

impl Met {
    /// `received`: what arrives where nothing hides it. What a surface turns away from is hidden by the surface itself.
    fn add(
        &mut self,
        given: &Given<'_>,
        point: &Point,
        received: Vec3,
        (direction_ws, distance): (Vec3, f32),
        index: u32,
        estimate: &mut Estimate,
    ) {
        self.light_count += 1;
        if received == Vec3::ZERO {
            self.missed_count += 1;
            return;
        }
        estimate.ray_count += 1;
        if given.shadows.occluded(point.position_ws, point.normal_ws, direction_ws, distance) {
            self.missed_count += 1;
        } else {
            self.lit ^= 1 << (index % LIGHT_BITS);
            estimate.sum += received * given.params.medium.passed(point.position_ws, direction_ws, distance);
        }
    }
}

/// The bits that lights have.
fn light_bits(params: &AdaptiveParams) -> u32 {
    (1 << (params.source_count + params.light_count).min(LIGHT_BITS)) - 1
}

impl HostComponent for HostShadows {
    fn contribute(&self, given: &Given<'_>, point: &Point, slot: u32, iteration: u32, estimate: &mut Estimate) {
        let params = given.params;
        let mut met = Met::default();
        for area in 0..params.source_count {
            let light = &self.points[params.ss_point(area, slot, iteration) as usize];
            let to_light = Vec4::from_array(light.position_ws).truncate() - point.position_ws;
            let received = area_irradiance(light, point.normal_ws, to_light);
            let distance = to_light.length();
            met.add(given, point, received, (to_light / distance.max(1e-12), distance), area, estimate);
        }
        for (index, light) in (0..).zip(given.lights) {
            let own = iteration * params.tile_size() + slot;
            let (direction, distance, irradiance) = incident_of(params, light, index, point.position_ws, own);
            // Lights that do not reach so far guide nothing.
            if irradiance != Vec3::ZERO {
                let received = irradiance * point.normal_ws.dot(direction).max(0.0);
                met.add(given, point, received, (direction, distance), params.source_count + index, estimate);
            }
        }
        let Met { missed_count, light_count, lit } = met;
        estimate.information += if light_count > 0 { missed_count as f32 / light_count as f32 } else { 0.0 };
        estimate.lit_any |= lit;
        estimate.lit_all &= lit;
    }

    /// The part of the lights that was hidden, or each light's bit: of one that a texel met in some iterations only at every
    /// second texel.
    fn found_word(&self, params: &AdaptiveParams, slot: u32, estimate: &Estimate) -> u32 {
        match (params.guides_each, slot % 2) {
            (0, _) => (estimate.information / params.base as f32).to_bits(),
            (_, 0) => estimate.lit_any,
            _ => estimate.lit_all & estimate.lit_any,
        }
    }

    fn refine_of(&self, params: &AdaptiveParams, words: &[u32]) -> f32 {
        if params.guides_each == 0 {
            return mean_of(words);
        }
        let (bits, texel_count) = (light_bits(params), words.len() as u32);
        let (any, all) = words.iter().fold((0, u32::MAX), |(any, all), word| (any | word, all & word));
        let parted_count = (any & !all & bits).count_ones();
        let all_missing: u32 = words.iter().map(|word| (!word & bits).count_ones()).sum();
        let missing_count = all_missing - (!any & bits).count_ones() * texel_count;
        if parted_count > 0 { missing_count as f32 / (parted_count * texel_count) as f32 } else { 0.0 }
    }

    fn is_penumbra(&self) -> bool {
        true
    }
}
