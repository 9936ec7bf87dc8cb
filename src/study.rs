//! The memory of a job without making its picture: planned, from a known driver's rules and no device at all; or made,
//! from the ledger of a device that holds every resource of a frame.

use crate::bvh::LazyBvh;
use crate::error::Result;
use crate::frame::View;
use crate::gpu::Caps;
use crate::gpu::commands::Submits;
use crate::job::{Job, judge};
use crate::lights::LightSet;
use crate::memory::kinds::Kinds;
use crate::plan::{Requirements, Sharing};
use crate::report::memory::MemoryTable;
use crate::resident::SceneStats;
use crate::session::frame_plan;
use crate::techniques::Inputs;

/// A table, and what it is of.
pub struct Study {
    /// Name of the device, or of the driver whose rules were applied.
    pub device: String,
    pub scene: String,
    pub table: MemoryTable,
}

/// The plan of `job` under `caps`, by arithmetic.
///
/// Errors: impossible settings or a broken scene (exit code 2); caps that do not say how the driver rounds sizes (2).
pub fn planned(job: &Job, caps_name: &str, caps: &Caps) -> Result<Study> {
    job.require_read()?;
    let scene = job.with_texture_limit(job.load_scene()?, caps);
    let view = View::new(&scene, job.values.text("camera"), job.values.extent("size"))?;
    let lights = LightSet::new(&scene, &view, &job.values)?;
    let stats = SceneStats::of(&scene);
    let bvh = LazyBvh::default();
    let rules = caps.layout.as_ref().expect("known drivers say how they round");
    let requirements = Requirements::Rules(rules);
    let inputs = Inputs {
        caps,
        requirements,
        scene: &scene,
        stats: &stats,
        bvh: &bvh,
        view: &view,
        lights: &lights,
        values: &job.values,
    };
    let frame = frame_plan(job.technique, &inputs, &job.aovs)?;
    let sharing = Sharing::of(&frame, requirements, caps, &job.values);
    let table = MemoryTable::new(&stats.plan(), &frame, sharing, requirements, &Kinds::new(caps), None)?;
    Ok(Study { device: caps_name.to_owned(), scene: scene.name, table })
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
    let study = Study { device, scene: session.scene.name.clone(), table };
    let log = session.gpu.validation_log();
    drop((renderer, session));
    judge(log.as_deref())?;
    Ok(study)
}
