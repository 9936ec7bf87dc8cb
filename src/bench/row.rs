//! A row: one variant's settings, times, bytes and error, as a JSON document of one line.

use super::candidate::Candidate;
use super::group::{BASELINE, Companion, Ground, Member};
use super::machine::Load;
use super::reference::{Found, Reference, pass_ms};
use super::rounds::Samples;
use super::stats::{median, paired_ratio};
use super::what::What;
use crate::choice::Choice;
use crate::error::{Error, Result};
use crate::job::{Job, settings};
use crate::metrics;
use crate::passes::filter::Filter;
use crate::picture::Picture;
use crate::reference::Asked;
use crate::report::spread::Spread;
use crate::settings::Values;
use crate::settings::written::SettingValue;
use crate::techniques::Technique;
use serde_json::{Map, Value, json};

/// What every row of a run shares.
pub struct Head<'a> {
    pub ground: Ground<'a>,
    pub repeat: usize,
    /// The baseline's label.
    pub baseline: String,
}

/// The rounds in which a row was measured.
pub struct Rounds {
    /// Shared by the rows of a group, and by no others.
    pub group: String,
    /// Times of every probe of the group.
    pub samples: Vec<Samples>,
    /// What else the machine did meanwhile; None where the system does not report it.
    pub load: Option<Load>,
}

impl Head<'_> {
    /// The keys that say what a row is of; `key` reads these. Settings are as they were typed: their resolved values
    /// are known when they are made.
    pub fn row(&self, candidate: &Candidate) -> Value {
        let Ground { job, session, what, is_fair } = &self.ground;
        let settings: Map<String, Value> =
            candidate.settings.iter().map(|(key, text)| (key.clone(), json!(SettingValue::of(text)))).collect();
        let mut row = json!({
            "schema": 1,
            "bench": what.name(),
            "variant": candidate.label,
            "device": session.gpu.caps.identity,
            "commit": env!("QUINCUNX_COMMIT"),
            "scene": { "name": session.scene.name, "hash": session.scene.hash },
            "technique": candidate.job.technique.name(),
            "asked": candidate.asked,
            "settings": settings,
            "repeat": self.repeat,
            "baseline": self.baseline,
        });
        if *is_fair {
            row["fair"] = json!(true);
        }
        if let Some(asked) = &job.reference {
            row["reference"] = json!(asked.identity());
        }
        row
    }

    /// The row of a variant that cannot be, and why.
    pub fn skipped(&self, candidate: &Candidate, error: &Error) -> Value {
        let mut row = self.row(candidate);
        row["skipped"] = json!(error.message());
        row
    }

    /// The row of a variant that was measured, in `rounds`.
    ///
    /// Errors: the picture holds NaN or infinity (exit code 1); the device fails (4).
    pub fn measured(
        &self,
        candidate: &Candidate,
        member: &Member,
        picture: &Picture,
        rounds: &Rounds,
        reference: &Found,
    ) -> Result<Value> {
        let Ground { job, session, what, .. } = &self.ground;
        let renderer = &member.variant.renderer;
        let samples = &rounds.samples;
        let values = candidate.values.as_ref().map_err(Error::clone)?;
        let times = samples[member.probe].totals_ms();
        let baseline = samples[BASELINE].totals_ms();
        let [read, written] = member.variant.traffic_bytes();
        let mut row = self.row(candidate);
        row["settings"] = json!(settings(session, renderer, values));
        if !candidate.unread_axes.is_empty() {
            row["unread_axes"] = json!(candidate.unread_axes);
        }
        row["command"] = json!(repeating_command(job, *what, candidate.job.technique, values));
        row["group"] = json!(rounds.group);
        row["machine"] = json!(rounds.load.map(Load::json));
        row["clock"] = json!(renderer.clock().name());
        row["image_hash"] = json!(picture.hash()?);
        row[what.time_key()] = json!(Spread::of(&times));
        row["pass_ms"] = self.pass_ms(candidate, member, samples)?;
        row["speed_up"] = paired_ratio(&baseline, &times).json();
        row["speed_up"]["baseline"] = json!(self.baseline);
        row["ratio"] = paired_ratio(&times, &baseline).json();
        row["bytes_read"] = json!(read);
        row["bytes_written"] = json!(written);
        row["planned_bytes"] = json!(renderer.plan.bytes());
        row["memory"] = json!(session.memory_table(renderer, None)?.touched_as(&renderer.touched_bytes()?).sums());
        row["counters"] = json!(renderer.measured_counters()?);
        match what {
            What::Split | What::Gather => copies(&mut row, member, samples),
            What::Shade => evaluations(&mut row, member, &times),
            What::Filter => taps(&mut row, member, &times),
            What::Frame => {}
        }
        match reference {
            Ok(reference) => {
                let comparison = metrics::compare(picture, &reference.picture, metrics::DEFAULT_THRESHOLD)?;
                row["error_against_none"] = json!(comparison.metrics);
                overhead(&mut row, picture, reference);
            }
            Err(error) => row["reference_skipped"] = json!(error.message()),
        }
        Ok(row)
    }

    /// Median milliseconds of each timed pass. A frame is one submit: its passes are timed in frames of their own.
    fn pass_ms(&self, candidate: &Candidate, member: &Member, samples: &[Samples]) -> Result<Value> {
        let Ground { session, what, .. } = &self.ground;
        let passes: Vec<(String, f64)> = if *what == What::Frame {
            let values = candidate.values.as_ref().map_err(Error::clone)?;
            match pass_ms(&candidate.job, session, values)? {
                Some(passes) => passes,
                None => return Ok(Value::Null),
            }
        } else {
            let names = member.variant.stage.iter().map(|index| member.variant.renderer.passes()[*index].name.clone());
            names.zip(samples[member.probe].part_medians_ms()).collect()
        };
        Ok(Value::Object(passes.into_iter().map(|(name, ms)| (name, json!(ms))).collect::<Map<_, _>>()))
    }
}

/// What says that two rows are of the same measurement.
pub fn key(row: &Value) -> String {
    let parts = ["bench", "technique", "device", "commit", "repeat", "baseline", "variant", "reference", "fair"];
    let mut key: Vec<&Value> = parts.iter().map(|part| &row[*part]).collect();
    key.extend([&row["scene"]["hash"], asked(row)]);
    json!(key).to_string()
}

/// Settings as they were typed: what a row's are by name. Rows of earlier versions have these as their settings.
pub fn asked(row: &Value) -> &Value {
    if row["asked"].is_object() { &row["asked"] } else { &row["settings"] }
}

/// The `render` command of a variant: every setting that is not at its default; pass times where a stage is timed.
fn repeating_command(job: &Job, what: What, technique: &'static dyn Technique, values: &Values) -> Vec<String> {
    let defaults = Job::new(&job.scene, technique).values;
    let mut command = ["quincunx", "render", &job.scene, "--technique", technique.name()].map(str::to_owned).to_vec();
    for (key, default) in defaults.iter() {
        if values.text(key) != default {
            command.extend([format!("--{key}"), values.text(key).to_owned()]);
        }
    }
    command.extend(job.reference.iter().flat_map(Asked::arguments));
    if what != What::Frame {
        command.push("--profile".to_owned());
    }
    command
}

/// A copy beside the identity shader and beside vkCmdCopyBuffer.
fn copies(row: &mut Value, member: &Member, samples: &[Samples]) {
    let times = samples[member.probe].totals_ms();
    let against = |companion: &Companion| match companion {
        Ok(probe) => {
            let theirs = samples[*probe].totals_ms();
            let mut entry = paired_ratio(&times, &theirs).json();
            entry["ms"] = json!(Spread::of(&theirs));
            entry
        }
        Err(error) => json!({ "skipped": error.message() }),
    };
    if let Some(identity) = &member.identity {
        row["identity"] = against(identity);
    }
    if let Some(copy) = &member.copy {
        row["copy"] = against(copy);
        let bytes = member.variant.result_bytes();
        row["copied_bytes"] = json!(bytes);
        // Bytes over milliseconds are kilobytes a second.
        row["copied_gb_per_s"] = json!(bytes as f64 / median(&times) / 1e6);
    }
}

/// Nanoseconds for each light of a pixel's subset at each pixel that is shaded.
fn evaluations(row: &mut Value, member: &Member, times: &[f64]) {
    let renderer = &member.variant.renderer;
    let Some(lights) = renderer.counters.get("subset_lights_per_pixel") else { return };
    // `--split subsample` shades one pixel of each pattern.
    let shaded = renderer.counters.get("shaded_pixels").copied().unwrap_or(0.0);
    row["ns_per_evaluation"] = json!(1e6 * median(times) / (shaded * lights).max(1.0));
}

/// Nanoseconds a pixel, discontinuities included, and of those for each tap of both directions.
fn taps(row: &mut Value, member: &Member, times: &[f64]) {
    let pixel_ns = 1e6 * median(times) / member.variant.extent().pixel_count() as f64;
    row["ns_per_pixel"] = json!(pixel_ns);
    let filter = row["settings"]["filter"].as_str().and_then(Filter::from_word).unwrap_or(Filter::None);
    if let Some(taps) = row["settings"]["kernel"].as_f64().and_then(|kernel| filter.taps(kernel)) {
        row["ns_per_tap"] = json!(pixel_ns / taps);
    }
}

/// What a frame has beside plain deferred shading, in evaluations of one light at each pixel.
fn overhead(row: &mut Value, picture: &Picture, reference: &Reference) {
    let (Some(cost), Some(passes)) = (&reference.cost, row["pass_ms"].as_object()) else { return };
    // With --fuse on the composite does a part of the filter's work.
    let is_fused = row["settings"]["fuse"] == "on";
    let own: f64 = passes
        .iter()
        .map(|(name, ms)| (name, ms.as_f64().unwrap_or_default()))
        .map(|(name, ms)| match cost.pass_ms.get(name) {
            None => ms,
            Some(plain_ms) if is_fused && name.ends_with(".composite") => (ms - plain_ms).max(0.0),
            Some(_) => 0.0,
        })
        .sum();
    let pixels = picture.extent.pixel_count() as f64;
    row["evaluation_ns"] = json!(cost.evaluation_ns);
    row["overhead_ms"] = json!(own);
    row["light_pass_ms"] = json!(cost.light_pass_ms);
    row["overhead_light_passes"] = json!(cost.light_pass_ms.map(|pass| own / pass.max(1e-9)));
    row["overhead_evaluations_per_pixel"] = json!(1e6 * own / (pixels * cost.evaluation_ns).max(1e-9));
}
