//! How many samples a pixel has, and how many tuples they share (`--spp`, `--tuples`, `--sample-memory`).
//!
//! Where something is blurred, a pixel that sees all tuples shows no pattern of the table that they are spread over, and has less
//! error than a filter leaves of fewer samples. Each tuple is drawn, however few pixels have it, so that four times as many samples
//! take less than twice as long. So `auto` is as many as a stated memory holds, up to 32. Where nothing is blurred samples smooth
//! edges alone.
//!
//! Differs from the paper: its figures have 8 samples of 32 tuples (Clarberg & Munkberg 2014, sections 4.2 and 6).

use crate::settings::Values;

/// Samples of a blurred picture, and its tuples, at most.
pub const BLURRED: u32 = 32;

/// Samples of a picture in which nothing is blurred.
const SHARP: u32 = 8;

/// Bytes that are reckoned for a sample: those of all buffers together at most, whichever settings lists have, so that none that
/// leaves the picture as it is changes the number of samples.
const RECKONED_BYTES: u64 = 64;

/// Samples a pixel of one set, for one eye: `--spp`; auto: as `up_to` 32 where something is blurred, 8 where nothing is, or the
/// largest power of two of which those of `pixels` (of all eyes) take at most `--sample-memory`, at least 1.
pub fn samples(values: &Values, is_blurred: bool, pixels: u64) -> u32 {
    let most = if is_blurred { BLURRED } else { SHARP };
    let fitting = values.bytes("sample-memory").map_or(u64::MAX, |bytes| bytes / (pixels * RECKONED_BYTES).max(1));
    up_to(values, 1 << most.ilog2().min(fitting.max(1).ilog2()))
}

/// `--spp`; auto: `most`, at least 1, or where `--tuples` says how many there are, its largest divisor up to that.
pub fn up_to(values: &Values, most: u32) -> u32 {
    let divisor = |tuples: u64| (1..=most).rev().find(|samples| tuples.is_multiple_of(u64::from(*samples)));
    let auto = || values.unless_auto("tuples", Values::integer).and_then(divisor).unwrap_or(most);
    values.unless_auto("spp", Values::integer).map_or_else(auto, |samples| samples as u32)
}

/// Tuples of one eye: `--tuples`; auto: as many as `samples`; where something is blurred doubled once or twice, to at most 32.
pub fn tuples(values: &Values, samples: u32, is_blurred: bool) -> u32 {
    values.unless_auto("tuples", Values::integer).map_or_else(
        || {
            let most = if is_blurred { (4 * samples).min(BLURRED) } else { 0 };
            let mut tuples = samples;
            while 2 * tuples <= most {
                tuples *= 2;
            }
            tuples
        },
        |tuples| tuples as u32,
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::techniques::deep_shading::settings::SETTINGS;

    fn with(changes: &[(&str, &str)]) -> Values {
        let mut values = Values::defaults(SETTINGS);
        for (key, text) in changes {
            values.set(SETTINGS.iter().find(|row| row.key == *key).unwrap(), text).unwrap();
        }
        values
    }

    #[test]
    fn as_many_samples_as_the_stated_memory_holds() {
        let auto = |memory, is_blurred, pixels| samples(&with(&[("sample-memory", memory)]), is_blurred, pixels);
        let (small, wide) = (640 * 360, 1280 * 720);
        assert_eq!([auto("2GiB", true, wide), auto("1GiB", true, wide), auto("1GiB", true, small)], [32, 16, 32]);
        // To the byte.
        assert_eq!([auto("58982400", true, wide), auto("58982399", true, wide)], [1, 1]);
        assert_eq!([auto("117964800", true, wide), auto("117964799", true, wide)], [2, 1]);
        assert_eq!([auto("2GiB", false, wide), auto("none", false, wide), auto("100MiB", false, wide)], [8, 8, 1]);
        assert_eq!(auto("none", true, u64::MAX / 128), 32);
        assert_eq!(samples(&with(&[("spp", "5"), ("sample-memory", "1KiB")]), true, wide), 5);
    }

    /// A number of tuples is possible by itself.
    #[test]
    fn samples_divide_the_tuples_that_are_asked_for() {
        let pairs = [("16", 16), ("24", 24), ("48", 24), ("37", 1), ("64", 32), ("2048", 32)];
        assert_eq!(pairs.map(|(tuples, _)| (tuples, samples(&with(&[("tuples", tuples)]), true, 1))), pairs);
        assert_eq!(samples(&with(&[("tuples", "32")]), false, 1), 8);
    }

    #[test]
    fn blurred_pictures_have_at_most_32_tuples_and_others_those_of_a_pixel() {
        let auto = |samples, is_blurred| tuples(&with(&[]), samples, is_blurred);
        let pairs =
            [(1, 4), (2, 8), (3, 12), (5, 20), (8, 32), (12, 24), (16, 32), (31, 31), (32, 32), (33, 33), (64, 64)];
        assert_eq!(pairs.map(|(samples, _)| (samples, auto(samples, true))), pairs);
        assert_eq!([1, 3, 8, 64].map(|samples| auto(samples, false)), [1, 3, 8, 64]);
        assert_eq!(tuples(&with(&[("tuples", "24")]), 8, true), 24);
    }
}
