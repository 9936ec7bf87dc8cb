//! The memory of a job without making its picture: planned, from a known driver's rules and no device at all; or made,
//! from the ledger of a device that holds every resource of a frame.

mod budget;

use crate::bvh::LazyBvh;
use crate::error::Result;
use crate::frame::View;
use crate::gpu::Caps;
use crate::gpu::commands::Submits;
use crate::job::{Job, judge};
use crate::lights::LightSet;
use crate::memory::kinds::Kinds;
use crate::plan::{Plan, Requirements, Sharing};
use crate::report::memory::MemoryTable;
use crate::resident::SceneStats;
use crate::scene::Scene;
use crate::session::frame_plan;
use crate::techniques::Inputs;

/// A table, and what it is of.
pub struct Study {
    /// Name of the device, or of the driver whose rules were applied.
    pub device: String,
    pub scene: String,
    pub table: MemoryTable,
    /// Whether what is planned fits into `--memory-budget`; a caller prints first and fails then (exit code 4).
    pub budget: Result<()>,
}

/// The plan of `job` under `caps`, by arithmetic.
///
/// Errors: impossible settings or a broken scene (exit code 2); caps that do not say how the driver rounds sizes (2).
pub fn planned(job: &Job, caps_name: &str, caps: &Caps) -> Result<Study> {
    job.require_read()?;
    let scene = job.with_texture_limit(job.load_scene()?, caps);
    let name = scene.name.clone();
    let bvh = LazyBvh::default();
    let plans = Plans::new(job, &scene, &bvh, caps)?;
    let Plans { scene: kept, frame, sharing } = &plans;
    let table = MemoryTable::new(kept, frame, sharing.clone(), requirements(caps), &Kinds::new(caps), None)?;
    let budget = match job.values.bytes("memory-budget") {
        None => Ok(()),
        Some(budget_bytes) => budget::judge(&plans, job, scene, &bvh, caps, budget_bytes),
    };
    Ok(Study { device: caps_name.to_owned(), scene: name, table, budget })
}

/// Who answers for a known driver.
fn requirements(caps: &Caps) -> Requirements<'_> {
    Requirements::Rules(caps.layout.as_ref().expect("known drivers say how they round"))
}

/// What a job needs under a known driver's rules.
struct Plans {
    /// Kept with the scene.
    scene: Plan,
    frame: Plan,
    sharing: Sharing,
}

impl Plans {
    /// Errors: as `planned`.
    fn new(job: &Job, scene: &Scene, bvh: &LazyBvh, caps: &Caps) -> Result<Self> {
        let view = View::new(scene, job.values.text("camera"), job.values.extent("size"))?;
        let lights = LightSet::new(scene, &view, &job.values)?;
        let stats = SceneStats::of(scene);
        let requirements = requirements(caps);
        let inputs =
            Inputs { caps, requirements, scene, stats: &stats, bvh, view: &view, lights: &lights, values: &job.values };
        let frame = frame_plan(job.technique, &inputs, &job.aovs)?;
        let sharing = Sharing::of(&frame, requirements, caps, &job.values);
        Ok(Self { scene: stats.plan(), frame, sharing })
    }
}

/// Every resource of `job` made on its device; no frame is rendered.
///
/// Errors: impossible settings or a broken scene (exit code 2), no device (3), memory (4).
pub fn made(job: &Job) -> Result<Study> {
    job.require_read()?;
    let session = job.open_session(&job.device_request(), job.load_scene()?)?;
    let renderer = session.renderer(job.technique, &job.values, &job.aovs, Submits::One)?;
    let snapshot = session.gpu.memory.snapshot();
    let table = session.memory_table(&renderer, Some(&snapshot))?;
    let device = session.gpu.caps.identity.name.clone();
    let study = Study { device, scene: session.scene.name.clone(), table, budget: Ok(()) };
    let log = session.gpu.validation_log();
    drop((renderer, session));
    judge(log.as_deref())?;
    Ok(study)
}
