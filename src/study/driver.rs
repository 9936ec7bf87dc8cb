//! Plans as a driver that is known makes them.

use crate::bvh::LazyBvh;
use crate::caps::Caps;
use crate::error::Result;
use crate::frame::View;
use crate::job::Job;
use crate::lights::LightSet;
use crate::plan::{Plan, Requirements, Sharing};
use crate::resident::SceneStats;
use crate::scene::Scene;
use crate::session::Planned;
use crate::techniques::Inputs;
use std::collections::BTreeMap;

/// A driver that is not there.
#[derive(Clone, Copy)]
pub struct Driver<'a> {
    pub(super) caps: &'a Caps,
    pub(super) requirements: Requirements<'a>,
}

/// What a job needs under a driver's rules.
pub struct Plans {
    /// Kept with the scene.
    pub(super) scene: Plan,
    pub(super) frame: Plan,
    pub(super) sharing: Sharing,
    /// What `auto` and percentages of its settings came to.
    pub(super) resolved: BTreeMap<&'static str, String>,
}

impl Plans {
    /// Errors: as `planned`.
    pub(super) fn new(job: &Job, scene: &Scene, bvh: &LazyBvh, driver: Driver<'_>) -> Result<Self> {
        with_inputs(job, scene, bvh, driver, |inputs| {
            let Planned { prepared, plan: frame } = Planned::new(job.technique, inputs, &job.aovs)?;
            let resolved = prepared.resolved();
            let sharing = Sharing::of(&frame, driver.requirements, driver.caps, &job.values);
            Ok(Self { scene: inputs.stats.plan(), frame, sharing, resolved })
        })
    }
}

/// Calls `then` with what the plan and the host's part of a technique read.
///
/// Errors: impossible settings (exit code 2); as `then`.
pub fn with_inputs<T>(
    job: &Job,
    scene: &Scene,
    bvh: &LazyBvh,
    Driver { caps, requirements }: Driver<'_>,
    then: impl FnOnce(&Inputs<'_>) -> Result<T>,
) -> Result<T> {
    let view = View::new(scene, job.values.text("camera"), job.values.extent("size"))?;
    let lights = LightSet::new(scene, &view, &job.values)?;
    let stats = SceneStats::of(scene);
    then(&Inputs { caps, requirements, scene, stats: &stats, bvh, view: &view, lights: &lights, values: &job.values })
}
