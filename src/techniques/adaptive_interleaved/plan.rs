//! What a frame needs: resources by arithmetic, and the passes that touch them.

use super::choices::{Choices, ComponentChoice};
use super::resources::{COLOR, FILTERED, IRRADIANCE_BYTES, NAME, NO_VPLS, OWN_GUIDANCE, of_component};
use super::settings::{GuidanceOf, Trace};
use super::{host, smooth};
use crate::error::Result;
use crate::gpu::Access;
use crate::gpu::shader::structs::BinsBlock;
use crate::memory::kinds::Use;
use crate::passes::{blend, direct, gbuffer};
use crate::plan::{Plan, Shape};
use crate::techniques::Inputs;
use ash::vk;

/// Bytes of a texel's estimate: the sum of its iterations, and what guides.
const ESTIMATE_BYTES: u64 = 16;

/// Resources and passes of a frame.
pub fn plan(choices: &Choices, inputs: &Inputs<'_>) -> Result<Plan> {
    let (extent, has_emissive, position) = (choices.extent, inputs.stats.has_emissive, choices.position);
    let mut plan = Plan::default();
    gbuffer::plan(&mut plan, NAME, extent, position, has_emissive);
    direct::plan(&mut plan, NAME, choices.lights.len(), choices.device_tree(inputs)?);
    plan.pass(format!("{NAME}.gbuffer"), gbuffer::written(NAME, position, has_emissive));
    for together in choices.components.chunks(choices.recorded_together()) {
        together.iter().for_each(|choice| plan_initial(&mut plan, choices, choice));
        if choices.has_refinement() {
            together.iter().for_each(|choice| plan_refinement(&mut plan, choices, choice));
        }
    }
    let mut composed = gbuffer::shading(NAME, position, has_emissive);
    smooth::plan(&mut plan, choices);
    plan.picture(COLOR, extent);
    composed.extend([(FILTERED.to_owned(), Access::ComputeRead), (COLOR.to_owned(), Access::ComputeWrite)]);
    plan.pass(format!("{NAME}.composite"), composed);
    if choices.has_blend {
        blend::plan_lists(&mut plan, NAME, &choices.blended);
        // What blended surfaces bind where there are no virtual lights, or none in subsets.
        plan.buffer("lights", NO_VPLS, 0);
        plan.pass(format!("{NAME}.blend"), blend::touches(&gbuffer::depth(NAME), COLOR));
    }
    // Counted after the frame.
    for choice in &choices.components {
        for what in ["rays", "guidance"] {
            plan.read_back(&of_component(what, choice.component.name()));
        }
    }
    Ok(plan)
}

/// The passes of a component's estimate, and what they write.
fn estimated(choices: &Choices, choice: &ComponentChoice) -> Vec<(String, Access)> {
    let full = |what: &str| of_component(what, choice.component.name());
    let written = [full("rays"), full("irradiance")].map(|name| (name, Access::ComputeWrite));
    gbuffer::surface(NAME, choices.position).into_iter().chain(written).collect()
}

/// The buffers of one component, and its passes: what comes from the host, all that one dispatch does, or the initial pass
/// and the guidance.
fn plan_initial(plan: &mut Plan, choices: &Choices, choice: &ComponentChoice) {
    use Access::{ComputeRead, ComputeWrite, TransferWrite};
    let full = |what: &str| of_component(what, choice.component.name());
    let (texels, tiles) = (choice.extent().pixel_count(), u64::from(choice.params.tile_count));
    let has_samples = choices.has_device_samples(choice.component);
    plan.buffer("samples", full("sources"), if has_samples { choice.prepared.count().source_bytes } else { 0 });
    plan.buffer("counters", full("rays"), texels * 4);
    plan.buffer("irradiance", full("irradiance"), texels * IRRADIANCE_BYTES);
    if choices.trace == Trace::Host {
        if choices.is_guided() {
            plan.buffer("guidance", full("guidance"), tiles * 4);
        }
        host::upload::plan(plan, choice, choices.is_guided());
        return;
    }
    let estimated = estimated(choices, choice);
    if choices.is_fused() {
        plan.buffer("guidance", full("guidance"), tiles * 4);
        plan.pass(full("sample"), estimated.into_iter().chain([(full("guidance"), ComputeWrite)]));
        return;
    }
    plan.buffer("estimates", full("estimates"), texels * ESTIMATE_BYTES);
    plan.pass(full("sample"), estimated.into_iter().chain([(full("estimates"), ComputeWrite)]));
    if !choices.has_refinement() {
        return;
    }
    plan.buffer("guidance", full("guidance"), tiles * 4);
    let flags = vk::BufferUsageFlags::INDIRECT_BUFFER
        | vk::BufferUsageFlags::STORAGE_BUFFER
        | vk::BufferUsageFlags::TRANSFER_DST;
    let bytes = size_of::<BinsBlock>() as u64;
    plan.push("guidance", full("bins"), Shape::Buffer { bytes, flags, usage: Use::Device });
    plan.buffer("guidance", full("tiles"), tiles * 4);
    if choices.spreads() {
        plan.buffer("guidance", full(OWN_GUIDANCE), tiles * 4);
    }
    plan.pass(
        full("guide"),
        [
            (full("bins"), TransferWrite),
            (full("estimates"), ComputeRead),
            (if choices.spreads() { full(OWN_GUIDANCE) } else { full("guidance") }, ComputeWrite),
            (full("bins"), ComputeWrite),
        ],
    );
}

/// The passes behind the guidance.
fn plan_refinement(plan: &mut Plan, choices: &Choices, choice: &ComponentChoice) {
    use Access::{ComputeRead, ComputeWrite, IndirectRead, TransferWrite};
    let full = |what: &str| of_component(what, choice.component.name());
    if choices.spreads() {
        let is_read = |other: &&ComponentChoice| {
            choices.guidance_of == GuidanceOf::Components || other.component == choice.component
        };
        let read = choices.components.iter().filter(is_read);
        let read = read.map(|other| (of_component(OWN_GUIDANCE, other.component.name()), ComputeRead));
        let counted = [(full("bins"), TransferWrite), (full("guidance"), ComputeWrite), (full("bins"), ComputeWrite)];
        plan.pass(full("spread"), read.chain(counted));
    }
    plan.pass(
        full("compact"),
        [(full("guidance"), ComputeRead), (full("bins"), ComputeWrite), (full("tiles"), ComputeWrite)],
    );
    let listed = [
        (full("estimates"), ComputeRead),
        (full("guidance"), ComputeRead),
        (full("bins"), ComputeRead),
        (full("tiles"), ComputeRead),
    ];
    plan.pass(
        full("refine"),
        estimated(choices, choice).into_iter().chain(listed).chain([(full("bins"), IndirectRead)]),
    );
}
