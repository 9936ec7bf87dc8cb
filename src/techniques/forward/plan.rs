//! What a frame needs: resources by arithmetic, and the passes that touch them.

use crate::error::Result;
use crate::gpu::Access;
use crate::lights::object_lists::ObjectLists;
use crate::memory::kinds::Use;
use crate::passes::{accumulate, blend, depth_prepass, direct, resolve};
use crate::plan::{PICTURE_FORMAT, Plan, Shape};
use crate::techniques::Inputs;
use crate::techniques::forward::choices::Choices;
use crate::techniques::forward::resources::{DEPTH, DRAWN, LISTS, NAME, RESOLVED, UNIFORM, UNIFORM_BYTES, VPLS};
use ash::vk::{BufferUsageFlags, ImageUsageFlags as Usage};

/// Resources and passes of a frame.
pub fn plan(choices: &Choices, inputs: &Inputs<'_>, lists: &ObjectLists) -> Result<Plan> {
    let Choices { samples, runs_per_side, has_prepass, .. } = *choices;
    let extent = inputs.view.extent;
    let (is_resolved, is_mean) = (samples > 1, runs_per_side > 1);
    let mut plan = Plan::default();
    let tree = choices.direct.tree(inputs.bvh, inputs.scene)?;
    direct::plan(&mut plan, NAME, inputs.lights.lights.len(), tree);
    plan.buffer("lights", LISTS, 4 * lists.entries.len() as u64);
    plan.buffer("lights", VPLS, 0);
    if choices.is_uniform {
        let flags =
            BufferUsageFlags::UNIFORM_BUFFER | BufferUsageFlags::STORAGE_BUFFER | BufferUsageFlags::TRANSFER_DST;
        plan.push("lights", UNIFORM, Shape::Buffer { bytes: UNIFORM_BYTES, flags, usage: Use::Device });
    }
    // Images of several samples are only attached.
    let read = |usage: Usage| if is_resolved { Usage::empty() } else { usage };
    let usage = Usage::DEPTH_STENCIL_ATTACHMENT | read(Usage::TRANSFER_SRC);
    plan.multisampled("depth", DEPTH, extent, depth_prepass::FORMAT, samples, usage);
    let plain = Usage::COLOR_ATTACHMENT | Usage::STORAGE;
    match (is_resolved, is_mean) {
        (false, false) => plan.picture(DRAWN, extent),
        (false, true) => plan.image("color", DRAWN, extent, PICTURE_FORMAT, plain),
        (true, _) => plan.multisampled("color", DRAWN, extent, PICTURE_FORMAT, samples, Usage::COLOR_ATTACHMENT),
    }
    match (is_resolved, is_mean) {
        (false, _) => {}
        (true, false) => plan.picture(RESOLVED, extent),
        (true, true) => plan.image("color", RESOLVED, extent, PICTURE_FORMAT, plain),
    }
    if is_mean {
        accumulate::plan(&mut plan, NAME, extent);
    }
    let full = |pass: &str| format!("{NAME}.{pass}");
    let touch = |name: &str, access| (name.to_owned(), access);
    if let Some(maps) = &choices.maps {
        maps.plan(&mut plan, NAME);
    }
    let asked = || choices.maps.iter().filter_map(|maps| maps.read(NAME));
    if has_prepass {
        plan.pass(depth_prepass::pass(NAME), [touch(DEPTH, Access::DepthWrite)]);
    }
    let drawn = [touch(DEPTH, depth_prepass::access(has_prepass)), touch(DRAWN, Access::ColorWrite)];
    plan.pass(full("material"), drawn.into_iter().chain(asked()));
    if inputs.stats.has_blend {
        plan.pass(full("blend"), blend::touches(DEPTH, DRAWN).into_iter().chain(asked()));
    }
    if is_resolved {
        plan.pass(full("resolve"), resolve::touches(DRAWN, RESOLVED));
    }
    if is_mean {
        let run = if is_resolved { RESOLVED } else { DRAWN };
        accumulate::plan_pass(&mut plan, NAME, run);
    }
    Ok(plan)
}
