//! What a periodogram holds at each distance from frequency 0, and how alike all directions are there: radial mean and
//! anisotropy (Ulichney 1988, "Dithering with Blue Noise").

use super::Periodogram;

/// Rings a cycle a pixel at most, however long the period is: wide enough to have many frequencies each.
const MOST_RINGS_PER_CYCLE: u32 = 64;

/// The frequencies whose distances from 0 are nearest to one multiple of a width.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ring {
    /// Distance of the ring's middle from frequency 0.
    pub cycles_per_px: f64,
    /// How many frequencies it has, those outside the circle that fits into the spectrum too.
    pub frequency_count: usize,
    /// Mean of their powers.
    pub power: f64,
    /// Variance of their powers over the square of the mean: 1 on average for independent samples or values, as powers
    /// are then spread exponentially; 0 where all directions are equal. None with one pair of frequencies, or power 0.
    pub anisotropy: Option<f64>,
}

impl Periodogram {
    /// Rings from the innermost to the corners of the spectrum; together they have every frequency but 0 once.
    ///
    /// Their width is one cycle on the shorter side of the period, but at least 1/64 cycle a pixel. f and -f have the same
    /// power, so half of the frequencies are independent: the variance is the sum of squares over n - 2, where Ulichney's
    /// is over n - 1.
    pub fn rings(&self) -> Vec<Ring> {
        let rings_per_cycle = self.period_px[0].min(self.period_px[1]).min(MOST_RINGS_PER_CYCLE);
        let mut powers: Vec<Vec<f64>> = Vec::new();
        for (distance, power) in self.by_distance() {
            let ring = (distance * f64::from(rings_per_cycle)).round() as usize;
            if powers.len() <= ring {
                powers.resize(ring + 1, Vec::new());
            }
            powers[ring].push(power);
        }
        let ring = |(index, powers): (usize, &Vec<f64>)| {
            let count = powers.len() as f64;
            let mean = powers.iter().sum::<f64>() / count;
            let squares: f64 = powers.iter().map(|power| (power - mean).powi(2)).sum();
            Ring {
                cycles_per_px: index as f64 / f64::from(rings_per_cycle),
                frequency_count: powers.len(),
                power: mean,
                anisotropy: (powers.len() > 2 && mean > 0.0).then(|| squares / (count - 2.0) / (mean * mean)),
            }
        };
        powers.iter().enumerate().filter(|(_, powers)| !powers.is_empty()).map(ring).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::pattern::Pattern;
    use crate::sampling::pcg::Pcg32;

    /// Every frequency but 0 is in one ring, so that rings add up to the variance.
    #[test]
    fn rings_add_up() {
        for size_px in [[1, 1], [1, 7], [40, 9], [130, 90], [33, 200]] {
            let mut random = Pcg32::new(7, 0);
            let values: Vec<f64> = (0..size_px[0] * size_px[1]).map(|_| f64::from(random.unit())).collect();
            let count = values.len() as f64;
            let mean = values.iter().sum::<f64>() / count;
            let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count;
            let rings = Periodogram::of_raster(&values, size_px).rings();
            assert_eq!(rings.iter().map(|ring| ring.frequency_count).sum::<usize>(), values.len() - 1);
            let sum: f64 = rings.iter().map(|ring| ring.power * ring.frequency_count as f64).sum();
            assert!((sum / count - variance).abs() <= 1e-6 * variance, "{size_px:?}: {} of {variance}", sum / count);
            let last = rings.last().map_or(0.0, |ring| ring.cycles_per_px);
            assert!(last < 0.5f64.sqrt() + 0.5, "{size_px:?}: {last}");
        }
    }

    /// White noise has its variance and an anisotropy of 1 in every ring: powers are near an exponential distribution, of
    /// which the mean of n pairs has a standard error of 1 / sqrt(n), and variance over squared mean one of 2 / sqrt(n).
    #[test]
    fn white_noise_is_flat_and_alike_in_all_directions() {
        let mut random = Pcg32::new(5, 0);
        let values: Vec<f64> = (0..256 * 200).map(|_| f64::from(random.unit()) - 0.5).collect();
        let found = Periodogram::of_raster(&values, [256, 200]);
        let rings = found.rings();
        assert_eq!(rings.len(), 46);
        for ring in rings.iter().filter(|ring| ring.frequency_count >= 100) {
            let pairs = ring.frequency_count as f64 / 2.0;
            assert!((ring.power * 12.0 - 1.0).abs() < 4.0 / pairs.sqrt(), "{ring:?}");
            assert!((ring.anisotropy.unwrap() - 1.0).abs() < 4.0 * 2.0 / pairs.sqrt(), "{ring:?}");
        }
    }

    /// n frequencies of which two have all the power p: a mean of 2 p / n and, of the squares, 2 p^2 - 4 p^2 / n.
    #[test]
    fn one_direction_has_an_anisotropy_of_half_the_frequencies() {
        let wave: Vec<f64> =
            (0..64 * 64).map(|index| (std::f64::consts::TAU * 10.0 * f64::from(index % 64) / 64.0).cos()).collect();
        let rings = Periodogram::of_raster(&wave, [64, 64]).rings();
        let ring = rings[9];
        let count = ring.frequency_count as f64;
        assert_eq!(ring.cycles_per_px, 10.0 / 64.0);
        assert!((ring.power * count - 2.0 * 1024.0).abs() < 1e-2, "{ring:?}");
        assert!((ring.anisotropy.unwrap() - count / 2.0).abs() < 1e-4 * count, "{ring:?}");
        assert!(rings.iter().enumerate().all(|(index, ring)| index == 9 || ring.power < 1e-6));
    }

    /// A sample a pixel: what power there is, is in the four frequencies of a ring of one cycle a pixel.
    #[test]
    fn rings_of_a_pattern_count_in_cycles_a_pixel() {
        let rings = Periodogram::new(&Pattern::grid([4, 4]), [4, 4], |_| true).rings();
        let loud: Vec<f64> = rings.iter().filter(|ring| ring.power > 1e-6).map(|ring| ring.cycles_per_px).collect();
        assert_eq!(loud, [1.0, 1.5]);
        let one = Periodogram::new(&Pattern::grid([1, 1]), [1, 1], |_| true).rings();
        let only = Ring { cycles_per_px: 1.0, frequency_count: 8, power: 1.0, anisotropy: Some(0.0) };
        assert_eq!(one, [only]);
    }
}
