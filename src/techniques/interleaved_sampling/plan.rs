//! What a frame needs: resources by arithmetic, and the passes that touch them.

use super::choices::Choices;
use super::{combine, mean, moment};
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
    let (frame, layer) = (inputs.view.extent, members.layer());
    let mut plan = Plan::default();
    forward::plan(&mut plan, NAME, drawing, listed, (inputs.bvh, inputs.scene))?;
    plan.image("depth", DEPTH, layer, depth_prepass::FORMAT, Usage::DEPTH_STENCIL_ATTACHMENT);
    plan.image("color", DRAWN, layer, PICTURE_FORMAT, Usage::COLOR_ATTACHMENT | Usage::STORAGE);
    moment::plan(&mut plan, choices, inputs);
    combine::plan(&mut plan, members, frame);
    if let Some(slices) = slices {
        slices.plan(&mut plan, members);
    }
    forward::plan_passes(&mut plan, NAME, drawing, inputs.stats.has_blend, [DEPTH, DRAWN]);
    if let Some(slices) = slices {
        slices.plan_pass(&mut plan);
    }
    combine::plan_pass(&mut plan);
    mean::plan(&mut plan, members, frame);
    // Counted after the frame.
    plan.read_back(super::resources::SUMS);
    Ok(plan)
}
