//! A plan placed as a device places it, in its order and under its strategy. Heaps do not count.

use crate::error::Result;
use crate::gpu::upload;
use crate::job::Job;
use crate::memory::kinds::{Kinds, Use};
use crate::memory::pool::Rules;
use crate::memory::rehearsal::Rehearsal;
use crate::memory::{Request, Tiling};
use crate::plan::{Plan, Planned, Requirement, Shape};
use crate::settings::Values;
use crate::study::driver::{Driver, Plans};
use ash::vk;

/// What is on its way between host and device beside the resources themselves.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Copies {
    /// To the scene's resources, which the host always fills.
    Scene,
    /// To every resource that the host may fill, and from those that are read back: what a render needs at most.
    All,
}

/// Places everything; the greatest sum of memory blocks, bytes.
///
/// Errors: the budget is spent (exit code 4).
pub fn rehearse(plans: &Plans, job: &Job, driver: Driver<'_>, budget_bytes: u64, copies: Copies) -> Result<u64> {
    let strategy = job.values.choice("allocation");
    let Driver { caps, requirements } = driver;
    let endless = caps.with_endless_heaps();
    let kinds = Kinds::new(caps);
    let block_bytes = job.values.unless_auto("memory-block", Values::power_of_bytes);
    let rules = Rules::new(&endless, strategy, Some(budget_bytes), block_bytes);
    let mut rehearsal = Rehearsal::new(rules, &kinds);
    let Plans { scene, frame, sharing, .. } = plans;
    let own = |planned: &Planned, shape: &Shape, name: &str, rehearse: &mut dyn FnMut(&Request<'_>) -> Result<()>| {
        let required = requirements.of(shape);
        rehearse(&Request {
            name,
            group: planned.group,
            bytes: planned.bytes(),
            requirements: vulkan(required),
            usage: shape.usage(),
            tiling: required.tiling,
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
    let Requirement { bound_bytes: size, alignment_bytes: alignment, memory_type_bits, .. } = requirement;
    vk::MemoryRequirements { size, alignment, memory_type_bits }
}
