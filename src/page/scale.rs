//! A plot's axis: from numbers to places on it, and the round numbers that are marked.

/// Ratio of the greatest number to the least from which on the scale is logarithmic.
const LOGARITHMIC_FROM: f64 = 20.0;

pub struct Scale {
    least: f64,
    greatest: f64,
    is_logarithmic: bool,
    /// Places of the least and the greatest.
    ends: [f64; 2],
}

impl Scale {
    /// From 0, or where numbers differ much from below the least of them. None where there are no two different numbers, or one that is
    /// negative.
    pub fn of(numbers: impl Iterator<Item = f64>, ends: [f64; 2]) -> Option<Self> {
        let finite = numbers.filter(|number| number.is_finite());
        let (least, greatest) =
            finite.fold((f64::INFINITY, 0.0_f64), |(low, high), number| (low.min(number), high.max(number)));
        if least < 0.0 || greatest <= least {
            return None;
        }
        let is_logarithmic = least > 0.0 && greatest / least > LOGARITHMIC_FROM;
        let least = if is_logarithmic { least / 1.2 } else { 0.0 };
        Some(Self { least, greatest: greatest * 1.05, is_logarithmic, ends })
    }

    pub fn place(&self, number: f64) -> f64 {
        let part = match self.is_logarithmic {
            true => (number.max(self.least) / self.least).ln() / (self.greatest / self.least).ln(),
            false => (number - self.least) / (self.greatest - self.least),
        };
        self.ends[0] + part * (self.ends[1] - self.ends[0])
    }

    /// Round numbers to be marked.
    pub fn ticks(&self) -> Vec<f64> {
        if self.is_logarithmic {
            let powers = self.least.log10().ceil() as i32..=self.greatest.log10().floor() as i32;
            let powers: Vec<f64> = powers.map(|power| 10_f64.powi(power)).collect();
            if powers.len() > 1 {
                return powers;
            }
        }
        let rough = (self.greatest - self.least) / 4.0;
        let power = 10_f64.powf(rough.log10().floor());
        let step =
            [1.0, 2.0, 5.0, 10.0].map(|digit| digit * power).into_iter().find(|step| *step >= rough).unwrap_or(rough);
        let first = (self.least / step).ceil() as i64;
        (first..).map(|index| index as f64 * step).take_while(|tick| *tick <= self.greatest).collect()
    }
}

/// A tick's number without what says nothing; of small numbers their first digits.
pub fn short(tick: f64) -> String {
    if tick != 0.0 && tick.abs() < 1e-3 {
        return format!("{tick:e}");
    }
    let text = format!("{tick:.4}");
    text.trim_end_matches('0').trim_end_matches('.').to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_lie_where_their_scale_says() {
        let of = |numbers: &[f64]| Scale::of(numbers.iter().copied(), [300.0, 730.0]);
        let scale = of(&[1.0, 4.0]).unwrap();
        assert!(!scale.is_logarithmic && scale.place(0.0) == 300.0);
        assert!((scale.place(2.1) - 515.0).abs() < 1e-9, "half of 4.2");
        assert_eq!(scale.ticks(), [0.0, 2.0, 4.0]);
        let wide = of(&[1.0, 1000.0]).unwrap();
        assert!(wide.is_logarithmic);
        let [a, b, c] = [1.0, 10.0, 100.0].map(|number| wide.place(number));
        assert!((c - b - (b - a)).abs() < 1e-9, "equal factors are equal ways");
        assert_eq!(wide.ticks(), [1.0, 10.0, 100.0, 1000.0]);
        assert!(of(&[1.0, 1.0]).is_none() && of(&[-1.0, 1.0]).is_none() && of(&[f64::NAN]).is_none());
        // An axis may go up, where places get smaller.
        assert_eq!(Scale::of([0.0, 2.0].into_iter(), [100.0, 0.0]).unwrap().place(2.1), 0.0);
    }

    #[test]
    fn ticks_are_short() {
        let texts = [0.5, 20.0, 0.0, 0.0002].map(short);
        assert_eq!(texts, ["0.5", "20", "0", "2e-4"]);
    }
}
