//! Pictures that are means of samples: how many of them there are, and the error at which they are enough (`--until-error`).

use crate::settings::Values;

/// Samples of a pixel, at most: float sums of more lose what a sample adds.
pub const MOST_SAMPLES: u32 = 1 << 16;

/// The error that `--until-error` asks for; None: no such bound.
pub fn until_error(values: &Values) -> Option<f64> {
    Some(values.number("until-error")).filter(|error| *error > 0.0)
}

/// Samples of a pixel, at most where `until_error` ends them: what the setting `key` says; `auto` of it: `otherwise`, or the most
/// there may be where an error ends them.
pub fn sample_count(values: &Values, key: &str, otherwise: u32) -> u32 {
    let auto = if until_error(values).is_some() { MOST_SAMPLES } else { otherwise };
    values.unless_auto(key, Values::integer).map_or(auto, |count| count as u32)
}
