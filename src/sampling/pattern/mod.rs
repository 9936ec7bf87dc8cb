//! Patterns: where samples are over the pixels of a period that repeats over the frame (Keller and Heidrich 2001,
//! section 2), and which subset each of them belongs to.
//!
//! Copies of one sample in all periods are a regular grid. In Keller's patterns each sample is a subset of its own, so
//! that a subset is one such grid; in Segovia's a subset is what a pixel of the pattern is shaded with. A pixel may
//! hold any number of samples, none included, and not all pixels the same, so that samples over a number of pixels may
//! be any two numbers. The period is anything from one pixel to the frame.

mod distance;
pub mod grid;
mod nets;

/// A dimension of a sample beside its place: a number of 0 to 1 without 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Dimension {
    /// Part of the time that the shutter is open.
    Time,
    /// The first of two numbers that become a place on the lens.
    LensU,
    /// The second of them.
    LensV,
    /// The first of three numbers that become a place of each light.
    LightU,
    /// The second of them.
    LightV,
    /// The third of them.
    LightW,
    /// Part of the step between two planes of a volume.
    Slice,
}

impl Dimension {
    /// Its name in files and reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Time => "time",
            Self::LensU => "lens_u",
            Self::LensV => "lens_v",
            Self::LightU => "light_u",
            Self::LightV => "light_v",
            Self::LightW => "light_w",
            Self::Slice => "slice",
        }
    }
}

/// Dimensions that a sample can have beside the two of its place.
pub const MOST_FURTHER: usize = 7;

/// One sample of a period.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Place in its pixel, px: 0 to 1 without 1 from the upper left corner; 0.5 is the middle.
    pub place_px: [f32; 2],
    /// A number for each of the pattern's further dimensions, in their order; 0 behind the last.
    pub further: [f32; MOST_FURTHER],
    /// Which of the pattern's subsets it belongs to.
    pub subset: u32,
}

impl Sample {
    /// The middle of a pixel, without further dimensions.
    pub fn middle(subset: u32) -> Self {
        Self { place_px: [0.5; 2], further: [0.0; MOST_FURTHER], subset }
    }

    /// What `further` holds of these numbers, at most `MOST_FURTHER`.
    pub fn further(numbers: impl IntoIterator<Item = f32>) -> [f32; MOST_FURTHER] {
        let mut further = [0.0; MOST_FURTHER];
        further.iter_mut().zip(numbers).for_each(|(into, number)| *into = number);
        further
    }
}

/// Samples over the pixels of one period.
#[derive(Clone, Debug, PartialEq)]
pub struct Pattern {
    period_px: [u32; 2],
    further: Vec<Dimension>,
    subset_count: u32,
    /// Pixel by pixel, row-major.
    samples: Vec<Sample>,
    /// Index of each pixel's first sample, row-major, and behind the last pixel their number.
    firsts: Vec<u32>,
}

impl Pattern {
    /// A pattern of `samples`, each with the pixel of the period that it lies in. Samples of one pixel keep their
    /// order.
    ///
    /// `period_px`: width and height, each at least 1. `further`: dimensions beside the place, at most `MOST_FURTHER`.
    pub fn new(period_px: [u32; 2], further: &[Dimension], mut samples: Vec<([u32; 2], Sample)>) -> Self {
        let [width, height] = period_px;
        assert!(width > 0 && height > 0 && further.len() <= MOST_FURTHER, "{period_px:?}, {further:?}");
        let index = |[x, y]: [u32; 2]| y as usize * width as usize + x as usize;
        let mut firsts = vec![0u32; width as usize * height as usize + 1];
        for (pixel, sample) in &samples {
            let numbers = sample.place_px.iter().chain(&sample.further);
            assert!(numbers.clone().all(|number| (0.0..1.0).contains(number)), "{sample:?}");
            assert!(pixel[0] < width && pixel[1] < height, "{pixel:?} of {period_px:?}");
            firsts[index(*pixel) + 1] += 1;
        }
        for pixel in 1..firsts.len() {
            firsts[pixel] += firsts[pixel - 1];
        }
        samples.sort_by_key(|(pixel, _)| index(*pixel));
        let samples: Vec<Sample> = samples.into_iter().map(|(_, sample)| sample).collect();
        let subset_count = samples.iter().map(|sample| sample.subset + 1).max().unwrap_or(0);
        Self { period_px, further: further.to_vec(), subset_count, samples, firsts }
    }

    /// Width and height of what repeats.
    pub fn period_px(&self) -> [u32; 2] {
        self.period_px
    }

    /// Dimensions beside the two of the place.
    pub fn further(&self) -> &[Dimension] {
        &self.further
    }

    /// Dimensions of a sample: 2 to 5.
    pub fn dimension_count(&self) -> usize {
        2 + self.further.len()
    }

    /// Number of subsets, those that hold no sample included.
    pub fn subset_count(&self) -> u32 {
        self.subset_count
    }

    /// Samples of one period, pixel by pixel in row-major order.
    pub fn samples(&self) -> &[Sample] {
        &self.samples
    }

    /// The same, each with its pixel.
    pub fn placed(&self) -> impl Iterator<Item = ([u32; 2], &Sample)> {
        let [width, height] = self.period_px;
        let pixels = (0..height).flat_map(move |y| (0..width).map(move |x| [x, y]));
        pixels.flat_map(|pixel| self.samples_of(pixel).iter().map(move |sample| (pixel, sample)))
    }

    /// Samples of a pixel anywhere in the frame.
    pub fn samples_of(&self, [x, y]: [u32; 2]) -> &[Sample] {
        let [width, height] = self.period_px;
        let pixel = (y % height) as usize * width as usize + (x % width) as usize;
        &self.samples[self.firsts[pixel] as usize..self.firsts[pixel + 1] as usize]
    }

    /// The one subset that a pixel anywhere in the frame uses; None where it holds no sample, or samples of several.
    pub fn subset_of(&self, pixel: [u32; 2]) -> Option<u32> {
        let (first, others) = self.samples_of(pixel).split_first()?;
        others.iter().all(|other| other.subset == first.subset).then_some(first.subset)
    }

    /// The least and the greatest number of samples that a pixel holds.
    pub fn samples_per_pixel(&self) -> [u32; 2] {
        let counts = self.firsts.windows(2).map(|pair| pair[1] - pair[0]);
        counts.fold([u32::MAX, 0], |[least, most], count| [least.min(count), most.max(count)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeMap;

    prop_compose! {
        /// Any number of samples over any number of pixels, each a subset of its own.
        fn any_pattern()(width in 1u32..9, height in 1u32..9)(
            places in prop::collection::vec(((0..width, 0..height), (0f32..1.0, 0f32..1.0), 0f32..1.0), 0..60),
            width in Just(width), height in Just(height),
        ) -> (Vec<([u32; 2], Sample)>, Pattern) {
            let samples: Vec<_> = (0..)
                .zip(places)
                .map(|(subset, ((x, y), (u, v), time))| {
                    ([x, y], Sample { place_px: [u, v], further: Sample::further([time]), subset })
                })
                .collect();
            (samples.clone(), Pattern::new([width, height], &[Dimension::Time], samples))
        }
    }

    /// Samples of each subset.
    fn uses(pattern: &Pattern) -> BTreeMap<u32, usize> {
        let mut uses = BTreeMap::new();
        pattern.samples().iter().for_each(|sample| *uses.entry(sample.subset).or_default() += 1);
        uses
    }

    proptest! {
        #[test]
        fn every_sample_lies_in_its_pixel_and_no_other((samples, pattern) in any_pattern()) {
            let [width, height] = pattern.period_px();
            let mut seen = 0;
            for pixel in (0..height).flat_map(|y| (0..width).map(move |x| [x, y])) {
                let own: Vec<Sample> =
                    samples.iter().filter(|(place, _)| *place == pixel).map(|(_, sample)| *sample).collect();
                prop_assert_eq!(pattern.samples_of(pixel), &own[..]);
                let [least, most] = pattern.samples_per_pixel().map(|count| count as usize);
                prop_assert!((least..=most).contains(&own.len()));
                let only = if own.len() == 1 { Some(own[0].subset) } else { None };
                prop_assert_eq!(pattern.subset_of(pixel), only);
                seen += own.len();
            }
            prop_assert_eq!(seen, pattern.samples().len());
            prop_assert_eq!(pattern.placed().count(), seen);
            prop_assert!(pattern.placed().all(|placed| samples.iter().any(|(at, own)| (*at, own) == placed)));
            prop_assert_eq!((pattern.dimension_count(), pattern.subset_count() as usize), (3, samples.len()));
        }

        #[test]
        fn the_period_repeats(
            (_, pattern) in any_pattern(), x in 0u32..40, y in 0u32..40, right in 0u32..9, down in 0u32..9,
        ) {
            let [width, height] = pattern.period_px();
            let there = [x + right * width, y + down * height];
            prop_assert_eq!(pattern.samples_of([x, y]), pattern.samples_of(there));
            prop_assert_eq!(pattern.subset_of([x, y]), pattern.subset_of(there));
        }

        #[test]
        fn what_the_program_makes_uses_every_subset_equally(
            sides in (1u32..9, 1u32..9), samples in 1u32..9, seed in any::<u32>(), run in 0u32..4,
        ) {
            let sides = [sides.0, sides.1];
            for pattern in [Pattern::grid(sides), Pattern::nets(sides, samples, seed, run)] {
                let uses = uses(&pattern);
                prop_assert_eq!(uses.len(), pattern.subset_count() as usize);
                let least = uses.values().min().unwrap();
                prop_assert!(uses.values().all(|count| count == least));
                let [least, most] = pattern.samples_per_pixel();
                prop_assert_eq!(least, most);
                prop_assert_eq!(most as usize * (sides[0] * sides[1]) as usize, pattern.samples().len());
            }
        }
    }

    /// Five samples over two pixels: 2.5 a pixel.
    #[test]
    fn pixels_may_hold_different_numbers_of_samples() {
        let places = [0.1f32, 0.5, 0.9, 0.3, 0.7];
        let sample = |(index, place): (usize, f32)| {
            ([u32::from(index > 2), 0], Sample { place_px: [place, 0.5], ..Sample::middle(index as u32) })
        };
        let pattern = Pattern::new([2, 1], &[], places.into_iter().enumerate().map(sample).collect());
        assert_eq!((pattern.samples_per_pixel(), pattern.dimension_count()), ([2, 3], 2));
        assert_eq!(pattern.samples_of([5, 7]).iter().map(|sample| sample.subset).collect::<Vec<_>>(), [3, 4]);
        assert_eq!(pattern.subset_of([5, 7]), None);
        let empty = Pattern::new([3, 2], &[], Vec::new());
        assert_eq!((empty.samples_per_pixel(), empty.subset_of([0, 0]), empty.subset_count()), ([0, 0], None, 0));
    }
}
