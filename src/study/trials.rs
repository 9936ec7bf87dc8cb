//! A job under other budgets: what it comes to there, and the first of larger ones that is enough.

use super::driver::{Driver, Plans};
use super::placed::{Copies, rehearse};
use crate::bvh::LazyBvh;
use crate::error::{ErrorKind, Result};
use crate::job::Job;
use crate::scene::Scene;
use std::collections::BTreeMap;

/// Budgets in search of one that is enough: each at most an eighth larger than the one before, and four times the first is.
const MOST_TRIES: usize = 16;
pub const MIB: u64 = 1 << 20;

/// A job and its scene, whose textures are coarser or finer as a budget lets them be.
pub struct Trials<'a> {
    job: &'a Job,
    /// There but while a trial has it.
    scene: Option<Scene>,
    bvh: &'a LazyBvh,
    driver: Driver<'a>,
}

/// What fits.
pub struct Fitting {
    /// Bytes of memory blocks, what is on its way between host and device included.
    pub bytes: u64,
    /// What `auto` and the like came to.
    pub resolved: BTreeMap<&'static str, String>,
}

impl<'a> Trials<'a> {
    pub fn new(job: &'a Job, scene: Scene, bvh: &'a LazyBvh, driver: Driver<'a>) -> Self {
        Self { job, scene: Some(scene), bvh, driver }
    }

    /// What the job comes to under `budget`, a text of `--memory-budget`.
    ///
    /// Errors: it does not fit (exit code 4); as `Plans::new`.
    pub fn under(&mut self, budget: &str) -> Result<Fitting> {
        let mut other = self.job.at(&self.job.values);
        other.aovs = self.job.aovs.clone();
        other.set("memory-budget", budget)?;
        let scene = self.scene.take().expect("each trial gives it back");
        let scene = self.scene.insert(other.with_texturing(scene, self.driver.caps));
        let plans = Plans::new(&other, scene, self.bvh, self.driver)?;
        let budget_bytes = other.values.bytes("memory-budget").unwrap_or(u64::MAX);
        let bytes = rehearse(&plans, &other, self.driver, budget_bytes, Copies::All)?;
        let mut resolved = plans.resolved;
        resolved.insert("texture-limit", scene.texturing.limit_px.to_string());
        Ok(Fitting { bytes, resolved })
    }

    /// The first of budgets from `from_bytes` on that is enough, in mebibytes; None: none of those that are tried.
    ///
    /// Errors: as `under`, but that it does not fit.
    pub fn enough(&mut self, from_bytes: u64) -> Result<Option<(u64, Fitting)>> {
        let mut mebibytes = from_bytes.div_ceil(MIB).max(1);
        for _ in 0..MOST_TRIES {
            match self.under(&format!("{mebibytes}MiB")) {
                Ok(fitting) => return Ok(Some((mebibytes, fitting))),
                Err(error) if error.kind() == ErrorKind::Memory => mebibytes += mebibytes.div_ceil(8),
                Err(error) => return Err(error),
            }
        }
        Ok(None)
    }
}
