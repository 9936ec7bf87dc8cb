//! The memory of a job without making its picture: planned, from a known driver's rules and no device at all; or made,
//! from the ledger of a device that holds every resource of a frame.

mod budget;
mod driver;
pub mod heaps;
pub mod least;
pub mod page;
mod placed;
mod trials;

use crate::bvh::LazyBvh;
use crate::caps::{Caps, HeapBudget};
use crate::error::{Error, Result};
use crate::gpu::commands::Submits;
use crate::job::{Job, fail_on_validation};
use crate::memory::Tiling;
use crate::memory::kinds::Kinds;
use crate::memory::touched::Touched;
use crate::plan::Requirements;
use crate::report::memory::MemoryTable;
use crate::session::Planned;
use driver::{Driver, Plans, with_inputs};
use std::collections::BTreeMap;

/// A table, and what it is of.
pub struct Study {
    /// Name of the device, or of the driver whose rules were applied.
    pub device: String,
    pub scene: String,
    /// What that device, or that driver, can do.
    pub caps: Caps,
    /// What the driver said of its heaps while everything was there; None where it says nothing, or nothing was made.
    pub driver_heaps: Option<Vec<HeapBudget>>,
    pub table: MemoryTable,
    /// Nobody has measured how the driver rounds sizes, and none are rounded.
    pub is_unrounded: bool,
    /// Whether what is planned fits into `--memory-budget`; a caller prints first and fails then (exit code 4).
    pub budget: Result<()>,
}

/// The plan of `job` under `caps`, by arithmetic.
///
/// Errors: impossible settings or a broken scene (exit code 2); a device of these caps lacks what the settings need (3).
pub fn planned(job: &Job, caps_name: &str, caps: &Caps) -> Result<Study> {
    job.require_read()?;
    let touched: Touched = job.values.choice("touched");
    if touched != Touched::Off {
        let why = format!("--touched {}: a plan touches nothing", touched.name());
        return Err(Error::request(why).note("without --plan it is counted on a device"));
    }
    require_known_tiling(job)?;
    let scene = job.with_texturing(job.load_scene()?, caps);
    let name = scene.name.clone();
    let (bvh, rules) = (LazyBvh::default(), caps.rules());
    let driver = Driver { caps, requirements: Requirements::Rules(&rules) };
    let plans = Plans::new(job, &scene, &bvh, driver)?;
    let Plans { scene: kept, frame, sharing, .. } = &plans;
    let table = MemoryTable::new(kept, frame, sharing.clone(), driver.requirements, &Kinds::new(caps), None)?;
    let budget = match job.values.bytes("memory-budget") {
        None => Ok(()),
        Some(budget_bytes) => budget::require_fitting(&plans, job, scene, &bvh, driver, budget_bytes),
    };
    let is_unrounded = caps.layout.is_none();
    Ok(Study {
        device: caps_name.to_owned(),
        scene: name,
        caps: caps.clone(),
        driver_heaps: None,
        table,
        is_unrounded,
        budget,
    })
}

/// Errors: images lie as no rules know (exit code 2).
fn require_known_tiling(job: &Job) -> Result<()> {
    let tiling: Tiling = job.values.choice("image-tiling");
    if tiling == Tiling::Optimal {
        return Ok(());
    }
    let why = format!(
        "--image-tiling {}: only a device says which images it makes so, and how large they are",
        tiling.name()
    );
    Err(Error::request(why).note("without --plan it is asked"))
}

/// Resolved values under `caps` of the settings of `job` whose text does not say all, such as `auto`: the host's part
/// of a frame is done for it.
///
/// Errors: as `planned`.
pub fn resolved(job: &Job, caps: &Caps) -> Result<BTreeMap<&'static str, String>> {
    let scene = job.with_texturing(job.load_scene()?, caps);
    let (bvh, rules) = (LazyBvh::default(), caps.rules());
    with_inputs(job, &scene, &bvh, Driver { caps, requirements: Requirements::Rules(&rules) }, |inputs| {
        Ok(Planned::new(job.technique, inputs, &job.aovs)?.prepared.resolved())
    })
}

/// Every resource of `job` made on its device; no frame is rendered, except where `--touched` counts one.
///
/// Errors: impossible settings or a broken scene (exit code 2), no device (3), memory (4).
pub fn made(job: &Job) -> Result<Study> {
    job.require_read()?;
    let session = job.open_session(&job.device_request(), job.load_scene()?)?;
    let renderer = session.renderer(job.technique, &job.values, &job.aovs, Submits::One)?;
    let snapshot = session.gpu.memory.snapshot();
    let mut table = session.memory_table(&renderer, Some(&snapshot))?;
    if session.gpu.marks.is_some() {
        renderer.frame()?;
        table = renderer.touched(table)?;
    }
    let device = session.gpu.caps.identity.name.clone();
    let (scene, caps) = (session.scene.name.clone(), session.gpu.caps.clone());
    let driver_heaps = session.gpu.heap_budgets();
    let study = Study { device, scene, caps, driver_heaps, table, is_unrounded: false, budget: Ok(()) };
    let log = session.gpu.validation_log();
    drop((renderer, session));
    fail_on_validation(log.as_deref())?;
    Ok(study)
}
