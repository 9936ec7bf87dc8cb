//! Flicker of a sequence of pictures from a camera that stands still, in two numbers: what jumps from frame to frame, where
//! light moves smoothly (Dubla et al. 2009, section 4.1, say where a sampling flickers and measure none of it).

use crate::picture::Picture;
use crate::picture::tonemap::{REC709_WEIGHTS, weighted};
use std::collections::VecDeque;

/// Linear luminance of each pixel.
fn luminances(picture: &Picture) -> Vec<f64> {
    picture.pixels.iter().map(|pixel| weighted(pixel.map(f64::from), REC709_WEIGHTS)).collect()
}

/// Root of a mean square in parts of a mean.
#[derive(Clone, Debug, Default)]
struct Relative {
    squares: f64,
    square_count: usize,
    sum: f64,
    count: usize,
}

impl Relative {
    fn add_base(&mut self, luminances: &[f64]) {
        self.sum += luminances.iter().sum::<f64>();
        self.count += luminances.len();
    }

    fn add_changes(&mut self, changes: impl Iterator<Item = f64>) {
        for change in changes {
            self.squares += change * change;
            self.square_count += 1;
        }
    }

    /// None where there is no change, or the mean is not above 0.
    fn value(&self) -> Option<f64> {
        let rms = (self.squares / self.square_count as f64).sqrt();
        let value = rms / (self.sum / self.count as f64);
        (self.square_count > 0 && self.sum > 0.0).then_some(value)
    }
}

/// Flicker without a reference: second differences over time. Light that grows or fades evenly has none.
#[derive(Clone, Debug, Default)]
pub struct FlickerMeter {
    /// The last two frames.
    earlier: VecDeque<Vec<f64>>,
    sums: Relative,
}

impl FlickerMeter {
    /// The next frame, of the size of those before.
    pub fn add(&mut self, picture: &Picture) {
        let then = luminances(picture);
        self.sums.add_base(&then);
        if let [first, second] = self.earlier.make_contiguous() {
            let changes = first.iter().zip(second.iter()).zip(&then).map(|((a, b), c)| a - 2.0 * b + c);
            self.sums.add_changes(changes);
            self.earlier.pop_front();
        }
        self.earlier.push_back(then);
    }

    /// Root of the mean square, over pixels and inner frames, of `p[t - 1] - 2 p[t] + p[t + 1]`, p linear luminance, in
    /// parts of the mean of p over all; None of fewer than three frames, or of black ones.
    pub fn value(&self) -> Option<f64> {
        self.sums.value()
    }
}

/// Flicker against a reference of each frame: how much the error changes. What moves in both has none, however it moves.
#[derive(Clone, Debug, Default)]
pub struct ErrorFlickerMeter {
    /// Errors of the last frame.
    earlier: Option<Vec<f64>>,
    sums: Relative,
}

impl ErrorFlickerMeter {
    /// The next frame and its reference, both of the size of those before.
    pub fn add(&mut self, picture: &Picture, reference: &Picture) {
        let truth = luminances(reference);
        self.sums.add_base(&truth);
        let then: Vec<f64> =
            luminances(picture).into_iter().zip(&truth).map(|(actual, truth)| actual - truth).collect();
        if let Some(before) = &self.earlier {
            self.sums.add_changes(before.iter().zip(&then).map(|(before, then)| then - before));
        }
        self.earlier = Some(then);
    }

    /// Root of the mean square, over pixels and pairs of frames one after the other, of `e[t + 1] - e[t]`, e the error of
    /// linear luminance, in parts of the references' mean luminance; None of one frame, or of black references.
    pub fn value(&self) -> Option<f64> {
        self.sums.value()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::units::Extent;

    /// Grey frames of two pixels.
    fn frames(of: impl Fn(f32) -> [f32; 2], count: u32) -> Vec<Picture> {
        let frame = |time: u32| Picture {
            extent: Extent::new(2, 1),
            pixels: of(time as f32).map(|luminance| [luminance; 3]).to_vec(),
        };
        (0..count).map(frame).collect()
    }

    fn flicker(frames: &[Picture]) -> Option<f64> {
        let mut meter = FlickerMeter::default();
        frames.iter().for_each(|frame| meter.add(frame));
        meter.value()
    }

    fn error_flicker(frames: &[Picture], references: &[Picture]) -> Option<f64> {
        let mut meter = ErrorFlickerMeter::default();
        frames.iter().zip(references).for_each(|(frame, reference)| meter.add(frame, reference));
        meter.value()
    }

    #[track_caller]
    fn is_about(found: Option<f64>, expected: f64) {
        assert!((found.unwrap() - expected).abs() < 1e-6, "{found:?} for {expected}");
    }

    #[test]
    fn light_that_changes_evenly_does_not_flicker() {
        is_about(flicker(&frames(|time| [1.0 + 0.25 * time, 4.0 - 0.5 * time], 6)), 0.0);
    }

    #[test]
    fn what_jumps_by_plus_and_minus_a_has_four_a_in_parts_of_the_mean() {
        let sign = |time: f32| if time % 2.0 == 0.0 { 1.0 } else { -1.0 };
        is_about(flicker(&frames(|time| [2.0 + 0.5 * sign(time); 2], 6)), 4.0 * 0.5 / 2.0);
        // In one of two pixels: the mean square is half of it. The other is brighter, and so is the mean.
        is_about(flicker(&frames(|time| [2.0 + 0.5 * sign(time), 6.0], 6)), 4.0 * 0.5 / 2f64.sqrt() / 4.0);
    }

    #[test]
    fn a_parabola_has_twice_its_factor() {
        // 0, 1, 4, 9: the second difference is 2, the mean 3.5.
        is_about(flicker(&frames(|time| [time * time; 2], 4)), 2.0 / 3.5);
    }

    #[test]
    fn colours_count_by_their_luminance() {
        let extent = Extent::new(1, 1);
        let of = |color: [f32; 3]| Picture { extent, pixels: vec![color] };
        let green = [of([0.0, 1.0, 0.0]), of([0.0, 3.0, 0.0]), of([0.0, 1.0, 0.0])];
        is_about(flicker(&green), 4.0 / (5.0 / 3.0));
        // Red and blue that go against each other by their weights do not change the luminance.
        let blue = (REC709_WEIGHTS[0] / REC709_WEIGHTS[2]) as f32;
        is_about(flicker(&[of([1.0, 1.0, 0.0]), of([0.0, 1.0, blue]), of([1.0, 1.0, 0.0])]), 0.0);
    }

    #[test]
    fn an_error_that_stays_does_not_flicker_and_one_that_jumps_does() {
        // The truth itself may move as it likes.
        let references = frames(|time| [1.0 + (time * time) % 3.0, 2.0], 5);
        let with = |error: fn(f32) -> f32| {
            let of = |(time, reference): (usize, &Picture)| Picture {
                pixels: reference
                    .pixels
                    .iter()
                    .map(|pixel| pixel.map(|channel| channel + error(time as f32)))
                    .collect(),
                ..reference.clone()
            };
            references.iter().enumerate().map(of).collect::<Vec<_>>()
        };
        is_about(error_flicker(&references, &references), 0.0);
        is_about(error_flicker(&with(|_| 0.5), &references), 0.0);
        // 1, 2, 2, 1, 2 in one pixel and 2 in the other: 1.8 in the mean.
        is_about(error_flicker(&with(|time| 0.3 * (time % 2.0)), &references), 0.3 / 1.8);
    }

    #[test]
    fn too_few_or_black_frames_have_none() {
        assert_eq!(flicker(&frames(|_| [1.0; 2], 2)), None);
        assert_eq!(flicker(&frames(|_| [0.0; 2], 3)), None);
        let one = frames(|_| [1.0; 2], 1);
        assert_eq!(error_flicker(&one, &one), None);
    }
}
