//! Whether a plan fits into `--memory-budget`.

use super::driver::{Driver, Plans};
use super::placed::{Copies, rehearse};
use super::trials::Trials;
use crate::bvh::LazyBvh;
use crate::error::{ErrorKind, Result};
use crate::job::Job;
use crate::scene::Scene;
use crate::units::Bytes;

/// Errors: what is planned does not fit (exit code 4), with how much it takes and a budget that is enough.
pub fn require_fitting(
    plans: &Plans,
    job: &Job,
    scene: Scene,
    bvh: &LazyBvh,
    driver: Driver<'_>,
    budget_bytes: u64,
) -> Result<()> {
    let refused = match rehearse(plans, job, driver, budget_bytes, Copies::Scene) {
        Err(error) if error.kind() == ErrorKind::Memory => error,
        done => return done.map(drop),
    };
    let needed_bytes = rehearse(plans, job, driver, u64::MAX, Copies::Scene)?;
    let (needed, over) = (Bytes(needed_bytes), Bytes(needed_bytes.saturating_sub(budget_bytes)));
    let refused = refused.note(format!("the whole plan takes {needed} of memory blocks, {over} more than the budget"));
    // Textures that a larger budget leaves finer take more.
    let enough = Trials::new(job, scene, bvh, driver).enough(needed_bytes.max(budget_bytes))?;
    Err(match enough {
        None => refused,
        Some((mebibytes, _)) => {
            refused.note(format!("--memory-budget {mebibytes}MiB is enough; a smaller --size would need less"))
        }
    })
}
