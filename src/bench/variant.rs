//! A variant made real: a renderer, and which of its passes are timed.

use super::frames::VariantSequence;
use super::rounds::Probe;
use super::what::What;
use crate::error::{Error, Result};
use crate::session::{Renderer, Session};
use crate::settings::Values;
use crate::techniques::Technique;
use crate::techniques::bench_stage::BenchStage;
use crate::units::Extent;

/// A renderer whose frame, or whose stage, is timed.
pub struct Variant {
    pub renderer: Renderer,
    /// What is timed; None: whole frames.
    pub stage: Option<&'static BenchStage>,
    /// Indices of the passes that are timed, in order, at least one.
    pub passes: Vec<usize>,
    /// What is timed instead of frames of one moment; None without `--frames`.
    pub sequence: Option<VariantSequence>,
}

impl Variant {
    /// Makes the renderer; no frame runs.
    ///
    /// Errors: impossible settings, a technique without the stage, or settings that leave it out (exit code 2); memory
    /// (4).
    pub fn new(session: &Session, technique: &dyn Technique, what: What, values: &Values) -> Result<Self> {
        let stage = what.stage_of(technique)?;
        let renderer = session.renderer(technique, values, &[], what.submits())?;
        if stage.is_some() && renderer.is_in_parts() {
            return Err(Error::request("a stage is timed in a frame of one run")
                .note("--accumulate 1 --until-error 0, or `bench frame`"));
        }
        let is_timed =
            |index: &usize| stage.is_none_or(|stage| stage.has(technique.name(), &renderer.passes()[*index].name));
        let passes: Vec<usize> = (0..renderer.passes().len()).filter(is_timed).collect();
        match stage {
            Some(stage) if passes.is_empty() || stage.is_fused(values) => {
                Err(Error::request(stage.absence(technique.name(), values)))
            }
            _ => Ok(Self { renderer, stage, passes, sequence: None }),
        }
    }

    pub fn extent(&self) -> Extent {
        self.renderer.view.extent
    }

    /// Bytes read and written by the passes that are timed; None where one of them cannot tell.
    pub fn traffic_bytes(&self) -> [Option<u64>; 2] {
        let passes = || self.passes.iter().map(|index| self.renderer.passes()[*index].traffic);
        [passes().map(|pass| pass.read_bytes).sum(), passes().map(|pass| pass.written_bytes).sum()]
    }

    /// Bytes that the stage leaves, whatever it wrote on the way for passes of its own: of a copy, what is copied.
    pub fn result_bytes(&self) -> u64 {
        let (plan, last) = (&self.renderer.plan, *self.passes.last().expect("at least one pass"));
        let touches = |pass: usize, resource: usize| {
            plan.passes[pass].touches.iter().filter(move |touch| touch.resource == resource)
        };
        let is_left = |resource: &usize| {
            let touched = |writes| {
                self.passes.iter().any(|pass| touches(*pass, *resource).any(|touch| touch.access.writes() == writes))
            };
            let mut behind = last + 1..plan.passes.len();
            let is_used = behind.any(|pass| touches(pass, *resource).next().is_some());
            // What nothing reads is left too: colour in sub-buffers that are shaded without it.
            touched(true) && (is_used || !touched(false) || plan.resources[*resource].read_back)
        };
        (0..plan.resources.len()).filter(is_left).map(|resource| plan.resources[resource].bytes()).sum()
    }

    /// Errors: its threads shade another number of texels than `--texels` of `values` says (exit code 2).
    pub fn require_texels(&self, values: &Values) -> Result<()> {
        let (asked, used) = (values.text("texels"), self.renderer.resolved.get("texels").map(String::as_str));
        if used == Some(asked) {
            return Ok(());
        }
        let used = used.unwrap_or("an unknown number");
        Err(Error::request(format!("--fair --texels {asked}: a thread shades {used} of these texels")))
    }
}

impl Probe for Variant {
    /// Whole frames are one part, frames of a sequence have those of `FrameParts`. A stage has a part for each of its passes; the frame runs through the last of them,
    /// so that each finds its inputs, and the caches, as a frame leaves them.
    fn measure(&self) -> Result<Vec<f64>> {
        if let Some(sequence) = &self.sequence {
            return sequence.measure();
        }
        let milliseconds = |ns: u64| ns as f64 / 1e6;
        if self.stage.is_none() {
            return Ok(vec![milliseconds(self.renderer.frame()?.figure_ns(self.renderer.clock()))]);
        }
        let last = self.passes.last().expect("at least one pass");
        let frame = self.renderer.frame_first(last + 1)?;
        let clock = self.renderer.clock();
        let time =
            |index: &usize| frame.passes[*index].figure_ns(clock).expect("a submit a pass has a wall time a pass");
        Ok(self.passes.iter().map(time).map(milliseconds).collect())
    }
}
