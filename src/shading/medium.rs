//! Homogeneous media: the twin of glsl/shading/medium.glsl, and what `--medium` says.

use crate::gpu::shader::structs::MediumBlock;
use crate::scene::{Light, LightSource, Scene};
use crate::settings::{MEDIUM, Values};
use glam::Vec3;

pub use crate::scene::Medium;

impl Medium {
    /// The value of `--medium`: Some(None) where it is none, or one that does nothing; None at `auto`, where the
    /// scene says.
    pub fn asked(values: &Values) -> Option<Option<Self>> {
        let asked = values.unless_auto(MEDIUM.key, |values, key| values.numbers_or_none(key))?;
        let medium = asked.map(|[scattering, absorption, asymmetry]| Self { scattering, absorption, asymmetry });
        Some(medium.filter(|medium| medium.extinction() > 0.0))
    }

    /// What `--medium` comes to in `scene`, whose own it is at `auto`; None where there is none, or one that does
    /// nothing.
    pub fn chosen(values: &Values, scene: &Scene) -> Option<Self> {
        Self::asked(values).unwrap_or(scene.medium)
    }

    /// As `--medium` takes it.
    pub fn text(medium: Option<Self>) -> String {
        medium.map_or("none".to_owned(), |Self { scattering, absorption, asymmetry }| {
            format!("{scattering},{absorption},{asymmetry}")
        })
    }

    /// What a metre takes from a ray.
    pub fn extinction(&self) -> f64 {
        self.scattering + self.absorption
    }

    /// Density over solid angle of being turned by an angle of this cosine (Henyey and Greenstein 1941).
    pub fn phase(&self, cosine: f64) -> f64 {
        let squared = self.asymmetry * self.asymmetry;
        let base = 1.0 + squared - 2.0 * self.asymmetry * cosine;
        (1.0 - squared) / (4.0 * std::f64::consts::PI * base.powf(1.5))
    }

    /// The medium in its box: around all that is drawn while animations play, the eye, and the lights that are
    /// somewhere. Outside it, light from the sun and the sky comes undimmed.
    pub fn around<'a>(&self, scene: &Scene, eye: Vec3, lights: impl Iterator<Item = &'a Light>) -> MediumBlock {
        let mut bounds = scene.lasting_bounds();
        bounds.include(eye);
        for light in lights {
            if let LightSource::At(position) = light.source() {
                bounds.include(position);
            }
        }
        MediumBlock {
            min_ws: bounds.min.extend(0.0).to_array(),
            max_ws: bounds.max.extend(0.0).to_array(),
            scattering: self.scattering as f32,
            extinction: self.extinction() as f32,
            asymmetry: self.asymmetry as f32,
            _unused: 0,
        }
    }
}

impl MediumBlock {
    /// Where its box begins and ends on the first `distance` metres of a ray.
    pub fn stretch(&self, origin: Vec3, direction: Vec3, distance: f32) -> [f32; 2] {
        let inverse = Vec3::select(direction.cmpeq(Vec3::ZERO), Vec3::splat(1e-20), direction).recip();
        let [near, far] = [self.min_ws, self.max_ws].map(|[x, y, z, _]| (Vec3::new(x, y, z) - origin) * inverse);
        let begin = near.min(far).max_element().max(0.0);
        let end = near.max(far).min_element().min(distance);
        [begin, begin.max(end)]
    }

    /// Part of the light that passes the first `distance` metres of a ray.
    pub fn passed(&self, origin: Vec3, direction: Vec3, distance: f32) -> f32 {
        let [begin, end] = self.stretch(origin, direction, distance);
        (-self.extinction * (end - begin)).exp()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box of 2 x 4 x 6 m around the origin, and outside it nothing.
    #[test]
    fn light_is_dimmed_inside_the_box_alone() {
        let medium = MediumBlock {
            min_ws: [-1.0, -2.0, -3.0, 0.0],
            max_ws: [1.0, 2.0, 3.0, 0.0],
            extinction: 0.5,
            ..bytemuck::Zeroable::zeroed()
        };
        for (origin, direction, distance, metres) in [
            (Vec3::ZERO, Vec3::X, 9.0, 1.0),
            (Vec3::new(-5.0, 1.0, 0.0), Vec3::X, 100.0, 2.0),
            (Vec3::new(-5.0, 1.0, 0.0), Vec3::X, 4.5, 0.5),
            (Vec3::new(0.0, 0.0, 9.0), -Vec3::Z, 8.0, 2.0),
            (Vec3::new(0.0, 0.0, 9.0), Vec3::Z, 8.0, 0.0),
            (Vec3::new(0.0, 3.0, 0.0), Vec3::X, 8.0, 0.0),
            (Vec3::new(-2.0, -2.0, 0.0), Vec3::new(1.0, 1.0, 0.0).normalize(), 50.0, 2.0 * std::f32::consts::SQRT_2),
        ] {
            let passed = medium.passed(origin, direction, distance);
            assert!((passed - (-0.5 * metres).exp()).abs() < 1e-6, "{origin} {direction}: {passed}, {metres} m");
        }
    }

    /// Over all directions the density sums to 1, and the cosine to the asymmetry.
    #[test]
    fn the_phase_function_has_its_mean_cosine() {
        for asymmetry in [-0.7, 0.0, 0.3, 0.9] {
            let medium = Medium { scattering: 1.0, absorption: 0.0, asymmetry };
            let (steps, mut sum, mut mean) = (100_000, 0.0, 0.0);
            for step in 0..steps {
                let cosine = -1.0 + 2.0 * (f64::from(step) + 0.5) / f64::from(steps);
                let part = 4.0 * std::f64::consts::PI / f64::from(steps) * medium.phase(cosine);
                sum += part;
                mean += part * cosine;
            }
            assert!((sum - 1.0).abs() < 1e-5 && (mean - asymmetry).abs() < 1e-5, "{asymmetry}: {sum} {mean}");
        }
    }
}
