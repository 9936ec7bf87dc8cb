//! Rows made of what was measured: what all of a run share, and what is found of each.

use super::candidate::Candidate;
use super::group::{BASELINE, Companion, Measurement, Member};
use super::machine::Load;
use super::reference::{Found, Reference, pass_ms};
use super::rounds::Samples;
use super::row::{BenchRow, Beside, SceneName, SpeedUp};
use super::stats::{median, paired_ratio};
use super::units::UnitTimes;
use super::what::What;
use crate::error::{Error, ErrorKind, Result};
use crate::gpu::commands::Submits;
use crate::job::{Job, settings};
use crate::metrics;
use crate::picture::Picture;
use crate::reference::ReferenceRequest;
use crate::report::spread::Spread;
use crate::sequence::Frames;
use crate::settings::Values;
use crate::settings::written::{SettingValue, WrittenSettings};
use crate::techniques::bench_stage::{Done, PlainForm};
use crate::techniques::{Technique, counted};
use indexmap::IndexMap;
use std::collections::BTreeMap;

/// Number of the set of keys.
const SCHEMA: u32 = 1;

/// What every row of a run shares.
pub struct Head<'a> {
    pub measurement: Measurement<'a>,
    pub repeat: usize,
    /// As `rounds::Length` has it.
    pub until_interval: Option<f64>,
    /// The baseline's label.
    pub baseline: String,
    /// None: one moment.
    pub frames: Option<Frames>,
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
    /// The keys that say what a row is of. Settings are as they were typed: their resolved values are known when they
    /// are made.
    pub fn row(&self, candidate: &Candidate) -> BenchRow {
        let Measurement { job, session, what, is_fair, .. } = &self.measurement;
        let text = |(key, text): (&String, &String)| (key.clone(), SettingValue::Text(text.clone()));
        BenchRow {
            schema: SCHEMA,
            bench: what.name().to_owned(),
            variant: candidate.label.clone(),
            name: candidate.name.clone(),
            device: Some(session.gpu.caps.identity.clone()),
            commit: env!("QUINCUNX_COMMIT").to_owned(),
            scene: SceneName { name: session.scene.name.clone(), hash: session.scene.hash.clone() },
            technique: candidate.job.technique.name().to_owned(),
            asked: Some(candidate.asked.iter().map(text).collect()),
            settings: candidate.settings.iter().map(|(key, text)| (key.clone(), SettingValue::of(text))).collect(),
            repeat: self.repeat,
            until_interval: self.until_interval,
            baseline: self.baseline.clone(),
            fair: is_fair.then_some(true),
            reference: job.reference.as_ref().map(ReferenceRequest::identity),
            frames: self.frames.clone(),
            ..BenchRow::default()
        }
    }

    /// The row of a variant that cannot be, and why.
    pub fn skipped(&self, candidate: &Candidate, error: &Error) -> BenchRow {
        BenchRow { skipped: Some(error.message().to_owned()), ..self.row(candidate) }
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
    ) -> Result<BenchRow> {
        let Measurement { session, what, .. } = &self.measurement;
        let renderer = &member.variant.renderer;
        let samples = &rounds.samples;
        let values = candidate.values.as_ref().map_err(Error::clone)?;
        let times = samples[member.probe].totals_ms();
        let baseline = samples[BASELINE].totals_ms();
        let [read, written] = member.variant.traffic_bytes();
        let used = settings(session, renderer, values);
        let memory = renderer.touched(session.memory_table(renderer, None)?)?.sums();
        let counters = renderer.measured_counters()?;
        let spread = Spread::of(&times);
        let (frame_ms, stage_ms) = if *what == What::Frame { (spread, None) } else { (None, spread) };
        let speed_up = SpeedUp { ratio: paired_ratio(&baseline, &times), baseline: self.baseline.clone() };
        let mut row = BenchRow {
            unread_axes: (!candidate.unread_axes.is_empty()).then(|| candidate.unread_axes.clone()),
            command: Some(self.repeating_command(candidate.job.technique, values)),
            group: Some(rounds.group.clone()),
            machine: Some(rounds.load),
            clock: Some(renderer.clock().name().to_owned()),
            image_hash: Some(picture.hash()?),
            frame_ms,
            stage_ms,
            pass_ms: Some(self.pass_ms(candidate, member, samples)?),
            speed_up: Some(speed_up),
            ratio: Some(paired_ratio(&times, &baseline)),
            bytes_read: read,
            bytes_written: written,
            planned_bytes: Some(renderer.plan.bytes()),
            memory: Some(memory),
            unit_times: self.unit_times(candidate, member, &times, &counters, &used)?,
            counters: Some(counters.into_iter().map(|(key, count)| (key.to_owned(), count)).collect()),
            settings: used,
            ..self.row(candidate)
        };
        copies(&mut row, member, samples);
        match reference {
            Ok(reference) => {
                let comparison = metrics::compare(picture, &reference.picture, metrics::DEFAULT_THRESHOLD)?;
                row.error_against_none = Some(comparison.metrics);
                if let Some(plain) = candidate.job.technique.plain() {
                    overhead(&mut row, picture, reference, plain);
                }
            }
            Err(error) => row.reference_skipped = Some(error.message().to_owned()),
        }
        Ok(row)
    }

    /// The `render` command of a variant: every setting that is not at its default; pass times where a stage is timed.
    fn repeating_command(&self, technique: &'static dyn Technique, values: &Values) -> Vec<String> {
        let Measurement { job, what, .. } = &self.measurement;
        let defaults = Job::new(&job.scene, technique).values;
        let mut command =
            ["quincunx", "render", &job.scene, "--technique", technique.name()].map(str::to_owned).to_vec();
        for (key, default) in defaults.iter() {
            if values.text(key) != default {
                command.extend([format!("--{key}"), values.text(key).to_owned()]);
            }
        }
        command.extend(self.frames.iter().flat_map(Frames::arguments));
        command.extend(job.reference.iter().flat_map(ReferenceRequest::arguments));
        if *what != What::Frame {
            command.push("--profile".to_owned());
        }
        command
    }

    /// Median milliseconds of each timed pass. A frame is one submit: its passes are timed in frames of their own.
    fn pass_ms(
        &self,
        candidate: &Candidate,
        member: &Member,
        samples: &[Samples],
    ) -> Result<Option<IndexMap<String, f64>>> {
        let Measurement { session, what, .. } = &self.measurement;
        if *what == What::Frame {
            let values = candidate.values.as_ref().map_err(Error::clone)?;
            return Ok(pass_ms(&candidate.job, session, values)?.map(|passes| passes.into_iter().collect()));
        }
        let names = member.variant.passes.iter().map(|index| member.variant.renderer.passes()[*index].name.clone());
        Ok(Some(names.zip(samples[member.probe].part_medians_ms()).collect()))
    }

    /// Nanoseconds for each unit of the stage's work. What a timed frame does not count, one that is not timed does.
    fn unit_times(
        &self,
        candidate: &Candidate,
        member: &Member,
        times: &[f64],
        counters: &BTreeMap<&'static str, f64>,
        settings: &WrittenSettings,
    ) -> Result<UnitTimes> {
        let mut unit_times = UnitTimes::default();
        let counts = member.variant.stage.map_or(&[][..], |stage| stage.counts());
        let extent = member.variant.extent();
        let timed = Done { counters, settings, extent };
        let is_counted = counts.iter().all(|count| (count.of)(&timed).is_some());
        let more = if is_counted { None } else { self.counted(candidate)? };
        let counters = more.as_ref().unwrap_or(counters);
        let done = Done { counters, settings, extent };
        for count in counts {
            if let Some(work) = (count.of)(&done) {
                unit_times.set(count.unit, 1e6 * median(times) / work.max(1.0));
            }
        }
        Ok(unit_times)
    }

    /// What a frame counts that is not timed; None where it cannot be made beside those that are, or counts no more.
    ///
    /// Errors: the device fails (exit code 4).
    fn counted(&self, candidate: &Candidate) -> Result<Option<BTreeMap<&'static str, f64>>> {
        let (technique, session) = (candidate.job.technique, self.measurement.session);
        let values = candidate.values.as_ref().map_err(Error::clone)?;
        let counted = counted(technique, values);
        if counted == *values {
            return Ok(None);
        }
        match session.renderer(technique, &counted, &[], Submits::One) {
            Ok(renderer) => {
                renderer.frame()?;
                renderer.measured_counters().map(Some)
            }
            Err(error) if matches!(error.kind(), ErrorKind::Memory | ErrorKind::Request | ErrorKind::NoDevice) => {
                Ok(None)
            }
            Err(error) => Err(error),
        }
    }
}

/// A copy beside its identity and beside vkCmdCopyBuffer.
fn copies(row: &mut BenchRow, member: &Member, samples: &[Samples]) {
    let times = samples[member.probe].totals_ms();
    let against = |companion: &Companion| match companion {
        Ok(probe) => {
            let theirs = samples[*probe].totals_ms();
            Beside::Measured { ratio: paired_ratio(&times, &theirs), ms: Spread::of(&theirs).unwrap_or_default() }
        }
        Err(error) => Beside::Skipped { skipped: error.message().to_owned() },
    };
    row.identity = member.identity.as_ref().map(against);
    row.copy = member.copy.as_ref().map(against);
    if row.copy.is_some() {
        let bytes = member.variant.result_bytes();
        row.copied_bytes = Some(bytes);
        // Bytes over milliseconds are kilobytes a second.
        row.copied_gb_per_s = Some(bytes as f64 / median(&times) / 1e6);
    }
}

/// What a frame has beside its plain form, in evaluations of one light at each pixel.
fn overhead(row: &mut BenchRow, picture: &Picture, reference: &Reference, plain: &PlainForm) {
    let (Some(cost), Some(Some(passes))) = (&reference.cost, &row.pass_ms) else { return };
    let widened = (plain.widened)(&row.settings);
    let is_widened = |name: &str| widened.iter().any(|pass| name == format!("{}.{pass}", row.technique));
    let own: f64 = passes
        .iter()
        .map(|(name, ms)| match cost.pass_ms.get(name) {
            None => *ms,
            Some(plain_ms) if is_widened(name) => (ms - plain_ms).max(0.0),
            Some(_) => 0.0,
        })
        .sum();
    let pixels = picture.extent.pixel_count() as f64;
    row.evaluation_ns = Some(cost.evaluation_ns);
    row.overhead_ms = Some(own);
    row.light_pass_ms = Some(cost.light_pass_ms);
    row.overhead_light_passes = Some(cost.light_pass_ms.map(|pass| own / pass.max(1e-9)));
    row.overhead_evaluations_per_pixel = Some(1e6 * own / (pixels * cost.evaluation_ns).max(1e-9));
}
