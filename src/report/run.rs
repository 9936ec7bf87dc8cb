//! The report of one run: the request, the device, the result, and the cost of each pass and each byte. Keys:
//! docs/report.md; within a schema number a key is only ever added.

use super::errors::Errors;
use super::memory::MemoryReport;
use super::memory::touched::{TouchedReport, TouchedRow};
use super::nullable::present;
use super::roofline::{Least, Roofline};
use super::spread::Spread;
use crate::caps::Identity;
use crate::error::Result;
use crate::frame::View;
use crate::gpu::Gpu;
use crate::gpu::commands::RecordedPass;
use crate::gpu::recorded::FrameTime;
use crate::gpu::timing::Clock;
use crate::lights::LightSet;
use crate::picture::{Aov, AovChannels, Picture};
use crate::scene::Scene;
use crate::settings::written::WrittenSettings;
use crate::units::Extent;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

/// Names of texts in the header of a picture.
pub mod header {
    pub const VERSION: &str = "quincunx.version";
    pub const TECHNIQUE: &str = "quincunx.technique";
    pub const ESTIMATOR: &str = "quincunx.estimator";
    pub const SCENE: &str = "quincunx.scene";
    pub const SCENE_HASH: &str = "quincunx.scene_hash";
    pub const SETTINGS: &str = "quincunx.settings";
    pub const SAMPLES: &str = "quincunx.samples";
}

/// Number of the set of keys.
pub const SCHEMA: u32 = 1;
/// A pass whose timestamp is farther from its wall time than this part of it is reported.
const DISAGREEMENT: f64 = 0.1;
/// Shorter passes are not judged: the submit itself takes tens of microseconds.
const JUDGED_FROM_MS: f64 = 1.0;

/// The report of a picture; its fields are the keys of the JSON document, in their order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct RunReport {
    /// `SCHEMA` of the program that wrote it.
    pub schema: u32,
    pub quincunx: Program,
    /// The command that repeats the run, a word an entry; empty where none was typed.
    pub command: Vec<String>,
    /// Files of presets that settings were read from, the user's defaults among them; not there where there are none.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub presets: Vec<String>,
    pub device: DeviceRow,
    /// The technique's name.
    pub technique: String,
    /// `Technique::estimator_version`.
    pub estimator: u32,
    pub scene: SceneRow,
    /// Every setting as it was used: what `auto` and percentages came to.
    pub settings: WrittenSettings,
    /// The stages that were asked for.
    pub aovs: Vec<AovRow>,
    #[serde(flatten)]
    pub times: Times,
    pub memory: MemoryReport,
    /// Numbers of the last run of what was recorded; each technique has its own.
    pub counters: BTreeMap<String, f64>,
    pub image: ImageRow,
    /// What a person should know of the picture, as sentences; not there where there is nothing.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub notes: Vec<String>,
    /// Errors against the reference; None where none was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub errors: Option<Errors>,
    /// Number of the frame; None outside of sequences.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frame: Option<u32>,
    /// Its moment, seconds; None outside of sequences.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub time_s: Option<f64>,
}

/// The program that made a picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Program {
    pub version: String,
    pub commit: String,
}

/// The device that made it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct DeviceRow {
    #[serde(flatten)]
    pub identity: Identity,
    /// Whether it keeps shaders within their buffers.
    pub robust_buffer_access: bool,
}

/// What was drawn.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SceneRow {
    /// Built-in name with parameters, or path.
    pub name: String,
    /// BLAKE3 of what is drawn, hexadecimal.
    pub hash: String,
    pub triangles: u64,
    pub draws: usize,
    /// Punctual lights.
    pub lights: usize,
    pub materials: usize,
    /// Name of the camera; `framing` where it was made.
    pub camera: String,
    /// `default` where the default rig is added; else None.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rig: Option<String>,
    /// What is left out of a file or approximated, as sentences; not there where there is nothing.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
}

/// A stage that was asked for.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct AovRow {
    pub name: String,
    /// `rgb float`, `float` or `uint`.
    pub format: String,
    /// `WIDTHxHEIGHT`, pixels.
    pub extent: String,
    /// BLAKE3 of its values, hexadecimal.
    pub hash: String,
}

/// The passes of a picture with their times.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Times {
    /// In the order in which they ran.
    pub passes: Vec<PassRow>,
    /// `wall` or `timestamps`: what `PassRow::ms` and `total_ms` are by.
    pub clock: String,
    /// Milliseconds of the frame; None, and null in JSON, where none was made.
    pub total_ms: Option<Spread>,
    /// Frames before the measured ones. 0: the time is of the first frame, shader compilation included.
    pub warmup_frames: u32,
    /// Passes whose two times differ by over 10 %, as sentences; not there where none does.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub timing_warnings: Vec<String>,
}

/// A pass.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct PassRow {
    /// `technique.pass`.
    pub name: String,
    /// `host, once`, `device, once` or, of the host's part of each frame, `host`; None of a pass of the device in each.
    #[serde(default, rename = "where", skip_serializing_if = "Option::is_none")]
    pub place: Option<String>,
    /// Bytes that it reads by its own reckoning, null where it cannot tell, or as it has counted them (`--touched`); None of what ran once.
    #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    pub bytes_read: Option<Option<u64>>,
    /// The same, written.
    #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    pub bytes_written: Option<Option<u64>>,
    /// The same: invocations of its compute shader, or of its fragment shaders, which only counting can tell.
    #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    pub invocations: Option<Option<u64>>,
    /// Milliseconds by the clock that `Times::clock` names; None of a pass that was not timed.
    #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    pub ms: Option<Option<Spread>>,
    /// Milliseconds between the device's timestamps, null where it has none; None of a pass that was not timed.
    #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    pub timestamp_ms: Option<Option<Spread>>,
    /// Milliseconds of the submit's wall time; None of a pass that was not timed.
    #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
    pub wall_ms: Option<Option<Spread>>,
    /// What the device counted, by Vulkan's names; None where it was not asked to.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub statistics: Option<BTreeMap<String, u64>>,
    /// The least time that it takes on the device; None where nobody said what the device can do, and of a pass that was not timed.
    #[serde(flatten)]
    pub least: Option<Least>,
}

/// The picture.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ImageRow {
    /// Pixels.
    pub width: u32,
    /// Pixels.
    pub height: u32,
    /// Mean radiance of red, green and blue.
    pub mean: [f64; 3],
    /// Hash of the linear pixels, hexadecimal.
    pub hash: String,
    /// File that it was written to.
    pub path: String,
    /// Stops at which it was written; None of an EXR.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub exposure_ev: Option<f64>,
}

/// The passes of a picture, in the order in which they ran.
pub struct Passes<'a> {
    /// On the host, before all frames: names and nanoseconds.
    pub host: &'a [(String, u64)],
    /// On the device, before all frames: names and nanoseconds.
    pub once: &'a [(String, u64)],
    pub each_frame: &'a [RecordedPass],
    /// Which of the two clocks is the figure.
    pub clock: Clock,
}

/// Whether a pass's two times, milliseconds, cannot both be right: a submit adds to the wall time what it takes.
fn disagrees(clock: Clock, wall: f64, stamp: f64) -> bool {
    let is_apart = match clock {
        Clock::Wall => (wall - stamp).abs() > DISAGREEMENT * wall,
        Clock::Timestamps => stamp > (1.0 + DISAGREEMENT) * wall,
    };
    wall.max(stamp) >= JUDGED_FROM_MS && is_apart
}

fn milliseconds(ns: u64) -> f64 {
    ns as f64 / 1e6
}

impl Program {
    /// The one that runs.
    pub fn this() -> Self {
        let (version, commit) = (env!("CARGO_PKG_VERSION"), env!("QUINCUNX_COMMIT"));
        Self { version: version.to_owned(), commit: commit.to_owned() }
    }
}

impl DeviceRow {
    pub fn of(gpu: &Gpu) -> Self {
        Self { identity: gpu.caps.identity.clone(), robust_buffer_access: gpu.is_robust }
    }
}

impl SceneRow {
    /// `scene` as `view` shows it, under `lights`.
    pub fn of(scene: &Scene, view: &View, lights: &LightSet) -> Self {
        let mut warnings = scene.warnings.clone();
        if let Some(part) = lights.faint_part {
            warnings.push(format!(
                "its emissive surfaces make {:.0} % of it visible, less than half: the default rig is added; --rig \
                 none leaves the rig out",
                100.0 * part
            ));
        }
        // Some glow counts as light: who sees a dark picture should know why.
        if lights.is_emissive_alone {
            warnings.push("only its emissive surfaces light it; --rig always adds the default rig".to_owned());
        }
        Self {
            name: scene.name.clone(),
            hash: scene.hash.clone(),
            triangles: scene.triangle_count(),
            draws: scene.draws.len(),
            lights: lights.lights.len(),
            materials: scene.materials.len(),
            camera: if view.made_up { "framing".to_owned() } else { view.camera.name.clone() },
            rig: lights.has_rig.then(|| "default".to_owned()),
            warnings,
        }
    }
}

impl ImageRow {
    /// `exposure_ev`: of a PNG, at how many stops it was written.
    ///
    /// Errors: the picture holds NaN or infinity (exit code 1).
    pub fn of(picture: &Picture, path: &Path, exposure_ev: Option<f64>) -> Result<Self> {
        let (hash, mean, path) = (picture.hash()?, picture.mean(), path.display().to_string());
        let Extent { width, height } = picture.extent;
        Ok(Self { width, height, mean, hash, path, exposure_ev })
    }
}

impl AovRow {
    pub fn of(aov: &Aov, extent: Extent) -> Self {
        let mut hasher = blake3::Hasher::new();
        let format = match &aov.channels {
            AovChannels::Rgb(values) => {
                hasher.update(bytemuck::cast_slice(values));
                "rgb float"
            }
            AovChannels::Y(values) => {
                hasher.update(bytemuck::cast_slice(values));
                "float"
            }
            AovChannels::YU32(values) => {
                hasher.update(bytemuck::cast_slice(values));
                "uint"
            }
        };
        let hash = hasher.finalize().to_hex().to_string();
        Self { name: aov.name.clone(), format: format.to_owned(), extent: extent.to_string(), hash }
    }
}

impl PassRow {
    fn once((name, ns): &(String, u64), place: &str) -> Self {
        let ms = Some(Spread::of(&[milliseconds(*ns)]));
        Self { name: name.clone(), place: Some(place.to_owned()), ms, ..Self::default() }
    }

    /// Median milliseconds; None where it was not timed.
    pub fn median_ms(&self) -> Option<f64> {
        Some(self.ms.as_ref()?.as_ref()?.median)
    }

    /// The least time that it takes under `roofline`; None of what was not timed, and where nothing is known of its work.
    pub fn least_under(&self, roofline: &Roofline) -> Option<Least> {
        let ms = self.median_ms().filter(|ms| *ms > 0.0)?;
        roofline.least([self.bytes_read?, self.bytes_written?], self.statistics.as_ref(), ms)
    }
}

impl Times {
    /// A row for each pass, with its times where frames were submitted pass by pass (`profile`) and what the device
    /// counted where it was asked to; and the frame's time.
    pub fn of(passes: &Passes<'_>, frames: &[FrameTime], profile: bool) -> Self {
        let mut rows: Vec<PassRow> = passes.host.iter().map(|pass| PassRow::once(pass, "host, once")).collect();
        rows.extend(passes.once.iter().map(|pass| PassRow::once(pass, "device, once")));
        // Each frame has the same.
        for (index, (name, _)) in frames.first().map_or(&[][..], |frame| &frame.host).iter().enumerate() {
            let ms: Vec<f64> = frames.iter().map(|frame| milliseconds(frame.host[index].1)).collect();
            let (name, place, ms) = (name.clone(), Some("host".to_owned()), Some(Spread::of(&ms)));
            rows.push(PassRow { name, place, ms, ..PassRow::default() });
        }
        let clock = passes.clock;
        let mut timing_warnings = Vec::new();
        for (index, pass) in passes.each_frame.iter().enumerate() {
            let walls: Vec<f64> =
                frames.iter().filter_map(|frame| frame.passes[index].wall_ns).map(milliseconds).collect();
            let stamps: Vec<f64> =
                frames.iter().filter_map(|frame| frame.passes[index].timestamp_ns).map(milliseconds).collect();
            if walls.iter().zip(&stamps).any(|(wall, stamp)| disagrees(clock, *wall, *stamp)) {
                timing_warnings.push(format!("{}: timestamp and wall time differ by over 10 %", pass.name));
            }
            let mut row = PassRow {
                name: pass.name.clone(),
                bytes_read: Some(pass.traffic.read_bytes),
                bytes_written: Some(pass.traffic.written_bytes),
                invocations: Some(pass.traffic.invocations),
                ..PassRow::default()
            };
            if profile {
                let figures = frames.iter().filter_map(|frame| frame.passes[index].figure_ns(clock));
                row.ms = Some(Spread::of(&figures.map(milliseconds).collect::<Vec<f64>>()));
                row.timestamp_ms = Some(Spread::of(&stamps));
                row.wall_ms = Some(Spread::of(&walls));
            }
            // Statistics are those of the last frame, as counters are.
            let counts = frames.last().and_then(|frame| frame.statistics.get(index));
            row.statistics =
                counts.map(|counts| counts.iter().map(|(stage, count)| ((*stage).to_owned(), *count)).collect());
            rows.push(row);
        }
        let totals: Vec<f64> = frames.iter().map(|frame| milliseconds(frame.figure_ns(clock))).collect();
        Self {
            passes: rows,
            clock: clock.name().to_owned(),
            total_ms: Spread::of(&totals),
            // Without --profile the one frame also pays for what drivers compile at first use.
            warmup_frames: u32::from(profile),
            timing_warnings,
        }
    }

    /// The same with the bytes that passes asked for where a frame has counted them, in place of their own reckoning.
    pub fn counted(mut self, touched: Option<&TouchedReport>) -> Self {
        for pass in touched.into_iter().flat_map(|touched| &touched.passes) {
            let sum = |bytes: fn(&TouchedRow) -> u64| Some(Some(pass.resources.iter().map(bytes).sum()));
            for row in self.passes.iter_mut().filter(|row| row.name == pass.pass && row.place.is_none()) {
                row.bytes_read = sum(|row| row.asked_read_bytes);
                row.bytes_written = sum(|row| row.asked_written_bytes);
                row.invocations = Some(Some(pass.invocations));
            }
        }
        self
    }

    /// The same with the least time that each pass takes, where the device's roofline is known.
    pub fn under(mut self, roofline: Option<&Roofline>) -> Self {
        if let Some(roofline) = roofline {
            self.passes.iter_mut().for_each(|pass| pass.least = pass.least_under(roofline));
        }
        self
    }
}

impl RunReport {
    /// The whole document.
    pub fn json(&self) -> Value {
        serde_json::to_value(self).expect("its keys are texts")
    }

    /// What the header of a picture carries.
    pub fn attributes(&self) -> Vec<(String, String)> {
        let settings = serde_json::to_string(&self.settings).expect("its keys are texts");
        let mut attributes = [
            (header::VERSION, self.quincunx.version.clone()),
            (header::TECHNIQUE, self.technique.clone()),
            (header::ESTIMATOR, self.estimator.to_string()),
            (header::SCENE, self.scene.name.clone()),
            (header::SCENE_HASH, self.scene.hash.clone()),
            (header::SETTINGS, settings),
        ]
        .map(|(name, text)| (name.to_owned(), text))
        .to_vec();
        let samples = self.counters.get("samples").map(|count| (*count as u64).to_string());
        attributes.extend(samples.map(|samples| (header::SAMPLES.to_owned(), samples)));
        attributes
    }
}
