//! A variant made real: a renderer, and which of its passes are timed.

use super::rounds::Probe;
use super::what::What;
use crate::error::{Error, Result};
use crate::session::{Renderer, Session};
use crate::settings::Values;
use crate::techniques::Technique;
use crate::units::Extent;

/// A renderer whose frame, or whose stage, is timed.
pub struct Variant {
    pub renderer: Renderer,
    /// Indices of the passes that are timed, in order, at least one.
    pub stage: Vec<usize>,
    /// What it holds in device memory, with the padding that the driver asks for.
    pub bound_bytes: u64,
    what: What,
}

impl Variant {
    /// Makes the renderer; no frame runs.
    ///
    /// Errors: impossible settings, or settings that leave the stage out (exit code 2); memory (4).
    pub fn new(session: &Session, technique: &dyn Technique, what: What, values: &Values) -> Result<Self> {
        let before = session.gpu.memory.snapshot().bound_bytes();
        let renderer = session.renderer(technique, values, &[], what.submits())?;
        let bound_bytes = session.gpu.memory.snapshot().bound_bytes() - before;
        let stage = what.passes(technique.name(), renderer.passes());
        if stage.is_empty() || what.is_fused(values) {
            return Err(Error::request(what.absence(technique.name(), values)));
        }
        Ok(Self { renderer, stage, bound_bytes, what })
    }

    pub fn extent(&self) -> Extent {
        self.renderer.view.extent
    }

    /// Bytes read and written by the passes that are timed.
    pub fn traffic_bytes(&self) -> [u64; 2] {
        let passes = self.stage.iter().map(|index| self.renderer.passes()[*index].traffic);
        passes.fold([0, 0], |[read, written], pass| [read + pass.read_bytes, written + pass.written_bytes])
    }

    /// Bytes that its last pass leaves: of a copy in several passes, the copy alone.
    pub fn result_bytes(&self) -> u64 {
        self.renderer.passes()[*self.stage.last().expect("at least one pass")].traffic.written_bytes
    }
}

impl Probe for Variant {
    /// Whole frames are one part. A stage has a part for each of its passes; the frame runs through the last of them,
    /// so that each finds its inputs, and the caches, as a frame leaves them.
    fn measure(&self) -> Result<Vec<f64>> {
        let milliseconds = |ns: u64| ns as f64 / 1e6;
        if self.what == What::Frame {
            return Ok(vec![milliseconds(self.renderer.frame()?.wall_ns)]);
        }
        let last = self.stage.last().expect("at least one pass");
        let frame = self.renderer.frame_first(last + 1)?;
        let wall = |index: &usize| frame.passes[*index].wall_ns.expect("a submit a pass has a wall time a pass");
        Ok(self.stage.iter().map(wall).map(milliseconds).collect())
    }
}
