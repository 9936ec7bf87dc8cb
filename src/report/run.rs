//! The report of one run: the request, the device, the result, and the cost of each pass and each byte. Keys:
//! docs/report.md; within a schema number a key is only ever added.

use crate::error::Result;
use crate::frame::View;
use crate::gpu::Gpu;
use crate::gpu::commands::RecordedPass;
use crate::gpu::recorded::FrameTime;
use crate::gpu::timing::Clock;
use crate::lights::LightSet;
use crate::metrics::{self, Metrics};
use crate::picture::{Aov, AovChannels, Picture};
use crate::report::memory::MemoryTable;
use crate::scene::Scene;
use crate::settings::Values;
use crate::techniques::Technique;
use crate::units::{Bytes, Extent};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::fmt::Write;
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
const SCHEMA: u32 = 1;
/// A pass whose timestamp is farther from its wall time than this part of it is reported.
const DISAGREEMENT: f64 = 0.1;
/// Shorter passes are not judged: the submit itself takes tens of microseconds.
const JUDGED_FROM_MS: f64 = 1.0;

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

/// A JSON document in the making, and the text that a person reads.
pub struct Report {
    document: Map<String, Value>,
    is_software: bool,
}

/// Median, least and greatest of some milliseconds, with the samples.
pub fn spread(samples: &[f64]) -> Value {
    if samples.is_empty() {
        return Value::Null;
    }
    let mut sorted = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    json!({ "median": median(&sorted), "min": sorted[0], "max": sorted[sorted.len() - 1], "samples": samples })
}

/// Median of sorted samples, at least one.
pub fn median(sorted: &[f64]) -> f64 {
    let middle = sorted.len() / 2;
    if sorted.len().is_multiple_of(2) { 0.5 * (sorted[middle - 1] + sorted[middle]) } else { sorted[middle] }
}

/// A setting's text, a number where it is one.
pub fn setting(text: &str) -> Value {
    text.parse::<serde_json::Number>().map_or_else(|_| json!(text), Value::Number)
}

/// Every setting by its key. `resolved`: what `auto` and percentages came to.
pub fn settings(values: &Values, resolved: &BTreeMap<&'static str, String>) -> Value {
    let value = |key: &str, text: &str| setting(resolved.get(key).map_or(text, String::as_str));
    Value::Object(values.iter().map(|(key, text)| (key.to_owned(), value(key, text))).collect())
}

/// What a pass's statistics say of its shaders; None where it has none.
fn invocations(pass: &Value) -> Option<String> {
    let counts = pass.get("statistics")?;
    let count = |stage: &str| counts[format!("{stage}_shader_invocations")].as_u64().unwrap_or_default();
    let stages = ["vertex", "geometry", "fragment", "compute"].into_iter().filter(|stage| count(stage) > 0);
    let told: Vec<String> = stages.map(|stage| format!("{stage} {}", count(stage))).collect();
    Some(format!("{} invocations", if told.is_empty() { "no".to_owned() } else { told.join(", ") }))
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

impl Report {
    pub fn new(technique: &dyn Technique, command: &[String], gpu: &Gpu) -> Self {
        let mut document = Map::new();
        document.insert("schema".into(), json!(SCHEMA));
        let (version, commit) = (env!("CARGO_PKG_VERSION"), env!("QUINCUNX_COMMIT"));
        document.insert("quincunx".into(), json!({ "version": version, "commit": commit }));
        document.insert("command".into(), json!(command));
        let mut device = json!(gpu.caps.identity);
        device["robust_buffer_access"] = json!(gpu.is_robust);
        document.insert("device".into(), device);
        document.insert("technique".into(), json!(technique.name()));
        document.insert("estimator".into(), json!(technique.estimator_version()));
        Self { document, is_software: gpu.caps.identity.is_software() }
    }

    /// What was drawn: `scene` as `view` shows it, under `lights`.
    pub fn scene(&mut self, scene: &Scene, view: &View, lights: &LightSet) {
        let mut entry = json!({
            "name": scene.name,
            "hash": scene.hash,
            "triangles": scene.triangle_count(),
            "draws": scene.draws.len(),
            "lights": lights.lights.len(),
            "materials": scene.materials.len(),
            "camera": view.camera.name,
        });
        if lights.has_rig {
            entry["rig"] = json!("default");
        }
        if view.made_up {
            entry["camera"] = json!("framing");
        }
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
        if !warnings.is_empty() {
            entry["warnings"] = json!(warnings);
        }
        self.document.insert("scene".into(), entry);
    }

    /// As `settings` makes them.
    pub fn settings(&mut self, settings: Value) {
        self.document.insert("settings".into(), settings);
    }

    /// `exposure_ev`: of a PNG, at how many stops it was written.
    ///
    /// Errors: the picture holds NaN or infinity (exit code 1).
    pub fn image(&mut self, picture: &Picture, path: &Path, exposure_ev: Option<f64>) -> Result<()> {
        let hash = picture.hash()?;
        let Extent { width, height } = picture.extent;
        let path = path.display().to_string();
        let mean = picture.mean();
        let mut entry = json!({ "width": width, "height": height, "mean": mean, "hash": hash, "path": path });
        if let Some(exposure_ev) = exposure_ev {
            entry["exposure_ev"] = json!(exposure_ev);
        }
        self.document.insert("image".into(), entry);
        Ok(())
    }

    /// Notes on the picture for the reader.
    pub fn notes(&mut self, notes: &[String]) {
        if !notes.is_empty() {
            self.document.insert("notes".into(), json!(notes));
        }
    }

    pub fn aovs(&mut self, aovs: &[Aov], extent: Extent) {
        let entries: Vec<Value> = aovs
            .iter()
            .map(|aov| {
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
                json!({ "name": aov.name, "format": format, "extent": extent.to_string(), "hash": hash })
            })
            .collect();
        self.document.insert("aovs".into(), json!(entries));
    }

    /// Which frame of a sequence it is, and at which time.
    pub fn frame(&mut self, frame: u32, time_s: f64) {
        self.document.insert("frame".into(), json!(frame));
        self.document.insert("time_s".into(), json!(time_s));
    }

    /// A row for each pass, with its times where frames were submitted pass by pass and what the device counted where it was
    /// asked to; and the frame's time.
    pub fn times(&mut self, passes: &Passes<'_>, frames: &[FrameTime], profile: bool) {
        let once = |passes: &[(String, u64)], place: &str| -> Vec<Value> {
            let row = |(name, ns): &(String, u64)| json!({ "name": name, "where": place, "ms": spread(&[milliseconds(*ns)]) });
            passes.iter().map(row).collect()
        };
        let mut rows = once(passes.host, "host, once");
        rows.extend(once(passes.once, "device, once"));
        let clock = passes.clock;
        let mut warnings = Vec::new();
        for (index, pass) in passes.each_frame.iter().enumerate() {
            let walls: Vec<f64> =
                frames.iter().filter_map(|frame| frame.passes[index].wall_ns).map(milliseconds).collect();
            let stamps: Vec<f64> =
                frames.iter().filter_map(|frame| frame.passes[index].timestamp_ns).map(milliseconds).collect();
            if walls.iter().zip(&stamps).any(|(wall, stamp)| disagrees(clock, *wall, *stamp)) {
                warnings.push(format!("{}: timestamp and wall time differ by over 10 %", pass.name));
            }
            let mut row = json!({
                "name": pass.name,
                "bytes_read": pass.traffic.read_bytes,
                "bytes_written": pass.traffic.written_bytes,
                "invocations": pass.traffic.invocations,
            });
            if profile {
                let figures = frames.iter().filter_map(|frame| frame.passes[index].figure_ns(clock));
                row["ms"] = spread(&figures.map(milliseconds).collect::<Vec<f64>>());
                row["timestamp_ms"] = spread(&stamps);
                row["wall_ms"] = spread(&walls);
            }
            // Statistics are those of the last frame, as counters are.
            if let Some(counts) = frames.last().and_then(|frame| frame.statistics.get(index)) {
                row["statistics"] = json!(counts);
            }
            rows.push(row);
        }
        let totals: Vec<f64> = frames.iter().map(|frame| milliseconds(frame.figure_ns(clock))).collect();
        self.document.insert("passes".into(), json!(rows));
        self.document.insert("clock".into(), json!(clock.name()));
        self.document.insert("total_ms".into(), spread(&totals));
        // Without --profile the one frame also pays for what drivers compile at first use.
        self.document.insert("warmup_frames".into(), json!(u32::from(profile)));
        if !warnings.is_empty() {
            self.document.insert("timing_warnings".into(), json!(warnings));
        }
    }

    pub fn memory(&mut self, table: &MemoryTable) {
        self.document.insert("memory".into(), table.json());
    }

    pub fn counters(&mut self, counters: &BTreeMap<&'static str, f64>) {
        self.document.insert("counters".into(), json!(counters));
    }

    /// Errors of the picture against its reference.
    pub fn errors(&mut self, errors: Value) {
        self.document.insert("errors".into(), errors);
    }

    /// The whole document.
    pub fn json(&self) -> Value {
        Value::Object(self.document.clone())
    }

    /// What the header of a picture carries.
    pub fn attributes(&self) -> Vec<(String, String)> {
        let text = |value: &Value| value.as_str().map_or_else(|| value.to_string(), str::to_owned);
        let samples = self.document["counters"].get("samples").and_then(Value::as_f64).map(|count| json!(count as u64));
        let mut attributes = [
            (header::VERSION, &self.document["quincunx"]["version"]),
            (header::TECHNIQUE, &self.document["technique"]),
            (header::ESTIMATOR, &self.document["estimator"]),
            (header::SCENE, &self.document["scene"]["name"]),
            (header::SCENE_HASH, &self.document["scene"]["hash"]),
            (header::SETTINGS, &self.document["settings"]),
        ]
        .map(|(name, value)| (name.to_owned(), text(value)))
        .to_vec();
        attributes.extend(samples.map(|count| (header::SAMPLES.to_owned(), count.to_string())));
        attributes
    }

    /// The report as text for a reader.
    pub fn text(&self) -> String {
        let document = &self.document;
        let string = |value: &Value| value.as_str().unwrap_or_default().to_owned();
        let mut text = String::new();
        let mut line = |words: String| writeln!(text, "{words}").expect("writing to a string");
        line(format!(
            "{}  {} triangles, {} draws, {} lights, {} materials",
            string(&document["scene"]["name"]),
            document["scene"]["triangles"],
            document["scene"]["draws"],
            document["scene"]["lights"],
            document["scene"]["materials"]
        ));
        for warning in document["scene"]["warnings"].as_array().into_iter().flatten() {
            line(format!("  note: {}", string(warning)));
        }
        let device = &document["device"];
        line(format!(
            "{}  ({}, Vulkan {})",
            string(&device["name"]),
            string(&device["driver_info"]),
            string(&device["api"])
        ));
        for pass in document["passes"].as_array().into_iter().flatten() {
            let place = pass["where"].as_str().map_or_else(String::new, |place| format!("  ({place})"));
            let time = pass["ms"]["median"].as_f64().map(|ms| format!("{ms:>10.3} ms{place}"));
            let told: Vec<String> = time.into_iter().chain(invocations(pass)).collect();
            if !told.is_empty() {
                line(format!("  {:<44} {}", string(&pass["name"]), told.join("  ")));
            }
        }
        let software = if self.is_software { ", software driver" } else { "" };
        let warm = if document["warmup_frames"] == 0 { ", first frame, shader compilation included" } else { "" };
        let total = document["total_ms"]["median"].as_f64().unwrap_or_default();
        line(format!("  {:<44} {total:>10.3} ms{software}{warm}", "frame"));
        for warning in document.get("timing_warnings").and_then(Value::as_array).into_iter().flatten() {
            line(format!("  note: {}", string(warning)));
        }
        let counter = |key: &str| document["counters"][key].as_f64();
        if let (Some(found), Some(wanted)) = (counter("vpls_found"), counter("vpls"))
            && found < wanted
        {
            line(format!(
                "  note: light walks found places for {found} virtual point lights of {wanted}; the others are dark"
            ));
        }
        if let Some(open) = counter("shadow_casters_not_closed").filter(|open| *open > 0.0) {
            line(format!("  note: draws without shadow volumes, because their meshes are not closed: {open}"));
        }
        if let Some(samples) = counter("samples") {
            let (error, plural) = (counter("estimated_error"), if samples == 1.0 { "" } else { "s" });
            let words = error.map_or(String::new(), |error| format!(", estimated error {error:.5}"));
            line(format!("{samples} sample{plural} a pixel{words}"));
            let most = document["settings"].get("until-error").and_then(Value::as_f64).filter(|most| *most > 0.0);
            if let Some(most) = most.filter(|most| error.is_some_and(|error| error > *most)) {
                line(format!("  note: --until-error {most} is not reached; a larger --spp would help"));
            }
        }
        if let (Some(evaluated), Some(left_out)) = (counter("light_evaluations"), counter("light_evaluations_culled"))
            && evaluated + left_out > 0.0
        {
            // The composite shades virtual lights' techniques, and other work with it.
            let shades = if counter("vpls").is_some() { "composite" } else { "shade" };
            let named = |pass: &&Value| string(&pass["name"]).ends_with(&format!(".{shades}"));
            let pass_ms = document["passes"].as_array().into_iter().flatten().find(named);
            let each = pass_ms.and_then(|pass| pass["ms"]["median"].as_f64()).map(|ms| 1e6 * ms / evaluated.max(1.0));
            line(format!(
                "direct light: {:.1} million evaluations of a light at a pixel{}, {:.0} % left out by culling",
                evaluated / 1e6,
                each.map_or(String::new(), |ns| format!(", {ns:.2} ns each")),
                100.0 * left_out / (evaluated + left_out)
            ));
        }
        let bytes = |key: &str| Bytes(document["memory"][key].as_u64().unwrap_or_default());
        line(format!(
            "memory: {} planned, {} allocated, {} saved by sharing, {} in memory blocks",
            bytes("planned_bytes"),
            bytes("allocated_bytes"),
            bytes("aliased_bytes"),
            bytes("memory_block_bytes")
        ));
        if document["memory"]["touched_bytes"].is_u64() {
            let (touched, of) = (bytes("touched_bytes"), bytes("touched_of_bytes"));
            line(format!("  touched: {touched} of {of}, over the resources in which the frame counts"));
        }
        if let Some(errors) = document.get("errors") {
            line(format!("errors against {}", string(&errors["reference"])));
            for name in Metrics::NAMES {
                // Equal pictures have a PSNR without end.
                let value = errors[name].as_f64().unwrap_or(f64::INFINITY);
                let is_cut = errors["cut"].as_array().is_some_and(|cut| !cut.is_empty());
                line(metrics::line(name, value, errors["threshold"].as_f64().unwrap_or_default(), is_cut));
            }
        }
        for note in document.get("notes").and_then(Value::as_array).into_iter().flatten() {
            line(format!("note: {}", string(note)));
        }
        if let Some(exposure_ev) = document["image"]["exposure_ev"].as_f64().filter(|exposure_ev| *exposure_ev != 0.0) {
            line(format!("exposure {exposure_ev} EV"));
        }
        line(format!("image hash {}", string(&document["image"]["hash"])));
        line(format!("wrote {}", string(&document["image"]["path"])));
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_of_an_even_number_lies_between() {
        let value = spread(&[4.0, 1.0, 3.0, 2.0]);
        assert_eq!(value["median"], 2.5);
        assert_eq!((&value["min"], &value["max"]), (&json!(1.0), &json!(4.0)));
        assert_eq!(spread(&[]), Value::Null);
    }
}
