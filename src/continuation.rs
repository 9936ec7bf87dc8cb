//! A picture that a run continues: its sums and the number of their samples, from the EXR of an earlier run.
//!
//! Nothing in it is believed: the header must be that of the same picture, size, scene, settings and estimator, and the sums
//! must be those that its pixels are the means of. Then sampling continues as if it had never stopped, to the same
//! bits.

use crate::error::{Error, Result};
use crate::metrics::noise;
use crate::picture::image_file::Texts;
use crate::picture::{Aov, AovChannels, image_file};
use crate::reference::recipe::goes_along;
use crate::report::run::header::{ESTIMATOR, SAMPLES, SCENE_HASH, SETTINGS, TECHNIQUE, VERSION};
use crate::scene::Scene;
use crate::session::Renderer;
use crate::settings::Values;
use crate::settings::written::{SettingValue, WrittenSettings, written};
use crate::techniques::until_error::MOST_SAMPLES;
use crate::techniques::{Technique, settings_of};
use crate::units::Extent;
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

/// Layers that the sums are kept in.
const SUMS: &str = "sums";
const SQUARES: &str = "sums.squares";
/// The channels of picture and sums, in the order of a pixel.
const CHANNELS: [&str; 7] = ["R", "G", "B", "sums.R", "sums.G", "sums.B", "sums.squares.Y"];

/// Samples a pixel that a file may have.
const COUNTS: RangeInclusive<u64> = 1..=MOST_SAMPLES as u64;
/// How far a pixel may be from its sum over its count, as a part of it: devices divide to some units in the last place.
const ROUNDING: f32 = 1e-5;
/// Letters of a broken text that an error repeats.
const QUOTED: usize = 64;

/// An earlier picture as a file has it.
#[derive(Clone, Debug)]
pub struct Continuation {
    path: PathBuf,
    texts: Texts,
    /// Row-major: red, green, blue, and the squared lengths.
    sums: Vec<[f32; 4]>,
    /// Samples a pixel, in `COUNTS`.
    sample_count: u32,
}

/// The layers that keep `sums` in an EXR of 32-bit floats, to the bit.
pub fn layers(sums: &[[f32; 4]]) -> [Aov; 2] {
    let colors = sums.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect();
    let squares = sums.iter().map(|sum| sum[3]).collect();
    [
        Aov { name: SUMS.to_owned(), channels: AovChannels::Rgb(colors) },
        Aov { name: SQUARES.to_owned(), channels: AovChannels::Y(squares) },
    ]
}

impl Continuation {
    /// Reads a picture of `extent`.
    ///
    /// Errors, all of them with exit code 2: no EXR or a broken one, another size, no sums or no count in it, a count out of
    /// range, numbers that are no sums of that many samples.
    pub fn read(path: &Path, extent: Extent) -> Result<Self> {
        let (pixels, texts) = image_file::read_exr_channels(path, extent, CHANNELS).map_err(|error| {
            error.within("--continue").note("`render --technique path_traced -o FILE.exr` writes what it reads")
        })?;
        let unsummed = Self { path: path.to_owned(), texts, sums: Vec::new(), sample_count: 0 };
        let samples = unsummed.text(SAMPLES)?;
        let Some(count) = samples.parse().ok().filter(|count| COUNTS.contains(count)) else {
            let (least, most) = (COUNTS.start(), COUNTS.end());
            return Err(unsummed.refused(&format!("{SAMPLES} is {}; it must be {least} to {most}", quoted(samples))));
        };
        if let Some(index) = pixels.iter().position(|pixel| !is_mean(pixel, count as f32)) {
            let (x, y) = (index as u32 % extent.width, index as u32 / extent.width);
            return Err(unsummed.refused(&format!(
                "pixel ({x}, {y}) is {:?}, which {count} samples with the sums {:?} cannot give",
                &pixels[index][..3],
                &pixels[index][3..]
            )));
        }
        let sums = pixels.iter().map(|pixel| [pixel[3], pixel[4], pixel[5], pixel[6]]).collect();
        Ok(Self { sums, sample_count: count as u32, ..unsummed })
    }

    /// `values`: the settings of the run that continues.
    ///
    /// Errors: it is a picture of another technique, of another version of it, of another seed or scene (exit code 2).
    pub fn require(&self, technique: &dyn Technique, values: &Values, scene: &Scene) -> Result<()> {
        self.require_text(TECHNIQUE, technique.name())?;
        self.require_text(VERSION, env!("CARGO_PKG_VERSION"))?;
        self.require_text(ESTIMATOR, &technique.estimator_version().to_string())?;
        // Built-in scenes depend on it: it says more than their hash.
        self.require_setting(&self.settings()?, &written(values, &BTreeMap::new()), "seed")?;
        self.require_text(SCENE_HASH, &scene.hash)
    }

    /// Lets `renderer` begin with it. `settings`: as a report has them, with what `auto` came to.
    ///
    /// Errors, all of them with exit code 2: one of `settings` that shows in a picture was another; nothing is left to do,
    /// because it has as many samples, or as small an error, as are asked for.
    pub fn begin(&self, renderer: &mut Renderer, technique: &dyn Technique, settings: &WrittenSettings) -> Result<()> {
        self.require_settings(technique, settings)?;
        let count = self.sample_count;
        let most = settings.get("until-error").and_then(SettingValue::as_f64);
        let most = most.filter(|most| *most > 0.0 && count > 1);
        let error = most.map(|_| noise::relative_error(&self.sums, count.into()));
        if let (Some(most), Some(error)) = (most, error.filter(|error| Some(*error) <= most)) {
            return Err(self.refused(&format!(
                "its estimated error is {error:.5} after {count} samples a pixel: --until-error {most} is reached"
            )));
        }
        renderer.begin_with(self.sums.clone(), count).map_err(|error| self.within(error))
    }

    fn require_settings(&self, technique: &dyn Technique, ours: &WrittenSettings) -> Result<()> {
        let (theirs, known) = (self.settings()?, settings_of(technique));
        let keys = theirs.keys().map(String::as_str).chain(ours.keys().map(String::as_str));
        let row = |key: &str| known.iter().find(|setting| setting.key == key);
        let mut shown = keys.filter(|key| row(key).is_none_or(goes_along));
        shown.try_for_each(|key| self.require_setting(&theirs, ours, key))
    }

    fn require_setting(&self, theirs: &Map<String, Value>, ours: &WrittenSettings, key: &str) -> Result<()> {
        let shown = |value: Option<&Value>| match value {
            None => "not there".to_owned(),
            Some(value) => quoted(&value.as_str().map_or_else(|| value.to_string(), str::to_owned)),
        };
        let (its, this) = (theirs.get(key), ours.get(key).map(|value| json!(value)));
        if its == this.as_ref() {
            return Ok(());
        }
        let (key, its, this) = (quoted(key), shown(its), shown(this.as_ref()));
        Err(self.refused(&format!("its setting {key} is {its}, and here it is {this}")))
    }

    /// An object, by the keys of the settings.
    fn settings(&self) -> Result<Map<String, Value>> {
        let text = self.text(SETTINGS)?;
        let settings = serde_json::from_str(text).ok();
        settings.ok_or_else(|| self.refused(&format!("{SETTINGS} is not a JSON object: {}", quoted(text))))
    }

    fn require_text(&self, name: &str, ours: &str) -> Result<()> {
        let theirs = self.text(name)?;
        if theirs == ours {
            return Ok(());
        }
        Err(self.refused(&format!("its {name} is {}, and here it is {}", quoted(theirs), quoted(ours))))
    }

    fn text(&self, name: &str) -> Result<&str> {
        let text = self.texts.get(name).map(String::as_str);
        text.ok_or_else(|| {
            self.refused(&format!("there is no {name} in its header; a picture that can be continued has it"))
        })
    }

    fn refused(&self, why: &str) -> Error {
        self.within(Error::request(why))
    }

    fn within(&self, error: Error) -> Error {
        error.within(format!("--continue {}", self.path.display()))
    }
}

/// Whether the first three numbers are the means of `count` samples that the next three are the sums of, and the last can
/// be the sum of their squares.
fn is_mean(pixel: &[f32; 7], count: f32) -> bool {
    let close = |mean: f32, sum: f32| (sum / count - mean).abs() <= ROUNDING * mean.abs() + f32::MIN_POSITIVE;
    let are_means = (0..3).all(|channel| pixel[channel] >= 0.0 && close(pixel[channel], pixel[channel + 3]));
    are_means && pixel.iter().all(|number| number.is_finite()) && pixel[6] >= 0.0
}

/// A text of a file, in quotes, its start where it is long.
fn quoted(text: &str) -> String {
    let start: String = text.chars().take(QUOTED).collect();
    if start.len() < text.len() { format!("{start:?}...") } else { format!("{start:?}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mean_is_held_against_its_sum() {
        let fine = [0.5, 0.25, 0.0, 8.0, 4.0, 0.0, 9.0];
        assert!(is_mean(&fine, 16.0));
        assert!(!is_mean(&fine, 17.0), "another count");
        for (place, wrong) in [(0, f32::NAN), (1, -0.25), (3, f32::INFINITY), (5, 0.1), (6, f32::NAN), (6, -1.0)] {
            let mut broken = fine;
            broken[place] = wrong;
            assert!(!is_mean(&broken, 16.0), "{place}: {wrong}");
        }
        assert_eq!(quoted(&"x".repeat(70)), format!("\"{}\"...", "x".repeat(64)));
    }
}
