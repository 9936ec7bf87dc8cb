//! Airlight (PM): light of area lights and punctual ones that a homogeneous medium scatters once, into the ray that is
//! seen. Dubla 2009, section 3.4. Shader: components/pm.glsl.

use super::area_samples::{AreaSamples, facing_irradiance, incident_of};
use super::host::{Estimate, Given, HostComponent, Point};
use super::method::{ComponentMethod, PreparedComponent, SampleCount, Samples};
use crate::error::{Error, Result};
use crate::frame::ViewRay;
use crate::gpu::shader::structs::{AdaptiveParams, AreaSampleBlock};
use crate::gpu::shader::techniques::adaptive_interleaved::components::pm::SAME_NUMBER;
use crate::scene::Medium;
use crate::settings::Values;
use crate::techniques::Inputs;
use crate::techniques::adaptive_interleaved::resources::NAME;
use glam::{Vec2, Vec3, Vec4};

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

    fn host(&self, samples: &Samples) -> Box<dyn HostComponent> {
        Box::new(HostAirlight { points: samples.sources_as() })
    }
}

struct HostAirlight {
    /// Points of the area lights, light by light.
    points: Vec<AreaSampleBlock>,
}

/// A place of the march.
struct Place {
    position_ws: Vec3,
    /// Direction of the ray that is seen.
    seen_along: Vec3,
    /// Which of the march's it is.
    index: u32,
}

/// What a place of the march meets.
#[derive(Default)]
struct Met {
    /// Radiance that it scatters to the eye, over the medium's coefficient.
    scattered: Vec3,
    /// Lights that something hides, or that shine elsewhere.
    missed_count: u32,
    is_in_halo: bool,
}

impl Met {
    fn add(
        &mut self,
        given: &Given<'_>,
        place: &Place,
        irradiance: Vec3,
        (direction_ws, distance): (Vec3, f32),
        estimate: &mut Estimate,
    ) {
        let AdaptiveParams { medium, halo, .. } = given.params;
        self.is_in_halo |= distance < *halo;
        if irradiance == Vec3::ZERO {
            self.missed_count += 1;
            return;
        }
        estimate.ray_count += 1;
        // There is no surface that the ray would have to leave.
        if given.shadows.occluded(place.position_ws, Vec3::ZERO, direction_ws, distance) {
            self.missed_count += 1;
            return;
        }
        let turned = medium.phase(direction_ws.dot(place.seen_along));
        self.scattered += irradiance * (turned * medium.passed(place.position_ws, direction_ws, distance));
    }
}

impl HostAirlight {
    /// `own`: of the first place's points of area lights.
    fn met_at(&self, given: &Given<'_>, place: &Place, own: u32, estimate: &mut Estimate) -> Met {
        let params = given.params;
        let point_count = params.most * params.tile_size();
        let mut met = Met::default();
        for area in 0..params.source_count {
            let light = &self.points[(area * point_count + (own + place.index) % point_count) as usize];
            let to_light = Vec4::from_array(light.position_ws).truncate() - place.position_ws;
            let distance = to_light.length();
            let irradiance = facing_irradiance(light, to_light);
            met.add(given, place, irradiance, (to_light / distance.max(1e-12), distance), estimate);
        }
        for (index, light) in (0..).zip(given.lights) {
            let own = (own + place.index) % point_count;
            let (direction, distance, irradiance) = incident_of(params, light, index, place.position_ws, own);
            met.add(given, place, irradiance, (direction, distance), estimate);
        }
        met
    }
}

/// Which part of a pixel's stretch of a step an iteration has: the middle first, then those beside it in turns.
fn part_of_stretch(params: &AdaptiveParams, iteration: u32) -> u32 {
    let (middle, away) = (params.most / 2, iteration.div_ceil(2));
    if iteration % 2 == 1 { middle - away } else { middle + away }
}

/// Where the pixel's places lie in a step, 0 to 1.
fn offset_in_step(params: &AdaptiveParams, slot: u32, iteration: u32) -> f32 {
    let part = (part_of_stretch(params, iteration) as f32 + 0.5) / params.most as f32;
    (slot as f32 + part) / params.tile_size() as f32
}

/// The mean of those parts that are neither none nor all.
fn combined(missed_part: f32, halo_part: f32) -> f32 {
    let (mut sum, mut count) = (0.0, 0.0f32);
    for part in [missed_part, halo_part] {
        if part > 0.0 && part < 1.0 {
            sum += part;
            count += 1.0;
        }
    }
    sum / count.max(1.0)
}

impl HostComponent for HostAirlight {
    /// The medium is seen beside surfaces too.
    fn is_estimated(&self, _: &Point) -> bool {
        true
    }

    fn contribute(&self, given: &Given<'_>, point: &Point, slot: u32, iteration: u32, estimate: &mut Estimate) {
        let params = given.params;
        let ray = ViewRay::through(given.frame, Vec2::from_array(point.pixel.map(|side| side as f32)) + 0.5);
        let seen = if point.has_surface { (point.position_ws - ray.origin).dot(ray.direction) } else { ray.limit };
        let [begin, end] = params.medium.stretch(ray.origin, ray.direction, [-ray.behind, seen]);
        let offset = offset_in_step(params, slot, iteration);
        let own = iteration * params.tile_size() + slot;
        let light_count = params.source_count + params.light_count;
        let place_count = ((end - begin) / params.march_step - offset).ceil().max(0.0) as u32;
        let (mut missed_count, mut halo_count, mut sum) = (0, 0, Vec3::ZERO);
        for index in 0..place_count {
            let advanced = (index as f32 + offset) * params.march_step;
            let position_ws = ray.origin + ray.direction * (begin + advanced);
            let place = Place { position_ws, seen_along: ray.direction, index };
            let met = self.met_at(given, &place, own, estimate);
            sum += met.scattered * (-params.medium.extinction * advanced).exp();
            missed_count += met.missed_count;
            halo_count += u32::from(met.is_in_halo);
        }
        estimate.sum += sum * (params.medium.scattering * params.march_step);
        if place_count > 0 {
            let missed_part = missed_count as f32 / (place_count * light_count) as f32;
            estimate.information += combined(missed_part, halo_count as f32 / place_count as f32);
        }
    }

    /// The part of the texels that have found another number than the one before them.
    fn refine_of(&self, _: &AdaptiveParams, words: &[u32]) -> f32 {
        let is_other = |pair: &&[u32]| (f32::from_bits(pair[1]) - f32::from_bits(pair[0])).abs() > SAME_NUMBER;
        words.windows(2).filter(is_other).count() as f32 / words.len() as f32
    }

    fn is_penumbra(&self) -> bool {
        false
    }
}
