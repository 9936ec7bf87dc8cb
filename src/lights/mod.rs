//! Which lights there are, and which reach what: the scene's own, scattered ones, the default rig, virtual ones.

pub mod area;
pub mod emission;
pub mod emitters;
pub mod object_lists;
pub mod pieces;
pub mod shadow_casters;
pub mod shadow_volume;
pub mod vpl;

use crate::error::{Error, Result};
use crate::frame::View;
use crate::scene::{Light, LightKind, Material, Scene};
use crate::settings::{Rig, Values, light_radius_m, parse_color};
use glam::Vec3;

/// The default rig's key light, in lux: white, from the camera's upper left.
const RIG_KEY_LUX: f32 = 3.0;
/// The default rig's ambient radiance.
const RIG_AMBIENT: f32 = 0.3;
/// Radiance of white diffuse surfaces under the rig, on average over a closed convex body: the key light falls on its
/// projection, a quarter of its surface (Cauchy's formula); ambient light on all of it.
const RIG_RADIANCE: f64 = (RIG_KEY_LUX as f64 / 4.0) / std::f64::consts::PI + RIG_AMBIENT as f64;
/// Radiance that counts as dark: this part of what the rig gives, code 46 of 255 at exposure 0.
const FAINT_RADIANCE: f64 = 0.05 * RIG_RADIANCE;
/// Emissive surfaces are the scene's light where at least this part of its area is not dark by them
/// (`emission::lit_part`). A half, because nothing known lies near it.
///
/// The part is 0.000 of WaterBottle, 0.011 of DamagedHelmet and 0.108 of MultiUVTest among Khronos' samples, 0.15 of a map whose
/// lamps are punctual lights left out, and 1 of `cornell` and `power` by their panels alone.
const LEAST_LIT_PART: f64 = 0.5;
/// Irradiance that all scattered lights together give the scene's box on average, in lux: white diffuse surfaces then
/// have radiance 1.
const SCATTERED_LUX: f32 = std::f32::consts::PI;

/// Every punctual light of a picture, and the light from everywhere.
#[derive(Clone, Debug)]
pub struct LightSet {
    pub lights: Vec<Light>,
    /// Radiance.
    pub ambient: Vec3,
    /// The scene had no light of its own, or a faint glow, and got the rig; or `--rig always`.
    pub has_rig: bool,
    /// Where emissive surfaces did not keep the rig away: the part of the scene that they light (`emission::lit_part`).
    pub faint_part: Option<f64>,
    /// Nothing but emissive surfaces lights the scene.
    pub is_emissive_alone: bool,
    /// The scene, or `--lights`, has punctual lights that are not the rig's.
    pub has_punctual: bool,
}

impl LightSet {
    /// Collects the lights that the settings leave.
    ///
    /// Errors: `--lights` or `--ambient` cannot be read (exit code 2).
    pub fn new(scene: &Scene, view: &View, values: &Values) -> Result<Self> {
        Self::collect(scene, view, values, None)
    }

    /// The same of `scene` when the shutter closes: under the rig as when it opened, which is here.
    ///
    /// Errors: as `new`.
    pub fn closing(&self, scene: &Scene, view: &View, values: &Values) -> Result<Self> {
        Self::collect(scene, view, values, Some(self))
    }

    fn collect(scene: &Scene, view: &View, values: &Values, opening: Option<&Self>) -> Result<Self> {
        let sun = values.is_on("sun");
        let kept = |light: &&Light| sun || !light.kind.is_directional();
        let mut lights: Vec<Light> = scene.lights.iter().filter(kept).cloned().collect();
        lights.extend(scattered(scene, values)?);
        for light in &mut lights {
            light.radius = light_radius_m(values);
        }
        let has_punctual = !lights.is_empty();
        let emissive = scene.drawn_materials().any(Material::is_emissive);
        let (has_rig, faint_part) = match (opening, values.choice("rig")) {
            (Some(opening), _) => (opening.has_rig, opening.faint_part),
            (None, Rig::Default) if has_punctual => (false, None),
            (None, Rig::Default) if emissive => {
                let part = emission::lit_part(scene, FAINT_RADIANCE);
                (part < LEAST_LIT_PART, Some(part).filter(|part| *part < LEAST_LIT_PART))
            }
            (None, rig) => (rig != Rig::None, None),
        };
        if has_rig {
            lights.push(rig_key(view));
        }
        let ambient = match values.text("ambient") {
            "auto" if has_rig => Vec3::splat(RIG_AMBIENT),
            "auto" => Vec3::ZERO,
            text => parse_color(text).ok_or_else(|| {
                Error::request(format!("--ambient {text}: it must be R,G,B or one number, each at least 0, or auto"))
            })?,
        };
        let is_emissive_alone = emissive && lights.is_empty() && ambient == Vec3::ZERO;
        Ok(Self { lights, ambient, has_rig, faint_part, is_emissive_alone, has_punctual })
    }

    /// Directional lights.
    pub fn sun_count(&self) -> usize {
        self.lights.iter().filter(|light| light.kind.is_directional()).count()
    }
}

fn rig_key(view: &View) -> Light {
    let camera = &view.camera.world_from_view;
    let from = camera.transform_vector3(Vec3::new(-1.0, 1.0, 1.0)).normalize();
    Light {
        name: "rig.key".to_owned(),
        kind: LightKind::Directional,
        intensity: Vec3::splat(RIG_KEY_LUX),
        position: Vec3::ZERO,
        direction: -from,
        range: None,
        radius: 0.0,
    }
}

/// `--lights N[:SEED]`: point lights of mixed colours all over the scene's box, low-discrepancy.
fn scattered(scene: &Scene, values: &Values) -> Result<Vec<Light>> {
    const MOST: u32 = 65_536;
    let text = values.text("lights");
    let wrong = || {
        Error::request(format!("--lights {text}: it must be N or N:SEED, with N from 0 to {MOST}"))
            .note("for example --lights 64 or --lights 64:7")
    };
    let (count, seed) = match text.split_once(':') {
        None => (text, values.integer("seed") as u32),
        Some((count, seed)) => (count, seed.parse().map_err(|_| wrong())?),
    };
    let count: u32 = count.parse().ok().filter(|count| *count <= MOST).ok_or_else(wrong)?;
    let bounds = scene.lasting_bounds();
    if count == 0 || bounds.is_empty() {
        return Ok(Vec::new());
    }
    let size = bounds.max - bounds.min;
    let area = 2.0 * (size.x * size.y + size.y * size.z + size.z * size.x);
    // All lights' flux, spread evenly over the box: 4 pi I N = E A.
    let candela = SCATTERED_LUX * area / (4.0 * std::f32::consts::PI * count as f32);
    Ok((0..count)
        .map(|index| {
            let number = |axis| sobol_burley::sample(index & 0xffff, axis, seed ^ (index >> 16));
            let position = bounds.min + size * Vec3::new(number(0), number(1), number(2));
            // Three phases of one wave: every hue, the same brightness.
            let hue = number(3) * std::f32::consts::TAU;
            let wave = |phase: f32| 1.0 + 0.6 * (hue + phase).cos();
            let third = std::f32::consts::TAU / 3.0;
            Light {
                name: format!("scattered.{index}"),
                kind: LightKind::Point,
                intensity: candela * Vec3::new(wave(0.0), wave(third), wave(2.0 * third)),
                position,
                direction: -Vec3::Y,
                range: None,
                radius: 0.0,
            }
        })
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene;
    use crate::settings::COMMON;
    use crate::units::Extent;

    /// Count of lights, ambient radiance, whether there is a rig, whether only surfaces shine.
    fn lit(scene: &Scene, changes: &[(&str, &str)]) -> (usize, f32, bool, bool) {
        let mut values = Values::defaults(COMMON);
        for (key, text) in changes {
            values.set(COMMON.iter().find(|setting| setting.key == *key).unwrap(), text).unwrap();
        }
        let view = View::new(scene, "0", Extent::new(8, 8)).unwrap();
        let set = LightSet::new(scene, &view, &values).unwrap();
        (set.lights.len(), set.ambient.x, set.has_rig, set.is_emissive_alone)
    }

    #[test]
    fn a_rig_is_for_what_does_not_shine_and_for_who_asks() {
        let mut shining = scene::load("cornell", 1).unwrap();
        shining.lights.clear();
        let mut dark = shining.clone();
        dark.materials.iter_mut().for_each(|material| material.emissive = Vec3::ZERO);
        assert_eq!(lit(&dark, &[]), (1, RIG_AMBIENT, true, false));
        assert_eq!(lit(&dark, &[("rig", "none")]), (0, 0.0, false, false));
        assert_eq!(lit(&shining, &[]), (0, 0.0, false, true));
        assert_eq!(lit(&shining, &[("rig", "always")]), (1, RIG_AMBIENT, true, false));
        let mut faint = shining.clone();
        faint.materials.iter_mut().for_each(|material| material.emissive *= 0.01);
        assert_eq!(lit(&faint, &[]), (1, RIG_AMBIENT, true, false));
        assert_eq!(lit(&faint, &[("rig", "none")]), (0, 0.0, false, true));
        assert_eq!(lit(&faint, &[("lights", "3")]), (3, 0.0, false, false));
        assert_eq!(lit(&shining, &[("ambient", "0.1")]), (0, 0.1, false, false));
        assert_eq!(lit(&shining, &[("lights", "3"), ("rig", "always")]).0, 4);
        assert_eq!(lit(&shining, &[("lights", "3")]), (3, 0.0, false, false));
    }
}
