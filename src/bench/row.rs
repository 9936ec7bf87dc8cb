//! A row: one variant's settings, times, bytes and errors, as a JSON document of one line.
//!
//! Rows of earlier versions lack keys that were added since: what is not there is None, or empty. Keys that this
//! version does not know are kept as they are.

use super::machine::Load;
use super::stats::Ratio;
use super::sweep::Axis;
use super::units::UnitTimes;
use crate::caps::Identity;
use crate::metrics::Metrics;
use crate::report::errors::{Errors, ReferenceIdentity};
use crate::report::memory::MemorySums;
use crate::report::nullable::present;
use crate::report::spread::Spread;
use crate::sequence::Frames;
use crate::settings::written::WrittenSettings;
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;

/// Its fields are the keys of the JSON document, in their order.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct BenchRow {
    /// Number of the set of keys.
    pub schema: u32,
    /// The word after `bench`.
    pub bench: String,
    /// What the row sets, in words.
    pub variant: String,
    /// What its point beside the grid was called; None where it was not.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    pub device: Option<Identity>,
    /// Commit of the program.
    pub commit: String,
    pub scene: SceneName,
    /// The technique's name.
    pub technique: String,
    /// Settings as they were typed, those at their defaults left out; None in rows of before it was written.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub asked: Option<WrittenSettings>,
    /// Every setting as it was used; as it was typed where the row was not measured.
    pub settings: WrittenSettings,
    /// Rounds, at least.
    pub repeat: usize,
    /// Widest interval of a ratio, in parts of it, for which more rounds were measured; None: no more.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub until_interval: Option<f64>,
    /// The variant that ratios are to.
    pub baseline: String,
    /// True with `--fair`; else None.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fair: Option<bool>,
    /// What `errors` are against; None without `--reference`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reference: Option<ReferenceIdentity>,
    /// Frames that were measured; None without `--frames`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frames: Option<Frames>,
    /// Axes of the sweep that the row does not read; None where it reads them all.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unread_axes: Option<Vec<String>>,
    /// The command that repeats it, a word an entry; None, as all that follows, of a row that was not measured.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub command: Option<Vec<String>>,
    /// Shared by rows that were measured in the same rounds, and by no others.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub group: Option<String>,
    /// What else the machine did; null where nobody tells.
    #[serde(deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    pub machine: Option<Option<Load>>,
    /// `wall` or `timestamps`: what times are by.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub clock: Option<String>,
    /// Hash of its picture, hexadecimal.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub image_hash: Option<String>,
    /// Milliseconds of whole frames; None where a stage was timed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frame_ms: Option<Spread>,
    /// What a frame's time is made of; None without `--frames`, as the keys to `flicker_error`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub frame_parts_ms: Option<FrameParts>,
    /// Milliseconds a frame of compiling and allocating, which are no part of the time.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub setup_ms: Option<f64>,
    /// Frames for which the tree was built, of a sequence.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trees_built: Option<u32>,
    /// Frames for which it was refitted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trees_refitted: Option<u32>,
    /// `metrics::FlickerMeter`; None of fewer than three frames.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flicker: Option<f64>,
    /// `metrics::ErrorFlickerMeter`; None without references.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub flicker_error: Option<f64>,
    /// Milliseconds of the stage's passes; None where frames were timed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub stage_ms: Option<Spread>,
    /// Median milliseconds of each timed pass, by its full name; null where no memory was left to time them.
    #[serde(deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    pub pass_ms: Option<Option<IndexMap<String, f64>>>,
    /// Time of the baseline in parts of the row's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_up: Option<SpeedUp>,
    /// Time in parts of the baseline's.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ratio: Option<Ratio>,
    /// Bytes that the timed passes read.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bytes_read: Option<u64>,
    /// Bytes that the timed passes write.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub bytes_written: Option<u64>,
    /// Bytes that the technique asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub planned_bytes: Option<u64>,
    /// As the report of its command has them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub memory: Option<MemorySums>,
    /// As the report of its command has them.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub counters: Option<BTreeMap<String, f64>>,
    /// A copy beside the same kernel moving each texel to its own place; None of other stages.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub identity: Option<Beside>,
    /// A copy beside vkCmdCopyBuffer of as many bytes; None of other stages.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub copy: Option<Beside>,
    /// Bytes that a copy leaves; None of other stages.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub copied_bytes: Option<u64>,
    /// Those, 10^9 a second.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub copied_gb_per_s: Option<f64>,
    #[serde(flatten)]
    pub unit_times: UnitTimes,
    /// Errors against the technique's plain form; None where it has none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub error_against_none: Option<Metrics>,
    /// Nanoseconds of one light at one pixel in the plain form; None of stages.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub evaluation_ns: Option<f64>,
    /// Milliseconds of the passes that the plain form does not have; None of stages.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub overhead_ms: Option<f64>,
    /// Milliseconds of a pass of one light, null where no memory was left to time it; None of stages.
    #[serde(deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    pub light_pass_ms: Option<Option<f64>>,
    /// `overhead_ms` in such passes, null as `light_pass_ms`; None of stages.
    #[serde(deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    pub overhead_light_passes: Option<Option<f64>>,
    /// `overhead_ms` in evaluations of a light for each pixel; None of stages.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub overhead_evaluations_per_pixel: Option<f64>,
    /// Why there is no plain form to compare with; None where there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reference_skipped: Option<String>,
    /// Errors against `reference`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub errors: Option<Errors>,
    /// Why there are none although a reference was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub errors_skipped: Option<String>,
    /// Why it was not measured; None where it was.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub skipped: Option<String>,
    /// True for rows of the Pareto set, in a summary; else None.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pareto: Option<bool>,
    /// Variants with a shorter time that the intervals do not tell it from, in a summary; None where there are none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pareto_not_told_from: Option<Vec<String>>,
    /// Keys that this version does not know.
    #[serde(flatten)]
    pub other: Map<String, Value>,
}

/// Median milliseconds a frame of the parts of its time, mean over the frames.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FrameParts {
    /// Making the scene of the frame's moment.
    pub pose: f64,
    /// Copying it to the device.
    pub upload: f64,
    /// Building or refitting the tree that rays walk.
    pub tree: f64,
    /// Host passes.
    pub host: f64,
    /// The device's passes.
    pub device: f64,
}

/// Which scene.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct SceneName {
    /// Built-in name with parameters, or path.
    #[serde(default)]
    pub name: String,
    /// BLAKE3 of what is drawn, hexadecimal.
    pub hash: String,
}

/// A ratio, and the variant that it is to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SpeedUp {
    #[serde(flatten)]
    pub ratio: Ratio,
    pub baseline: String,
}

/// A copy's time in parts of another's, or why there is no other.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Beside {
    Measured {
        #[serde(flatten)]
        ratio: Ratio,
        /// Milliseconds of the other.
        ms: Spread,
    },
    Skipped {
        skipped: String,
    },
}

impl Beside {
    /// None where there is no other.
    pub fn ratio(&self) -> Option<&Ratio> {
        match self {
            Self::Measured { ratio, .. } => Some(ratio),
            Self::Skipped { .. } => None,
        }
    }
}

impl BenchRow {
    /// What says that two rows are of the same measurement. A name does not: what is called otherwise is not measured again.
    pub fn key(&self) -> String {
        json!([
            self.bench,
            self.technique,
            self.device,
            self.commit,
            self.repeat,
            self.until_interval,
            self.baseline,
            self.variant,
            self.reference,
            self.fair,
            self.frames,
            self.scene.hash,
            self.asked(),
        ])
        .to_string()
    }

    /// What tables call it: its name, or what it sets.
    pub fn title(&self) -> &str {
        self.name.as_deref().unwrap_or(&self.variant)
    }

    /// Settings as they were typed: what a row's are by name. Rows of earlier versions have these as their settings.
    pub fn asked(&self) -> &WrittenSettings {
        self.asked.as_ref().unwrap_or(&self.settings)
    }

    /// The text of a setting as it was typed; empty where it was not.
    pub fn asked_text(&self, key: &str) -> String {
        self.asked().get(key).map(ToString::to_string).unwrap_or_default()
    }

    /// Its values of all axes but `keys`, `axis=value axis=value`; empty where there is no other axis.
    pub fn others(&self, keys: &[&str], axes: &[Axis]) -> String {
        let others = axes.iter().filter(|axis| !keys.contains(&axis.key.as_str()));
        others.map(|axis| format!("{}={}", axis.key, self.asked_text(&axis.key))).collect::<Vec<_>>().join(" ")
    }

    /// Times of the frame, or of the stage; None where it was not measured.
    pub fn times_ms(&self) -> Option<&Spread> {
        self.frame_ms.as_ref().or(self.stage_ms.as_ref())
    }

    /// The errors against the reference that was asked for, else against the plain form.
    pub fn best_known_errors(&self) -> Option<&Metrics> {
        self.errors.as_ref().map(|errors| &errors.metrics).or(self.error_against_none.as_ref())
    }

    /// Ends of the interval of its time ratio; None where there is none.
    pub fn interval(&self) -> Option<[f64; 2]> {
        self.ratio.as_ref()?.interval.filter(|ends| ends.iter().all(|end| end.is_finite()))
    }

    pub fn was_measured(&self) -> bool {
        self.skipped.is_none()
    }

    /// Whether the machine was busy meanwhile; rows of which nothing is known were measured on a quiet one.
    pub fn is_busy(&self) -> bool {
        self.machine.flatten().is_some_and(|load| load.busy)
    }

    /// As rows are written: one line, without its end.
    pub fn line(&self) -> String {
        serde_json::to_string(self).expect("its keys are texts")
    }
}
