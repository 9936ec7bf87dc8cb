//! What a frame needs: resources by arithmetic, and the passes that touch them.

use super::choices::Choices;
use super::members::Drawing;
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
    plan.image("depth", DEPTH, picture, depth_prepass::FORMAT, Usage::DEPTH_STENCIL_ATTACHMENT);
    plan.image(
        "color",
        DRAWN,
        picture,
        PICTURE_FORMAT,
        Usage::COLOR_ATTACHMENT | Usage::TRANSFER_SRC | combine::usage(way),
    );
    moment::plan(&mut plan, choices, inputs);
    table::plan(&mut plan, members);
    combine::plan(&mut plan, frame);
    if let Some(slices) = slices {
        slices.plan(&mut plan, members);
    }
    if way == Drawing::Tuples {
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
