//! What a frame needs: resources by arithmetic, and the passes that touch them (Clarberg & Munkberg 2014, section 6, lists the
//! groups; the checklist's O1 to O3 are their bytes).

use super::baseline::{self, Shading};
use super::choices::Choices;
use super::counters;
use super::{NAME, full};
use crate::error::{Error, Result};
use crate::gpu::shader::structs::{DeepBlock, DrawBlock, FrameBlock, TupleBlock};
use crate::gpu::{Access, ImageDescription};
use crate::memory::kinds::Use;
use crate::passes::{accumulate, direct};
use crate::plan::{Plan, Shape};
use crate::resident::VertexAttributes;
use crate::techniques::Inputs;
use ash::vk::{BufferUsageFlags, Format, ImageUsageFlags as Usage};

pub const SPIDS: &str = "visibility.spids";
pub const DEPTH: &str = "visibility.depth";
/// Depth at shading points, s_z.
pub const SHADING_DEPTHS: &str = "visibility.shading_depths";
pub const BEGINS: &str = "lists.begins";
pub const NODES: &str = "lists.nodes";
pub const COLORS: &str = "shade.colors";
pub const LINEAR: &str = "lists.linear";
pub const ADDRESSES: &str = "lists.addresses";
pub const ZMAX: &str = "lists.zmax";
pub const LENGTHS: &str = "count.lengths";
pub const COUNTERS: &str = "count.counters";
pub const COLOR: &str = "resolve.color";

pub const SPID_FORMAT: Format = Format::R32G32_UINT;
pub const DEPTH_FORMAT: Format = Format::D32_SFLOAT;
pub const SHADING_DEPTH_FORMAT: Format = Format::R32_UINT;

/// The paper's M.
const LINEAR_COUNT: u64 = 16;
const NODE_BYTES: u64 = 8;
/// RGBA16F.
const COLOR_BYTES: u64 = 8;

/// Resources and passes of a frame.
///
/// Errors: the samples of a set need a buffer that the device does not bind (exit code 4, and how many would fit).
pub fn plan(choices: &Choices, inputs: &Inputs<'_>) -> Result<Plan> {
    require_fitting(choices, inputs)?;
    let mut plan = Plan::default();
    plan_scene(&mut plan, choices, inputs)?;
    if choices.shading == Shading::Deep {
        plan_deep(&mut plan, choices, inputs);
    } else {
        baseline::plan(&mut plan, choices, inputs.view.extent);
    }
    plan.buffer("counters", full(COUNTERS), counters::COUNT * 4);
    plan.read_back(&full(COUNTERS));
    let extent = inputs.view.extent;
    if choices.run_count > 1 {
        plan.image("color", full(COLOR), extent, crate::plan::PICTURE_FORMAT, Usage::STORAGE);
        accumulate::plan(&mut plan, NAME, extent);
    } else {
        plan.picture(full(COLOR), extent);
    }
    if choices.shading == Shading::Deep {
        plan_passes(&mut plan, choices);
    } else {
        baseline::plan_passes(&mut plan, choices);
    }
    if choices.run_count > 1 {
        accumulate::plan_pass(&mut plan, NAME, &full(COLOR));
    }
    Ok(plan)
}

/// What samples see, lists, and colours.
fn plan_deep(plan: &mut Plan, choices: &Choices, inputs: &Inputs<'_>) {
    let samples = choices.samples_of(inputs.view.extent);
    let shading_pixels = choices.space.extent.pixel_count();
    let layers = |format, usage| {
        let extent = choices.table.layer(inputs.view.extent);
        let layer_count = Some(choices.table.tuple_count());
        Shape::Image(ImageDescription { layer_count, ..ImageDescription::plain(extent, format, 1, usage) })
    };
    let attached = Usage::COLOR_ATTACHMENT | Usage::SAMPLED | Usage::TRANSFER_SRC;
    plan.push("frame_buffer", full(SPIDS), layers(SPID_FORMAT, attached));
    plan.push("frame_buffer", full(DEPTH), layers(DEPTH_FORMAT, Usage::DEPTH_STENCIL_ATTACHMENT));
    plan.buffer("deep_shading_buffer", full(COLORS), samples * COLOR_BYTES);
    if choices.has_lists {
        plan.buffer("deep_shading_buffer", full(BEGINS), shading_pixels * 4);
        plan.buffer("deep_shading_buffer", full(NODES), samples * NODE_BYTES);
        if choices.is_compacted {
            plan.buffer("auxiliary", full(LINEAR), shading_pixels * LINEAR_COUNT * 4);
        }
        if choices.has_addresses {
            plan.buffer("auxiliary", full(ADDRESSES), samples * 4);
        }
        if choices.has_zmax {
            plan.push("auxiliary", full(SHADING_DEPTHS), layers(SHADING_DEPTH_FORMAT, attached));
            plan.buffer("auxiliary", full(ZMAX), shading_pixels * 4);
        }
        if choices.is_counted {
            plan.buffer("counters", full(LENGTHS), shading_pixels * 4);
        }
    }
}

/// Lights, tree, cameras, tuples, and where the scene is when the shutter closes.
fn plan_scene(plan: &mut Plan, choices: &Choices, inputs: &Inputs<'_>) -> Result<()> {
    let tree = choices.direct.tree(inputs.bvh, inputs.scene)?;
    direct::plan(plan, NAME, inputs.lights.lights.len(), tree);
    let tuples = u64::from(choices.table.tuple_count()) * u64::from(choices.run_count);
    plan.buffer("frame", full("tuples"), tuples * size_of::<TupleBlock>() as u64);
    plan.buffer("frame", full("space"), size_of::<DeepBlock>() as u64);
    plan.buffer("frame", full("middle"), size_of::<FrameBlock>() as u64);
    let moving = |count: u64| if inputs.scene.closing.is_some() { count } else { 0 };
    let (vertices, draws) = (moving(inputs.stats.vertex_count), moving(inputs.stats.draw_count));
    plan.buffer("scene.geometry", full("close.positions"), vertices * 12);
    plan.buffer("scene.geometry", full("close.attributes"), vertices * size_of::<VertexAttributes>() as u64);
    plan.buffer("scene.geometry", full("close.draws"), draws * size_of::<DrawBlock>() as u64);
    if choices.is_moving && choices.maps.is_some() {
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

/// Errors: a buffer of one entry a sample is longer than the device binds.
fn require_fitting(choices: &Choices, inputs: &Inputs<'_>) -> Result<()> {
    let range = inputs.caps.limits.max_storage_buffer_range_bytes;
    let (layers, most_layers) = (choices.table.tuple_count(), inputs.caps.limits.max_image_layers);
    if !matches!(choices.shading, Shading::Msaa { .. }) && layers > most_layers {
        return Err(
            Error::request(format!("--tuples {layers}: this device has images of {most_layers} layers")).within(NAME)
        );
    }
    let samples = choices.samples_of(inputs.view.extent);
    // A baseline has images alone.
    if choices.shading != Shading::Deep || samples * COLOR_BYTES <= range {
        return Ok(());
    }
    let (size, table) = (inputs.view.extent, choices.table);
    let a_sample = samples / u64::from(table.samples);
    let most = range / (a_sample * COLOR_BYTES);
    let advice = match most {
        0 => "a smaller --size would fit".to_owned(),
        most => format!("--spp {most} fits at this size; --accumulate sums sets of them up"),
    };
    Err(Error::memory(format!(
        "--spp {} at {size}: {samples} samples of {COLOR_BYTES} bytes a buffer, and this device binds {range} bytes at once",
        table.samples
    ))
    .within(NAME)
    .note(advice))
}

/// Who touches what, in order, up to the resolve and what counts after it.
fn plan_passes(plan: &mut Plan, choices: &Choices) {
    let touch = |name: &str, access| (full(name), access);
    let read_lists = |access| {
        let mut lists = vec![touch(BEGINS, access), touch(NODES, access)];
        lists.extend(choices.is_compacted.then(|| touch(LINEAR, access)));
        lists
    };
    let mut seen = vec![touch(SPIDS, Access::ColorWrite), touch(DEPTH, Access::DepthWrite)];
    seen.extend([touch(COUNTERS, Access::TransferWrite), touch(COUNTERS, Access::FragmentWrite)]);
    if choices.has_zmax {
        seen.push(touch(SHADING_DEPTHS, Access::ColorWrite));
    }
    plan.pass(full("visibility"), seen);
    if choices.has_lists {
        let mut listed = vec![
            touch(SPIDS, Access::ComputeSample),
            touch(BEGINS, Access::TransferWrite),
            touch(BEGINS, Access::ComputeWrite),
            touch(COUNTERS, Access::ComputeWrite),
            touch(NODES, Access::ComputeWrite),
            touch(COLORS, Access::ComputeWrite),
        ];
        listed.extend(choices.has_addresses.then(|| touch(ADDRESSES, Access::ComputeWrite)));
        if choices.has_zmax {
            listed.push(touch(SHADING_DEPTHS, Access::ComputeSample));
            listed.extend([touch(ZMAX, Access::TransferWrite), touch(ZMAX, Access::ComputeWrite)]);
        }
        plan.pass(full("lists"), listed);
        if choices.is_compacted {
            let mut compacted = read_lists(Access::ComputeWrite);
            compacted.extend([touch(COLORS, Access::ComputeWrite), touch(COUNTERS, Access::ComputeWrite)]);
            plan.pass(full("lists.compact"), compacted);
            if choices.has_addresses {
                let mut addressed = read_lists(Access::ComputeRead);
                addressed.extend([touch(SPIDS, Access::ComputeSample), touch(ADDRESSES, Access::ComputeWrite)]);
                plan.pass(full("lists.address"), addressed);
            }
        }
        let mut shaded = read_lists(Access::GraphicsRead);
        shaded.extend(choices.has_zmax.then(|| touch(ZMAX, Access::GraphicsRead)));
        shaded.extend(choices.maps.iter().map(|maps| maps.read(NAME)));
        shaded.extend([touch(COLORS, Access::FragmentWrite), touch(COUNTERS, Access::FragmentWrite)]);
        plan.pass(full("shade"), shaded);
    }
    if choices.has_brute() {
        let mut brute = vec![touch(SPIDS, Access::FragmentSample), touch(DEPTH, Access::DepthTest)];
        if choices.has_lists {
            brute.push(touch(NODES, Access::GraphicsRead));
        } else {
            brute.push(touch(COLORS, Access::TransferWrite));
        }
        brute.extend(choices.maps.iter().map(|maps| maps.read(NAME)));
        brute.extend([touch(COLORS, Access::FragmentWrite), touch(COUNTERS, Access::FragmentWrite)]);
        plan.pass(full(choices.brute_pass()), brute);
    }
    let mut resolved = vec![
        touch(SPIDS, Access::ComputeSample),
        touch(COLORS, Access::ComputeRead),
        touch(COUNTERS, Access::ComputeWrite),
        touch(COLOR, Access::ComputeWrite),
    ];
    if choices.has_lists && choices.has_addresses {
        resolved.push(touch(ADDRESSES, Access::ComputeRead));
    } else if choices.has_lists {
        resolved.extend(read_lists(Access::ComputeRead));
    }
    plan.pass(full("resolve"), resolved);
    if choices.has_lists && choices.is_counted {
        let mut counted = read_lists(Access::ComputeRead);
        counted.extend([touch(COUNTERS, Access::ComputeWrite), touch(LENGTHS, Access::ComputeWrite)]);
        plan.pass(full("count"), counted);
    }
}
