//! Homogeneous media: the twin of glsl/shading/medium.glsl's phase function, and what `--medium` says.

use crate::settings::Values;

/// A homogeneous medium that does something.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Medium {
    /// Light that a metre scatters and absorbs, each at least 0, not both 0.
    pub scattering: f64,
    pub absorption: f64,
    /// Mean cosine of the angle by which light is turned.
    pub asymmetry: f64,
}

impl Medium {
    /// The value of `--medium`; None where there is none, or one that does nothing.
    pub fn from_values(values: &Values) -> Option<Self> {
        let [scattering, absorption, asymmetry] = values.numbers_or_none("medium")?;
        (scattering + absorption > 0.0).then_some(Self { scattering, absorption, asymmetry })
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
}

#[cfg(test)]
mod tests {
    use super::*;

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
