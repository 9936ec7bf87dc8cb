//! Errors of scene-linear light, where twice the light is twice the number.

use crate::picture::Picture;

/// Keeps relMSE finite on black, and sets how dark a pixel may be before its error stops counting more: radiance 0.1, whose
/// square this is, as papers on rendering noise choose it (Rousselle et al. 2011).
pub(super) const RELMSE_EPSILON: f64 = 0.01;

/// Root of the mean over pixels and channels of (a - b)^2. The extents are equal.
pub(super) fn rmse(a: &Picture, b: &Picture) -> f64 {
    mean(a, b, |a, b| (a - b).powi(2)).sqrt()
}

/// Mean over pixels and channels of (a - b)^2 / (b^2 + 0.01), b the reference. The extents are equal.
pub(super) fn relmse(actual: &Picture, reference: &Picture) -> f64 {
    mean(actual, reference, |a, b| (a - b).powi(2) / (b.powi(2) + RELMSE_EPSILON))
}

fn mean(a: &Picture, b: &Picture, error: impl Fn(f64, f64) -> f64) -> f64 {
    let pairs = a.pixels.as_flattened().iter().zip(b.pixels.as_flattened());
    let sum: f64 = pairs.map(|(a, b)| error(f64::from(*a), f64::from(*b))).sum();
    sum / (3 * a.pixels.len()) as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::metrics::formula_pictures;
    use crate::units::Extent;

    #[test]
    fn by_hand() {
        let reference = Picture::filled(Extent::new(2, 1), [0.0, 1.0, 2.0]);
        let mut actual = reference.clone();
        actual.pixels[0] = [0.5, 1.5, 2.5];
        // Three of six squares are 0.25.
        assert!((rmse(&actual, &reference) - 0.125f64.sqrt()).abs() < 1e-15);
        let expected = (0.25 / 0.01 + 0.25 / 1.01 + 0.25 / 4.01) / 6.0;
        assert!((relmse(&actual, &reference) - expected).abs() < 1e-12);
    }

    #[test]
    fn as_numpy_computes_them() {
        let [actual, reference] = formula_pictures(24, 16).map(|codes| codes.to_picture());
        // From the formulas in NumPy, in double precision; the pictures here are single.
        assert!((rmse(&actual, &reference) - 0.044_219_674_930).abs() < 1e-8);
        assert!((relmse(&actual, &reference) - 0.015_194_953_866).abs() < 1e-8);
    }
}
