//! Whether a plan fits into `--memory-budget`: its resources placed as a device places them, in its order and under its
//! strategy. Heaps do not count: those of a known driver are those of the machine that it was measured on.

use crate::bvh::LazyBvh;
use crate::error::{Error, ErrorKind, Result};
use crate::gpu::upload;
use crate::job::Job;
use crate::memory::kinds::{Kinds, Use};
use crate::memory::pool::Rules;
use crate::memory::rehearsal::Rehearsal;
use crate::memory::{Request, Tiling};
use crate::plan::{Plan, Planned, Requirement, Shape};
use crate::scene::Scene;
use crate::study::driver::{Driver, Plans};
use crate::units::Bytes;
use ash::vk;

/// Budgets in search of one that is enough: each at most an eighth larger than the one before, and four times the first is.
const MOST_TRIES: usize = 16;
const MIB: u64 = 1 << 20;

/// What is on its way between host and device beside the resources themselves.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Copies {
    /// To the scene's resources, which the host always fills.
    Scene,
    /// To every resource that the host may fill, and from those that are read back: what a render needs at most.
    All,
}

/// Errors: what is planned does not fit (exit code 4), with how much it takes and a budget that is enough.
pub fn require_fitting(
    plans: &Plans,
    job: &Job,
    mut scene: Scene,
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
    let mut enough_bytes = needed_bytes.max(budget_bytes).next_multiple_of(MIB);
    for _ in 0..MOST_TRIES {
        let text = format!("{}MiB", enough_bytes / MIB);
        let mut larger = job.at(&job.values);
        larger.aovs = job.aovs.clone();
        larger.set("memory-budget", &text)?;
        // Textures that a larger budget leaves finer take more.
        scene = larger.with_texturing(scene, driver.caps);
        let plans = Plans::new(&larger, &scene, bvh, driver)?;
        if rehearse(&plans, &larger, driver, enough_bytes, Copies::All).is_ok() {
            return Err(advised(refused, &text));
        }
        enough_bytes = (enough_bytes + enough_bytes / 8).next_multiple_of(MIB);
    }
    Err(refused)
}

fn advised(refused: Error, enough: &str) -> Error {
    refused.note(format!("--memory-budget {enough} is enough; a smaller --size would need less"))
}

/// Places everything; the greatest sum of memory blocks, bytes.
///
/// Errors: the budget is spent (exit code 4).
pub(super) fn rehearse(plans: &Plans, job: &Job, driver: Driver<'_>, budget_bytes: u64, copies: Copies) -> Result<u64> {
    let strategy = job.values.choice("allocation");
    let Driver { caps, requirements } = driver;
    let mut endless = caps.clone();
    endless.heaps.iter_mut().for_each(|heap| heap.bytes = u64::MAX);
    let kinds = Kinds::new(caps);
    let mut rehearsal = Rehearsal::new(Rules::new(&endless, strategy, Some(budget_bytes)), &kinds);
    let Plans { scene, frame, sharing } = plans;
    let own = |planned: &Planned, shape: &Shape, name: &str, rehearse: &mut dyn FnMut(&Request<'_>) -> Result<()>| {
        let tiling = if let Shape::Image(_) = shape { Tiling::Optimal } else { Tiling::Linear };
        rehearse(&Request {
            name,
            group: planned.group,
            bytes: planned.bytes(),
            requirements: vulkan(requirements.of(shape)),
            usage: shape.usage(),
            tiling,
        })
    };
    let copy = |planned: &Planned, usage: Use, rehearsal: &mut Rehearsal<'_>| {
        let flags = if usage == Use::Upload { upload::STAGING } else { vk::BufferUsageFlags::TRANSFER_DST };
        let name = if usage == Use::Upload {
            upload::staging_name(&planned.name)
        } else {
            format!("readback.{}", planned.name)
        };
        let shape = Shape::Buffer { bytes: planned.bytes(), flags, usage };
        own(planned, &shape, &name, &mut |request| rehearsal.pass_by(request))
    };
    let place_all = |plan: &Plan, skipped: &dyn Fn(usize) -> bool, rehearsal: &mut Rehearsal<'_>| {
        let kept = plan.resources.iter().enumerate().filter(|(index, _)| !skipped(*index));
        kept.map(|(_, planned)| planned).try_for_each(|planned| {
            own(planned, &planned.shape, &planned.name, &mut |request| rehearsal.place(request))
        })
    };
    place_all(scene, &|_| false, &mut rehearsal)?;
    scene.resources.iter().try_for_each(|planned| copy(planned, Use::Upload, &mut rehearsal))?;
    for (index, arena) in sharing.arenas.iter().enumerate() {
        rehearsal.place_arena(&Request {
            name: &sharing.arena_name(job.technique.name(), index),
            group: "shared",
            bytes: arena.bytes,
            requirements: vk::MemoryRequirements {
                size: arena.bytes,
                alignment: arena.alignment_bytes,
                memory_type_bits: arena.memory_type_bits,
            },
            usage: Use::Device,
            tiling: Tiling::Linear,
        })?;
    }
    place_all(frame, &|index| sharing.part(index).is_some(), &mut rehearsal)?;
    if copies == Copies::All {
        for (index, planned) in frame.resources.iter().enumerate() {
            // What passes of a run leave for the next one, nobody uploads.
            if !frame.is_transient(index) && !planned.is_kept && planned.shape.usage() == Use::Device {
                copy(planned, Use::Upload, &mut rehearsal)?;
            }
            if planned.read_back {
                copy(planned, Use::Readback, &mut rehearsal)?;
            }
        }
    }
    Ok(rehearsal.most_bytes())
}

fn vulkan(requirement: Requirement) -> vk::MemoryRequirements {
    let Requirement { bound_bytes: size, alignment_bytes: alignment, memory_type_bits } = requirement;
    vk::MemoryRequirements { size, alignment, memory_type_bits }
}
