//! `bench frame`: whole frames of each variant, in turn, after a warm-up of each; then each variant's passes.
//!
//! Times are compared inside one run only. A round makes one frame of every variant, so that drift of the machine falls
//! on all of them; ratios are of the same round.

use super::stats::{Ratio, paired_ratio};
use super::sweep::{Point, label};
use crate::error::Result;
use crate::gpu::commands::Submits;
use crate::interrupt;
use crate::job::{Job, judge};
use crate::metrics;
use crate::report::picture::Picture;
use crate::report::run::{median, spread};
use crate::session::{Renderer, Session};
use crate::settings::Values;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// What a benchmark found.
pub struct Rows {
    /// One JSON document each.
    pub rows: Vec<Value>,
    /// Stopped by the user after a whole round; the rows hold the rounds before.
    pub interrupted: bool,
}

/// Frames of a variant's passes, after one that warms up.
const PASS_FRAMES: usize = 3;

/// A point of the grid, ready to make frames.
struct Variant {
    label: String,
    values: Values,
    renderer: Renderer,
    picture: Picture,
    frame_ms: Vec<f64>,
}

/// Runs every point of `grid` on `job`'s scene, `repeat` rounds. `progress` is told each finished frame out of how many.
///
/// Errors: an impossible setting (exit code 2), no device (3), the device fails (4), interrupted before the first round
/// ended (130).
pub fn frames(job: &mut Job, grid: &[Point], repeat: usize, progress: &dyn Fn(usize, usize)) -> Result<Rows> {
    let defaults = job.values.clone();
    let mut settings = Vec::new();
    for point in grid {
        job.values = defaults.clone();
        for (key, value) in point {
            job.set(key, value).map_err(|error| error.within("--sweep"))?;
        }
        settings.push((label(point), job.values.clone()));
    }
    job.values = defaults;
    let session = Session::open(&job.device_request(), job.load_scene()?)?;
    let mut variants = Vec::new();
    for (label, values) in settings {
        let renderer = session.renderer(job.technique, &values, &[], Submits::One)?;
        // The first frame compiles shaders; it is not timed, and its picture is the variant's.
        renderer.frame()?;
        let picture = renderer.picture()?;
        variants.push(Variant { label, values, renderer, picture, frame_ms: Vec::new() });
    }
    let interrupted = rounds(&mut variants, repeat, progress)?;
    let reference = Reference::of(job, &session, &variants)?;
    let mut rows = Vec::new();
    let baseline_ms = variants[0].frame_ms.clone();
    let baseline = variants[0].label.clone();
    for variant in &variants {
        let mut row = row(job, &session, variant)?;
        let Ratio { mean, interval, pairs } = paired_ratio(&baseline_ms, &variant.frame_ms);
        row["speed_up"] = json!({ "baseline": baseline, "mean": mean, "interval_95": interval, "pairs": pairs });
        if let Some(reference) = &reference {
            reference.judge(variant, &mut row)?;
        }
        rows.push(row);
    }
    let log = session.gpu.validation_log();
    drop((variants, session));
    judge(log.as_deref())?;
    Ok(Rows { rows, interrupted })
}

/// True when the user stopped it after a whole round.
fn rounds(variants: &mut [Variant], repeat: usize, progress: &dyn Fn(usize, usize)) -> Result<bool> {
    let all = repeat * variants.len();
    for round in 0..repeat {
        for index in 0..variants.len() {
            if let Err(stop) = interrupt::check() {
                if round == 0 {
                    return Err(stop);
                }
                // The round is not whole: its frames have no pairs.
                variants.iter_mut().for_each(|variant| variant.frame_ms.truncate(round));
                return Ok(true);
            }
            let time = variants[index].renderer.frame()?;
            variants[index].frame_ms.push(time.wall_ns as f64 / 1e6);
            progress(round * variants.len() + index + 1, all);
        }
    }
    Ok(false)
}

/// Median milliseconds of each device pass of these settings.
fn pass_ms(job: &Job, session: &Session, values: &Values) -> Result<Vec<(String, f64)>> {
    let renderer = session.renderer(job.technique, values, &[], Submits::PerPass)?;
    renderer.frame()?;
    let frames = (0..PASS_FRAMES).map(|_| renderer.frame()).collect::<Result<Vec<_>>>()?;
    let times = renderer.passes().iter().enumerate().map(|(index, pass)| {
        let mut samples: Vec<f64> =
            frames.iter().filter_map(|frame| frame.passes[index].wall_ns).map(|ns| ns as f64 / 1e6).collect();
        samples.sort_by(f64::total_cmp);
        (pass.name.clone(), median(&samples))
    });
    Ok(times.collect())
}

fn row(job: &Job, session: &Session, variant: &Variant) -> Result<Value> {
    let settings: BTreeMap<&str, &str> = variant.values.iter().collect();
    let passes: serde_json::Map<String, Value> =
        pass_ms(job, session, &variant.values)?.into_iter().map(|(name, ms)| (name, json!(ms))).collect();
    let traffic = variant.renderer.passes().iter().map(|pass| pass.traffic);
    Ok(json!({
        "schema": 1,
        "bench": "frame",
        "variant": variant.label,
        "device": session.gpu.caps.identity,
        "commit": env!("QUINCUNX_COMMIT"),
        "scene": { "name": session.scene.name, "hash": session.scene.hash },
        "technique": job.technique.name(),
        "settings": settings,
        "command": repeating_command(job, variant),
        "image_hash": variant.picture.hash()?,
        "frame_ms": spread(&variant.frame_ms),
        "pass_ms": passes,
        "bytes_read": traffic.clone().map(|one| one.read_bytes).sum::<u64>(),
        "bytes_written": traffic.map(|one| one.written_bytes).sum::<u64>(),
        "planned_bytes": variant.renderer.plan.bytes(),
        "counters": variant.renderer.counters,
    }))
}

/// The `render` command of a variant: every setting that is not at its default.
fn repeating_command(job: &Job, variant: &Variant) -> Vec<String> {
    let defaults = Job::new(&job.scene, job.technique).values;
    let mut command =
        ["quincunx", "render", &job.scene, "--technique", job.technique.name()].map(str::to_owned).to_vec();
    for (key, value) in variant.values.iter() {
        if defaults.text(key) != value {
            command.extend([format!("--{key}"), value.to_owned()]);
        }
    }
    command
}

/// Plain deferred shading of the same lights: what errors and overheads are measured against.
struct Reference {
    picture: Picture,
    /// Passes that it has too are no overhead.
    pass_names: Vec<String>,
    /// Nanoseconds for each light at each pixel.
    evaluation_ns: f64,
}

impl Reference {
    /// None where the technique has no `--split none`.
    fn of(job: &Job, session: &Session, variants: &[Variant]) -> Result<Option<Self>> {
        let mut plain = Job::new(&job.scene, job.technique);
        plain.values = variants[0].values.clone();
        if plain.set("split", "none").is_err() {
            return Ok(None);
        }
        let renderer = session.renderer(job.technique, &plain.values, &[], Submits::One)?;
        renderer.frame()?;
        let picture = renderer.picture()?;
        let passes = pass_ms(job, session, &plain.values)?;
        let lights = renderer.counters.get("subset_lights_per_pixel").copied().unwrap_or(0.0);
        let shade = format!("{}.shade", job.technique.name());
        let shade_ms = passes.iter().find(|(name, _)| *name == shade).map_or(0.0, |(_, ms)| *ms);
        let evaluations = picture.extent.pixel_count() as f64 * lights;
        Ok(Some(Self {
            picture,
            pass_names: passes.into_iter().map(|(name, _)| name).collect(),
            evaluation_ns: 1e6 * shade_ms / evaluations.max(1.0),
        }))
    }

    /// Error and overhead of a variant with the first variant's size and camera.
    fn judge(&self, variant: &Variant, row: &mut Value) -> Result<()> {
        if variant.picture.extent == self.picture.extent {
            let comparison = metrics::compare(&variant.picture, &self.picture)?;
            row["error_against_none"] = json!(comparison.metrics);
        }
        let own = row["pass_ms"]
            .as_object()
            .into_iter()
            .flatten()
            .filter(|(name, _)| !self.pass_names.contains(name))
            .fold(0.0, |sum, (_, ms)| sum + ms.as_f64().unwrap_or_default());
        let pixels = variant.picture.extent.pixel_count() as f64;
        row["evaluation_ns"] = json!(self.evaluation_ns);
        row["overhead_ms"] = json!(own);
        row["overhead_evaluations_per_pixel"] = json!(1e6 * own / (pixels * self.evaluation_ns).max(1e-9));
        Ok(())
    }
}
