//! What a frame needs: resources by arithmetic, and the passes that touch them.

use super::choices::{Choices, ComponentChoice};
use super::resources::{COLOR, FILTERED, IRRADIANCE, NAME, of_component};
use crate::error::Result;
use crate::gpu::Access;
use crate::gpu::shader::structs::{BinsBlock, BvhNodeBlock, BvhTriangleBlock, LightBlock};
use crate::memory::kinds::Use;
use crate::passes::filter::discontinuity;
use crate::passes::gbuffer;
use crate::plan::{Plan, Shape};
use crate::techniques::Inputs;
use ash::vk;

/// Bytes of a pixel's estimate: the sum of its iterations, and what guides.
const ESTIMATE_BYTES: u64 = 16;
/// Bytes of a pixel's irradiance.
pub const IRRADIANCE_BYTES: u64 = 8;

/// Resources and passes of a frame.
pub fn plan(choices: &Choices, inputs: &Inputs<'_>) -> Result<Plan> {
    let (extent, has_emissive, position) = (choices.extent, inputs.stats.has_emissive, choices.position);
    let texels = extent.pixel_count() * choices.components.len() as u64;
    let tree = inputs.bvh.over(inputs.scene)?;
    let of = |count: usize, size: usize| count as u64 * size as u64;
    let mut plan = Plan::default();
    gbuffer::plan(&mut plan, NAME, extent, position, has_emissive);
    plan.buffer("bvh", format!("{NAME}.bvh.nodes"), of(tree.nodes.len(), size_of::<BvhNodeBlock>()));
    plan.buffer("bvh", format!("{NAME}.bvh.triangles"), of(tree.triangles.len(), size_of::<BvhTriangleBlock>()));
    plan.buffer("irradiance", IRRADIANCE, texels * IRRADIANCE_BYTES);
    plan.pass(format!("{NAME}.gbuffer"), gbuffer::written(NAME, position, has_emissive));
    for choice in &choices.components {
        plan_component(&mut plan, choices, choice);
    }
    let mut composed = gbuffer::shading(NAME, position, has_emissive);
    if choices.is_filtered() {
        discontinuity::plan(&mut plan, NAME, extent.pixel_count(), position);
        plan.buffer("filter", FILTERED, texels * IRRADIANCE_BYTES);
        let read = [IRRADIANCE.to_owned(), discontinuity::flags(NAME)].map(|name| (name, Access::ComputeRead));
        plan.pass(format!("{NAME}.filter"), read.into_iter().chain([(FILTERED.to_owned(), Access::ComputeWrite)]));
        composed.push((FILTERED.to_owned(), Access::ComputeRead));
    } else {
        composed.push((IRRADIANCE.to_owned(), Access::ComputeRead));
    }
    plan.picture(COLOR, extent);
    composed.push((COLOR.to_owned(), Access::ComputeWrite));
    plan.pass(format!("{NAME}.composite"), composed);
    // Counted after the frame.
    for choice in &choices.components {
        for what in ["rays", "guidance"] {
            plan.read_back(&of_component(what, choice.component.name()));
        }
    }
    Ok(plan)
}

/// The buffers of one component, and its passes: all that one dispatch does, or those of the three steps.
fn plan_component(plan: &mut Plan, choices: &Choices, choice: &ComponentChoice) {
    use Access::{ComputeRead, ComputeWrite, IndirectRead, TransferWrite};
    let full = |what: &str| of_component(what, choice.component.name());
    let (pixels, tiles) = (choices.extent.pixel_count(), u64::from(choice.params.tile_count));
    plan.buffer("samples", full("sources"), choice.count.source_bytes);
    plan.buffer("lights", full("lights"), u64::from(choice.count.lights) * size_of::<LightBlock>() as u64);
    plan.buffer("counters", full("rays"), pixels * 4);
    let surface = gbuffer::surface(NAME, choices.position);
    let written = [(full("rays"), ComputeWrite), (IRRADIANCE.to_owned(), ComputeWrite)];
    let estimated: Vec<_> = surface.into_iter().chain(written).collect();
    if choices.is_fused() {
        plan.buffer("guidance", full("guidance"), tiles * 4);
        plan.pass(full("sample"), estimated.into_iter().chain([(full("guidance"), ComputeWrite)]));
        return;
    }
    plan.buffer("estimates", full("estimates"), pixels * ESTIMATE_BYTES);
    plan.pass(full("sample"), estimated.iter().cloned().chain([(full("estimates"), ComputeWrite)]));
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
    plan.pass(
        full("guide"),
        [
            (full("bins"), TransferWrite),
            (full("estimates"), ComputeRead),
            (full("guidance"), ComputeWrite),
            (full("bins"), ComputeWrite),
        ],
    );
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
    plan.pass(full("refine"), estimated.into_iter().chain(listed).chain([(full("bins"), IndirectRead)]));
}
