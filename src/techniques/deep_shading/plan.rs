//! What a frame needs: resources by arithmetic, and the passes that touch them (Clarberg & Munkberg 2014, section 6, lists the
//! groups with their bytes).

use super::baseline;
use super::baseline::texture_space;
use super::choices::Choices;
use super::counters;
use super::lists::direct;
use super::tuples::TupleTable;
use super::visibility::{looped, ray};
use super::{buffer_addresses, entries, indirect, passes, ranges, reconstruct, scales, stereo};
use crate::error::{Error, Result};
use crate::gpu::ImageDescription;
use crate::gpu::shader::structs::{DeepBlock, DrawBlock, FrameBlock, TupleBlock};
use crate::memory::kinds::Use;
use crate::passes::{accumulate, direct as lights};
use crate::plan::{Plan, Shape};
use crate::resident::VertexAttributes;
use crate::techniques::Inputs;
use crate::techniques::deep_shading::modes::shading::Shading;
use crate::techniques::deep_shading::modes::visibility::Visibility;
use crate::techniques::deep_shading::resources::{
    ADDRESS_BYTES, ADDRESSES, BEGIN_BYTES, BEGINS, COLOR, COLOR_BYTES, COLORS, COUNTERS, DEPTH, DEPTH_FORMAT, LENGTHS,
    LINEAR, LINEAR_COUNT, MARKS, NAME, NODE_BYTES, NODES, ROW_ID_BYTES, SHADE_DEPTH, SHADING_DEPTH_FORMAT,
    SHADING_DEPTHS, SPID_FORMAT, SPIDS, ZMAX, full, stored,
};
use ash::vk::{BufferUsageFlags, Format, ImageUsageFlags as Usage};

/// Resources and passes of a frame.
///
/// Errors: the samples of a set need a buffer that the device does not bind (exit code 4, and how many would fit).
pub fn plan(choices: &Choices, inputs: &Inputs<'_>) -> Result<Plan> {
    require_fitting(choices, inputs)?;
    let mut plan = Plan::default();
    plan_scene(&mut plan, choices, inputs)?;
    match choices.shading {
        Shading::Deep => {
            plan_samples(&mut plan, choices, inputs)?;
            plan_deep(&mut plan, choices, inputs);
        }
        Shading::IndirectGbuffer => {
            plan_samples(&mut plan, choices, inputs)?;
            indirect::plan(&mut plan, choices, choices.samples_of(inputs.view.extent));
        }
        Shading::Ssaa | Shading::Msaa { .. } => baseline::plan(&mut plan, choices, inputs.view.extent),
        Shading::TextureSpace(size) => {
            baseline::plan(&mut plan, choices, inputs.view.extent);
            texture_space::plan(&mut plan, size, choices.is_counted, inputs);
        }
    }
    plan.buffer("counters", full(COUNTERS), counters::COUNT * 4);
    plan.read_back(&full(COUNTERS));
    let extent = inputs.view.extent;
    let run = if choices.blur.is_reconstructed { reconstruct::COLOR } else { COLOR };
    if choices.blur.is_reconstructed {
        stored(&mut plan, COLOR, extent);
        reconstruct::plan(&mut plan, choices, extent);
    }
    if matches!(choices.shading, Shading::Deep | Shading::IndirectGbuffer) {
        entries::plan(&mut plan, choices.samples_of(extent), inputs.scene.materials.len());
        ranges::plan(&mut plan, full(ranges::BY_ID), inputs.stats.draw_count);
        if choices.blur_pixels.is_some() {
            scales::plan(&mut plan, inputs.scene.triangle_count());
        }
        buffer_addresses::plan(&mut plan, choices.is_by_address);
    }
    if choices.run_count > 1 {
        stored(&mut plan, run, extent);
        accumulate::plan(&mut plan, NAME, extent);
    } else {
        plan.picture(full(run), extent);
    }
    stereo::plan(&mut plan, choices, extent);
    match choices.shading {
        Shading::Deep | Shading::IndirectGbuffer => passes::plan(&mut plan, choices),
        _ => baseline::plan_passes(&mut plan, choices),
    }
    if choices.run_count > 1 {
        accumulate::plan_pass(&mut plan, NAME, &full(run));
    }
    stereo::plan_pass(&mut plan, choices);
    Ok(plan)
}

/// An image of a layer a tuple.
fn layers(choices: &Choices, inputs: &Inputs<'_>, format: Format, usage: Usage) -> Shape {
    let extent = choices.table.layer(inputs.view.extent);
    let layer_count = Some(choices.table.tuple_count());
    Shape::Image(ImageDescription { layer_count, ..ImageDescription::plain(extent, format, 1, usage) })
}

/// How what samples see comes into images, and is read.
fn attached(choices: &Choices) -> Usage {
    let written = if choices.visibility == Visibility::Ray { Usage::TRANSFER_DST } else { Usage::COLOR_ATTACHMENT };
    written | Usage::SAMPLED | Usage::TRANSFER_SRC
}

/// What samples see.
///
/// Errors: the host would hold too much (exit code 4).
fn plan_samples(plan: &mut Plan, choices: &Choices, inputs: &Inputs<'_>) -> Result<()> {
    if !choices.lists.is_direct {
        plan.push("frame_buffer", full(SPIDS), layers(choices, inputs, SPID_FORMAT, attached(choices)));
    }
    if choices.visibility == Visibility::Ray {
        return ray::plan(plan, choices, inputs);
    }
    if choices.raster.is_looped {
        looped::plan(plan, choices.samples_of(inputs.view.extent), inputs.stats.draw_count);
    } else {
        let depth = layers(choices, inputs, DEPTH_FORMAT, Usage::DEPTH_STENCIL_ATTACHMENT);
        plan.push("frame_buffer", full(DEPTH), depth);
    }
    Ok(())
}

/// Lists, and colours.
fn plan_deep(plan: &mut Plan, choices: &Choices, inputs: &Inputs<'_>) {
    let samples = choices.samples_of(inputs.view.extent);
    let shading_pixels = choices.space.extent.pixel_count();
    plan.buffer("deep_shading_buffer", full(COLORS), samples * COLOR_BYTES);
    if choices.lists.is_direct {
        direct::plan(plan, COLORS, samples * COLOR_BYTES);
    }
    if choices.has_lists {
        let mut list = |group, name: &str, bytes| {
            plan.buffer(group, full(name), bytes);
            if choices.lists.is_direct {
                direct::plan(plan, name, bytes);
            }
        };
        list("deep_shading_buffer", BEGINS, shading_pixels * BEGIN_BYTES);
        list("deep_shading_buffer", NODES, samples * NODE_BYTES);
        if choices.lists.is_compacted {
            list("auxiliary", LINEAR, shading_pixels * LINEAR_COUNT * ROW_ID_BYTES);
        }
        if choices.lists.has_addresses {
            list("auxiliary", ADDRESSES, samples * ADDRESS_BYTES);
        }
        if choices.lists.has_zmax {
            list("auxiliary", ZMAX, shading_pixels * 4);
        }
        if choices.lists.has_marks {
            list("listed_triangles", MARKS, inputs.scene.triangle_count().div_ceil(32) * 4);
        }
        if choices.lists.has_zmax {
            let usage = Usage::DEPTH_STENCIL_ATTACHMENT | Usage::TRANSFER_DST;
            plan.image("shading_depth", full(SHADE_DEPTH), choices.space.extent, DEPTH_FORMAT, usage);
        }
        if choices.lists.has_zmax && !choices.lists.is_direct {
            let depths = layers(choices, inputs, SHADING_DEPTH_FORMAT, attached(choices));
            plan.push("auxiliary", full(SHADING_DEPTHS), depths);
        }
        if choices.lists.is_direct {
            direct::plan(plan, COUNTERS, counters::COUNT * 4);
        }
        if choices.is_counted {
            plan.buffer("counters", full(LENGTHS), shading_pixels * 4);
        }
    }
}

/// Lights, tree, cameras, tuples, and where the scene is when the shutter closes.
fn plan_scene(plan: &mut Plan, choices: &Choices, inputs: &Inputs<'_>) -> Result<()> {
    let tree = choices.direct.tree(inputs.bvh, inputs.scene)?;
    lights::plan(plan, NAME, inputs.lights.lights.len(), tree);
    let tuples = u64::from(choices.table.tuple_count()) * u64::from(choices.run_count);
    plan.buffer("frame", full("tuples"), tuples * size_of::<TupleBlock>() as u64);
    plan.buffer("frame", full("space"), size_of::<DeepBlock>() as u64);
    plan.buffer("frame", full("middle"), size_of::<FrameBlock>() as u64);
    let moving = |count: u64| if inputs.scene.closing.is_some() { count } else { 0 };
    let (vertices, draws) = (moving(inputs.stats.vertex_count), moving(inputs.stats.draw_count));
    plan.buffer("scene.geometry", full("close.positions"), vertices * 12);
    plan.buffer("scene.geometry", full("close.attributes"), vertices * size_of::<VertexAttributes>() as u64);
    plan.buffer("scene.geometry", full("close.draws"), draws * size_of::<DrawBlock>() as u64);
    if choices.blur.is_moving && choices.maps.is_some() {
        plan.buffer("scene.geometry", full("middle.draws"), draws * size_of::<DrawBlock>() as u64);
        let flags = BufferUsageFlags::STORAGE_BUFFER | BufferUsageFlags::VERTEX_BUFFER | BufferUsageFlags::TRANSFER_DST;
        let shape = Shape::Buffer { bytes: vertices * 12, flags, usage: Use::Device };
        plan.push("scene.geometry", full("middle.positions"), shape);
    }
    if let Some(maps) = &choices.maps {
        maps.plan(plan, NAME);
    }
    Ok(())
}

/// Errors: more tuples than layers; buffers out of shaders' reach.
fn require_fitting(choices: &Choices, inputs: &Inputs<'_>) -> Result<()> {
    let (layers, most_layers) = (choices.table.tuple_count(), inputs.caps.limits.max_image_layers);
    let asked = match choices.table {
        TupleTable { eyes: 1, .. } => format!("--tuples {layers}"),
        table => format!("--tuples {} of {} eyes", table.tuples_of_eye(), table.eyes),
    };
    if !matches!(choices.shading, Shading::Msaa { .. }) && layers > most_layers {
        return Err(Error::request(format!("{asked}: this device has images of {most_layers} layers")).within(NAME));
    }
    let most_drawn = inputs.caps.limits.max_framebuffer_layers;
    if choices.visibility.is_layered() && layers > most_drawn {
        return Err(Error::request(format!(
            "--visibility {}, {asked}: this device draws into {most_drawn} layers at once",
            choices.visibility.name()
        ))
        .within(NAME)
        .note("--visibility repeat-frame draws into one"));
    }
    if choices.raster.is_looped {
        looped::require_fitting(choices.samples_of(inputs.view.extent), &inputs.caps.limits)?;
    }
    match choices.shading {
        Shading::Deep | Shading::IndirectGbuffer => buffer_addresses::require_fitting(choices, inputs),
        Shading::TextureSpace(size) => size.require_fitting(inputs),
        // They have images alone.
        Shading::Ssaa | Shading::Msaa { .. } => Ok(()),
    }
}
