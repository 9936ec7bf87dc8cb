//! What a frame needs: resources by arithmetic, and the passes that touch them.

use super::NAME;
use super::choices::{Choices, Filter};
use super::discontinuity;
use super::roads;
use super::shade;
use crate::error::Result;
use crate::gpu::Access;
use crate::lights::cull;
use crate::passes::direct;
use crate::passes::{blend, gbuffer};
use crate::plan::Plan;
use crate::techniques::Inputs;
use crate::units::Extent;
use ash::vk;

/// Full name of a resource of this technique.
fn full(what: &str) -> String {
    format!("{NAME}.{what}")
}

/// Resources and passes of a frame.
pub fn plan(choices: &Choices, inputs: &Inputs<'_>) -> Result<Plan> {
    let Choices { shading, mapping, .. } = choices;
    let (extent, has_emissive) = (inputs.view.extent, inputs.stats.has_emissive);
    let mut plan = Plan::default();
    gbuffer::plan(&mut plan, NAME, extent, shading.position, has_emissive);
    let tree = shading.tree(inputs.bvh, inputs.scene)?;
    direct::plan(&mut plan, NAME, choices.direct_count as usize, shading, tree, extent);
    shade::plan(&mut plan, choices.vpl_count, choices.joined_count(), choices.subset_count());
    plan.picture(full("composite.color"), extent);
    plan.pass(full("gbuffer"), gbuffer::written(NAME, shading.position, has_emissive));
    let masks = shading.culls(choices.direct_count as usize).then_some(NAME);
    if masks.is_some() {
        let written = cull::masks(NAME, Access::ComputeWrite);
        plan.pass(full("cull"), gbuffer::surface(NAME, shading.position).into_iter().chain([written]));
    }
    let gathered = roads::plan(&mut plan, choices);
    let irradiance = filter(&mut plan, choices, gathered, extent, mapping.frame_texel_count());
    let mut composed = gbuffer::shading(NAME, shading.position, has_emissive);
    composed.extend(masks.map(|technique| cull::masks(technique, Access::ComputeRead)));
    composed.extend([(irradiance, Access::ComputeRead), (full("composite.color"), Access::ComputeWrite)]);
    plan.pass(full("composite"), composed);
    if inputs.stats.has_blend {
        plan.pass(full("blend"), blend::touches(NAME, &full("composite.color")));
    }
    Ok(plan)
}

/// Discontinuities and the filter; returns the name of what the composite reads.
fn filter(plan: &mut Plan, choices: &Choices, source: String, extent: Extent, texel_count: u64) -> String {
    if choices.filter == Filter::None {
        return source;
    }
    let (flags, target) = (full("discontinuity.flags"), full("filter.irradiance"));
    let (read, written, sampled) = (Access::ComputeRead, Access::ComputeWrite, Access::ComputeSample);
    discontinuity::plan(plan, &choices.mapping);
    let surface = gbuffer::surface(NAME, choices.shading.position);
    plan.pass(full("discontinuity"), surface.into_iter().chain([(flags.clone(), written)]));
    let mut touches = vec![(source, read), (flags, read), (target.clone(), written)];
    plan.buffer("filter", &target, texel_count * 8);
    let (packed, horizontal) = (full("filter.packed"), full("filter.horizontal"));
    if choices.filter == Filter::GaussFast {
        for image in [&packed, &horizontal] {
            filter_image(plan, image, extent);
            touches.extend([(image.clone(), written), (image.clone(), sampled)]);
        }
    } else {
        plan.buffer("filter", &horizontal, texel_count * 8);
        touches.extend([(horizontal.clone(), written), (horizontal, read)]);
    }
    plan.pass(full("filter"), touches);
    target
}

fn filter_image(plan: &mut Plan, name: &str, extent: Extent) {
    let usage = vk::ImageUsageFlags::STORAGE | vk::ImageUsageFlags::SAMPLED;
    plan.image("filter", name, extent, vk::Format::R16G16B16A16_SFLOAT, usage);
}
