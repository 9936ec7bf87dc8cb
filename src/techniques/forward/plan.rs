//! What a frame needs: resources by arithmetic, and the passes that touch them.

use crate::error::Result;
use crate::passes::forward::ListedLights;
use crate::passes::{accumulate, depth_prepass, forward, resolve};
use crate::plan::{PICTURE_FORMAT, Plan};
use crate::techniques::Inputs;
use crate::techniques::forward::choices::Choices;
use crate::techniques::forward::resources::{DEPTH, DRAWN, NAME, RESOLVED};
use ash::vk::ImageUsageFlags as Usage;

/// Resources and passes of a frame.
pub fn plan(choices: &Choices, inputs: &Inputs<'_>, listed: &ListedLights) -> Result<Plan> {
    let Choices { drawing, runs_per_side } = choices;
    let (samples, extent) = (drawing.samples, inputs.view.extent);
    let (is_resolved, is_mean) = (samples.are_many(), *runs_per_side > 1);
    let mut plan = Plan::default();
    let of = (inputs.bvh, inputs.scene);
    forward::plan(&mut plan, NAME, drawing, listed, of)?;
    // The host cannot read several samples.
    let read = |usage: Usage| if is_resolved { Usage::empty() } else { usage };
    let usage = Usage::DEPTH_STENCIL_ATTACHMENT | read(Usage::TRANSFER_SRC);
    plan.multisampled("depth", DEPTH, extent, depth_prepass::FORMAT, samples.count, usage);
    let plain = Usage::COLOR_ATTACHMENT | Usage::STORAGE;
    match (is_resolved, is_mean) {
        (false, false) => plan.picture(DRAWN, extent),
        (false, true) => plan.image("color", DRAWN, extent, PICTURE_FORMAT, plain),
        (true, _) => plan.multisampled("color", DRAWN, extent, samples.format, samples.count, resolve::DRAWN),
    }
    match (is_resolved, is_mean) {
        (false, _) => {}
        (true, false) => plan.picture(RESOLVED, extent),
        (true, true) => plan.image("color", RESOLVED, extent, PICTURE_FORMAT, Usage::STORAGE),
    }
    if is_mean {
        accumulate::plan(&mut plan, NAME, extent);
    }
    forward::plan_passes(&mut plan, NAME, drawing, inputs.stats.has_blend, [DEPTH, DRAWN]);
    if is_resolved {
        plan.pass(format!("{NAME}.resolve"), resolve::touches(DRAWN, RESOLVED));
    }
    if is_mean {
        let run = if is_resolved { RESOLVED } else { DRAWN };
        accumulate::plan_pass(&mut plan, NAME, run);
    }
    Ok(plan)
}
