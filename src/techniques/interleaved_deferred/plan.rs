//! What a frame needs: resources by arithmetic, and the passes that touch them.

use super::accumulate;
use super::choices::Choices;
use super::filter;
use super::shade;
use super::split_passes;
use super::vpl_shadow;
use crate::error::Result;
use crate::gpu::Access;
use crate::lights::object_lists::ObjectLists;
use crate::passes::{blend, cull, direct, gbuffer};
use crate::plan::Plan;
use crate::techniques::Inputs;
use crate::techniques::interleaved_deferred::resources::NAME;

/// Full name of a resource of this technique.
fn full(what: &str) -> String {
    format!("{NAME}.{what}")
}

/// What memory has beside the scene and all that a frame needs but virtual lights' shadow maps.
pub fn room_bytes(choices: &Choices, inputs: &Inputs<'_>, blended: &ObjectLists) -> Result<u64> {
    let budget_bytes = inputs.caps.budget_bytes(inputs.values.bytes("memory-budget"));
    let others = plan(&Choices { vpl_maps: None, ..choices.clone() }, inputs, blended)?.bytes();
    Ok(budget_bytes.saturating_sub(inputs.stats.plan().bytes()).saturating_sub(others))
}

/// Resources and passes of a frame.
pub fn plan(choices: &Choices, inputs: &Inputs<'_>, blended: &ObjectLists) -> Result<Plan> {
    let shading = &choices.shading;
    let (extent, has_emissive) = (inputs.view.extent, inputs.stats.has_emissive);
    let mut plan = Plan::default();
    gbuffer::plan(&mut plan, NAME, extent, shading.position, has_emissive);
    let tree = choices.tree(inputs)?;
    direct::plan_with_masks(&mut plan, NAME, choices.direct_count as usize, shading, tree, extent);
    shade::plan(&mut plan, choices.vpl_count, choices.joined_count(), choices.subset_count());
    plan.picture(full("composite.color"), extent);
    plan.pass(full("gbuffer"), gbuffer::written(NAME, shading.position, has_emissive));
    if choices.run_count > 1 {
        gbuffer::keep(&mut plan, NAME, shading.position, has_emissive);
    }
    let masks = shading.culls(choices.direct_count as usize).then_some(NAME);
    if masks.is_some() {
        let written = cull::masks(NAME, Access::ComputeWrite);
        let kept = (choices.run_count > 1).then(|| written.0.clone());
        plan.pass(full("cull"), gbuffer::surface(NAME, shading.position).into_iter().chain([written]));
        kept.iter().for_each(|masks| plan.keep(masks));
    }
    split_passes::plan_split(&mut plan, choices);
    vpl_shadow::plan(&mut plan, choices);
    filter::plan_before_gather(&mut plan, choices);
    let gathered = split_passes::plan(&mut plan, choices);
    let has_blend = inputs.stats.has_blend;
    let blends = |plan: &mut Plan, into: &str| {
        plan.pass(full("blend"), blend::touches(&gbuffer::depth(NAME), into));
    };
    accumulate::plan_resources(&mut plan, choices, has_blend);
    if has_blend {
        blend::plan_lists(&mut plan, NAME, blended);
        if choices.run_count > 1 {
            blends(&mut plan, accumulate::LAYER);
        }
    }
    accumulate::plan_mean(&mut plan, choices, has_blend, &gathered);
    let filtered = filter::plan(&mut plan, choices, gathered);
    let mut composed = gbuffer::shading(NAME, shading.position, has_emissive);
    composed.extend(masks.map(|technique| cull::masks(technique, Access::ComputeRead)));
    composed.extend(filtered.into_iter().map(|buffer| (buffer, Access::ComputeRead)));
    composed.push((full("composite.color"), Access::ComputeWrite));
    plan.pass(full("composite"), composed);
    match (has_blend, choices.run_count) {
        (false, _) => {}
        (true, 1) => blends(&mut plan, &full("composite.color")),
        (true, _) => accumulate::plan_over(&mut plan, &full("composite.color")),
    }
    Ok(plan)
}
