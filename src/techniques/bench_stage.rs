//! What a benchmark can time of a technique: its stages, what their work is counted in, and the plain picture that
//! errors and overheads are measured against.

use crate::settings::written::{SettingValue, WrittenSettings};
use crate::settings::{DirectShadow, Values};
use crate::units::Extent;
use std::collections::BTreeMap;

/// Settings by key, as texts.
pub type Changes = &'static [(&'static str, &'static str)];

/// One stage: passes of a technique that are timed together, and what their work is.
#[derive(Clone, Copy)]
pub struct BenchStage {
    /// The word after `bench`; techniques with stages of one name do the same work in them.
    pub name: &'static str,
    /// One line for the help.
    pub summary: &'static str,
    /// Its passes, named below the technique: `split` is `split` and all of `split.*`. At least one.
    pub passes: &'static [&'static str],
    pub work: Work,
    /// Settings with which it is there, where those at their defaults leave it out.
    pub made_with: Changes,
    /// Setting and value that give its work to passes that do other work, too; None: nothing does.
    pub fused_by: Option<(&'static str, &'static str)>,
    /// Why these settings have none of its passes; None where the reason is not known.
    pub left_out: fn(&Values) -> Option<String>,
}

/// What a stage does.
#[derive(Clone, Copy)]
pub enum Work {
    /// It moves texels and computes nothing: a plain copy of as many bytes is its measure.
    Copy(Copying),
    /// Work that is counted, in one unit or several; none where it has no count.
    Counted(&'static [Count]),
}

/// What a copy is held against.
#[derive(Clone, Copy)]
pub struct Copying {
    /// The settings of its identity, the same kernel moving each texel to its own place, in words.
    pub identity: &'static str,
    pub identity_settings: Changes,
    /// Settings that leave out other work than the copy's, where they are possible.
    pub spare: Changes,
    /// The setting whose best value a sweep tells, if it is swept.
    pub tuned: &'static str,
}

/// How often a stage does a unit of its work.
#[derive(Clone, Copy)]
pub struct Count {
    pub unit: Unit,
    /// In the passes of one run; None where these figures do not say.
    pub of: fn(&Done<'_>) -> Option<f64>,
}

/// A unit of work. A row has nanoseconds for one of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// One light at one pixel.
    Evaluation,
    Pixel,
    /// One neighbour that a filter reads for a pixel.
    Tap,
    /// A sample of a pixel.
    Sample,
    /// An entry of a list.
    Entry,
    /// A surface that is shaded at one place.
    Invocation,
    Triangle,
    /// A shadow ray.
    Ray,
}

/// What a run has done.
pub struct Done<'a> {
    /// The report's `counters`.
    pub counters: &'a BTreeMap<&'static str, f64>,
    /// As they were used.
    pub settings: &'a WrittenSettings,
    /// The picture's.
    pub extent: Extent,
}

/// The plain form of a technique: each pixel shaded with all of the lights that the technique shares out.
#[derive(Clone, Copy)]
pub struct PlainForm {
    /// Settings that make it.
    pub settings: Changes,
    /// Settings that change how the plain picture is made, and nothing of it.
    pub same_picture: &'static [&'static str],
    /// The pass that sums all lights, named below the technique.
    pub light_pass: &'static str,
    /// Counter of the lights that this pass sums at a pixel.
    pub lights_per_pixel: &'static str,
    /// Settings with which this pass shades one light.
    pub one_light: Changes,
    /// Passes of the plain form that do other passes' work, too, with these settings.
    pub widened: fn(&WrittenSettings) -> &'static [&'static str],
}

/// `--KEY VALUE --KEY VALUE`.
pub fn flags(changes: Changes) -> String {
    changes.iter().map(|(key, value)| format!("--{key} {value}")).collect::<Vec<_>>().join(" ")
}

/// A `BenchStage::left_out` of a stage that settings do not leave out.
pub fn never(_: &Values) -> Option<String> {
    None
}

impl BenchStage {
    /// Whether a pass of `technique` belongs to it. `pass`: its full name.
    pub fn has(&self, technique: &str, pass: &str) -> bool {
        let below = pass.strip_prefix(technique).and_then(|rest| rest.strip_prefix('.'));
        let is = |below: &str, known: &str| {
            below.strip_prefix(known).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'))
        };
        below.is_some_and(|below| self.passes.iter().any(|known| is(below, known)))
    }

    /// Whether settings give its work to other passes.
    pub fn is_fused(&self, values: &Values) -> bool {
        self.fused_by.is_some_and(|(key, value)| values.text(key) == value)
    }

    /// Why a frame of `technique` has none of its passes, or none that do nothing else.
    pub fn absence(&self, technique: &str, values: &Values) -> String {
        if let Some((key, value)) = self.fused_by.filter(|_| self.is_fused(values)) {
            return format!("--{key} {value}: {technique} has no passes of the {} alone", self.name);
        }
        (self.left_out)(values).unwrap_or_else(|| {
            let instead =
                if self.made_with.is_empty() { String::new() } else { format!("; {} makes it", flags(self.made_with)) };
            format!("{technique} has no pass {technique}.{} with these settings{instead}", self.passes[0])
        })
    }

    /// What its work is counted in; nothing of a copy.
    pub fn counts(&self) -> &'static [Count] {
        match &self.work {
            Work::Copy(_) => &[],
            Work::Counted(counts) => counts,
        }
    }

    /// What it is held against where it is a copy.
    pub fn copying(&self) -> Option<&Copying> {
        match &self.work {
            Work::Copy(copying) => Some(copying),
            Work::Counted(_) => None,
        }
    }
}

impl Done<'_> {
    pub fn counter(&self, key: &str) -> Option<f64> {
        self.counters.get(key).copied()
    }

    /// A setting that is a number.
    pub fn number(&self, key: &str) -> Option<f64> {
        self.settings.get(key).and_then(SettingValue::as_f64)
    }

    pub fn pixels(&self) -> f64 {
        self.extent.pixel_count() as f64
    }
}

/// Counts that several techniques have.
pub const PIXELS: Count = Count { unit: Unit::Pixel, of: |done| Some(done.pixels()) };
pub const TRIANGLES: Count = Count { unit: Unit::Triangle, of: |done| done.counter("triangles_drawn") };
pub const SHADOW_TRIANGLES: Count =
    Count { unit: Unit::Triangle, of: |done| done.counter("shadow_map_triangles_drawn") };
/// The scene's own lights, evaluated one by one.
pub const LIGHT_EVALUATIONS: Count = Count { unit: Unit::Evaluation, of: |done| done.counter("light_evaluations") };

/// Lists of lights for tiles of the picture.
pub const CULL: BenchStage = BenchStage {
    name: "cull",
    summary: "Lists of lights for tiles of the picture, in nanoseconds a pixel",
    passes: &["cull"],
    work: Work::Counted(&[PIXELS]),
    made_with: &[("cull", "tiled")],
    fused_by: None,
    left_out: never,
};

/// Shadow maps, drawn in each frame.
pub const SHADOW_MAPS: BenchStage = BenchStage {
    name: "shadow-maps",
    summary: "Shadow maps of all lights, in nanoseconds a triangle that is drawn into them",
    passes: &["shadow_maps"],
    work: Work::Counted(&[SHADOW_TRIANGLES]),
    made_with: &[("direct-shadow", "map")],
    fused_by: None,
    left_out: |values| {
        let shadow: DirectShadow = values.choice("direct-shadow");
        (shadow != DirectShadow::Map).then(|| format!("--direct-shadow {} draws no shadow maps", shadow.name()))
    },
};

/// Depth before the pass with materials.
pub const DEPTH: BenchStage = BenchStage {
    name: "depth",
    summary: "Depth pre-pass, in nanoseconds a triangle",
    passes: &["depth"],
    work: Work::Counted(&[TRIANGLES]),
    made_with: &[],
    fused_by: None,
    left_out: |values| (!values.is_on("depth-prepass")).then(|| "--depth-prepass off draws none".to_owned()),
};

/// The geometry buffer at the picture's size.
pub const GBUFFER: BenchStage = BenchStage {
    name: "gbuffer",
    summary: "Drawing of the G-buffer, in nanoseconds a pixel and a triangle",
    passes: &["gbuffer"],
    work: Work::Counted(&[PIXELS, TRIANGLES]),
    made_with: &[],
    fused_by: None,
    left_out: never,
};

#[cfg(test)]
mod tests {
    use super::*;

    const STAGE: BenchStage = BenchStage { name: "split", passes: &["split", "mask"], ..CULL };

    #[test]
    fn a_stage_is_its_passes_and_those_below_them() {
        let names = ["t.gbuffer", "t.split.blocks", "t.split", "t.splitting", "t.mask", "other.split", "split"];
        let found: Vec<&str> = names.into_iter().filter(|name| STAGE.has("t", name)).collect();
        assert_eq!(found, ["t.split.blocks", "t.split", "t.mask"]);
    }
}
