//! What a frame needs: resources by arithmetic, and the passes that touch them.

use super::choices::Choices;
use super::{combine, mask, mean, moment, table};
use crate::error::Result;
use crate::passes::forward::ListedLights;
use crate::passes::{depth_prepass, forward};
use crate::plan::{PICTURE_FORMAT, Plan};
use crate::techniques::Inputs;
use crate::techniques::interleaved_sampling::resources::{DEPTH, DRAWN, NAME};
use ash::vk::ImageUsageFlags as Usage;

/// Resources and passes of a run, which is a member.
pub fn plan(choices: &Choices, inputs: &Inputs<'_>, listed: &ListedLights) -> Result<Plan> {
    let Choices { drawing, members, slices, .. } = choices;
    let (frame, picture, way) = (inputs.view.extent, members.picture(), members.drawing());
    let mut plan = Plan::default();
    forward::plan(&mut plan, NAME, drawing, listed, (inputs.bvh, inputs.scene))?;
    let samples = drawing.samples.count;
    plan.multisampled("depth", DEPTH, picture, depth_prepass::FORMAT, samples, Usage::DEPTH_STENCIL_ATTACHMENT);
    if drawing.samples.are_placed {
        plan.place_samples(DEPTH);
    }
    // The host cannot read several samples.
    let read = if drawing.samples.are_many() { Usage::empty() } else { Usage::TRANSFER_SRC };
    let usage = Usage::COLOR_ATTACHMENT | read | combine::usage(way);
    plan.multisampled("color", DRAWN, picture, PICTURE_FORMAT, samples, usage);
    moment::plan(&mut plan, choices, inputs);
    table::plan(&mut plan, members);
    combine::plan(&mut plan, frame);
    if let Some(slices) = slices {
        slices.plan(&mut plan, members);
    }
    if way.is_over_frame() {
        mask::plan_pass(&mut plan);
    }
    forward::plan_passes(&mut plan, NAME, drawing, inputs.stats.has_blend, [DEPTH, DRAWN]);
    if let Some(slices) = slices {
        slices.plan_pass(&mut plan);
    }
    combine::plan_pass(&mut plan, way);
    mean::plan(&mut plan, members, frame);
    Ok(plan)
}
