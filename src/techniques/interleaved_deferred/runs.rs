//! Runs with virtual lights of their own (`--accumulate`): where their walks stand, and what ends them.

use super::vpl_shadow::FindHidden;
use crate::error::Result;
use crate::gpu::{Access, Buffer, upload};
use crate::lights::vpl::{self, Course, Walk};
use crate::techniques::Run;
use crate::techniques::interleaved_deferred::resources::NAME;
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::time::Instant;

/// A picture of more than one run.
pub struct ManyRuns {
    pub count: u32,
    /// The estimated relative error at which they end before.
    pub until_error: Option<f64>,
    /// The walks of each.
    pub walk: Walk,
    /// How far those of the runs so far have come.
    pub course: RefCell<Course>,
    /// Lights that all of them found.
    pub found_count: Cell<u64>,
}

impl ManyRuns {
    /// New lights instead of those of the run before, in `vpls` and for what looks for hidden ones; the first run's walks begin anew.
    /// Its passes, with their nanoseconds.
    ///
    /// Errors: memory for the upload, more draws than can be recorded (exit code 4).
    pub fn begin(&self, run: &Run<'_>, vpls: &Buffer, hidden: Option<&FindHidden>) -> Result<Vec<(String, u64)>> {
        if run.index == 0 {
            self.course.take();
            self.found_count.set(0);
        }
        let bvh = run.bvh.over(run.scene)?;
        let began = Instant::now();
        let found = vpl::walk_on(run.scene, bvh, &run.lights.lights, &self.walk, &mut self.course.borrow_mut());
        self.found_count.set(self.found_count.get() + u64::from(found.found_count));
        let walked = Instant::now();
        upload::buffer(run.gpu, vpls, bytemuck::cast_slice(&found.vpls), Access::ComputeRead | Access::GraphicsRead)?;
        hidden.map_or(Ok(()), |hidden| hidden.begin_run(run, &found.vpls))?;
        let [walk_ns, upload_ns] = [walked - began, walked.elapsed()].map(|time| time.as_nanos() as u64);
        Ok(vec![(format!("{NAME}.vpls"), walk_ns), (format!("{NAME}.vpls.upload"), upload_ns)])
    }

    /// Numbers for the report's `counters`: walks and found lights of all runs.
    pub fn counters(&self) -> BTreeMap<&'static str, f64> {
        BTreeMap::from([
            ("light_walks", self.course.borrow().walk_count() as f64),
            ("vpls_of_all_runs", self.found_count.get() as f64),
        ])
    }
}
