//! The passes of a frame in order, up to the resolve and what counts after it, and what each touches.

use super::choices::Choices;
use super::scales::SCALES;
use super::visibility::looped;
use super::{entries, indirect, reconstruct, stereo};
use crate::gpu::Access;
use crate::plan::Plan;
use crate::techniques::deep_shading::modes::shading::Shading;
use crate::techniques::deep_shading::resources::{
    ADDRESSES, BEGINS, COLOR, COLORS, COUNTERS, DEPTH, LENGTHS, LINEAR, MARKS, NAME, NODES, SHADE_DEPTH,
    SHADING_DEPTHS, SPIDS, ZMAX, full,
};

type Touches = Vec<(String, Access)>;

fn touch(name: &str, access: Access) -> (String, Access) {
    (full(name), access)
}

fn links(choices: &Choices, access: Access) -> Touches {
    let mut lists = vec![touch(BEGINS, access), touch(NODES, access)];
    lists.extend(choices.lists.is_compacted.then(|| touch(LINEAR, access)));
    lists
}

/// How coarse triangles are, as `access` reads it.
fn scales(choices: &Choices, access: Access) -> Option<(String, Access)> {
    choices.blur_pixels.map(|_| touch(SCALES, access))
}

pub fn plan(plan: &mut Plan, choices: &Choices) {
    if choices.blur_pixels.is_some() {
        plan.pass(full(SCALES), [touch(SCALES, Access::ComputeWrite)]);
    }
    if choices.lists.is_direct {
        let copied = [BEGINS, NODES, ADDRESSES, COLORS, COUNTERS].into_iter();
        let copied = copied.chain(choices.lists.is_compacted.then_some(LINEAR));
        let copied = copied.chain(choices.lists.has_zmax.then_some(ZMAX));
        let copied = copied.chain(choices.lists.has_marks.then_some(MARKS));
        let accesses = [Access::TransferWrite, Access::ComputeWrite];
        plan.pass(full("lists"), copied.flat_map(|name| accesses.map(|access| touch(name, access))));
    } else {
        plan.pass(full("visibility"), visibility(choices));
        if choices.has_lists {
            insertion(plan, choices);
        }
    }
    if choices.shading == Shading::IndirectGbuffer {
        indirect::plan_passes(plan, choices);
        return;
    }
    if !choices.has_lists {
        let touches = [touch(SPIDS, Access::ComputeSample), touch(COLORS, Access::ComputeWrite)];
        plan.pass(full(entries::samples::PASS), touches);
    }
    entries::plan_sort(plan);
    if choices.is_by_fragment() {
        let mut shaded = links(choices, Access::GraphicsRead);
        if choices.lists.has_zmax {
            shaded.extend([touch(ZMAX, Access::TransferRead), touch(SHADE_DEPTH, Access::TransferWrite)]);
            shaded.push(touch(SHADE_DEPTH, Access::DepthTest));
        }
        shaded.extend(choices.lists.has_marks.then(|| touch(MARKS, Access::GraphicsRead)));
        shaded.extend(choices.maps.iter().filter_map(|maps| maps.read(NAME)));
        shaded.extend(scales(choices, Access::GraphicsRead));
        shaded.extend([touch(COLORS, Access::FragmentWrite), touch(COUNTERS, Access::FragmentWrite)]);
        plan.pass(full("shade"), shaded);
    }
    plan.pass(full(choices.entries_pass()), shaded_entries(choices));
    let written = [touch(COUNTERS, Access::ComputeWrite)].into_iter().chain(stereo::resolved(choices));
    plan.pass(full("resolve"), shaded(choices).into_iter().chain(written));
    if choices.blur.is_reconstructed {
        reconstruct::plan_passes(plan, shaded(choices), COLOR);
    }
    if choices.has_lists && choices.is_counted {
        let mut counted = links(choices, Access::ComputeWrite);
        counted.extend([touch(COUNTERS, Access::ComputeWrite), touch(LENGTHS, Access::ComputeWrite)]);
        plan.pass(full("count"), counted);
    }
}

fn visibility(choices: &Choices) -> Touches {
    let written = choices.visibility.writes();
    let mut seen = vec![touch(SPIDS, written)];
    seen.extend(choices.has_depth().then(|| touch(DEPTH, Access::DepthWrite)));
    seen.extend(scales(choices, Access::GraphicsRead));
    seen.extend(choices.raster.is_looped.then(looped::touches).into_iter().flatten());
    seen.extend([touch(COUNTERS, Access::TransferWrite), touch(COUNTERS, Access::FragmentWrite)]);
    seen.extend(choices.lists.has_zmax.then(|| touch(SHADING_DEPTHS, written)));
    seen
}

/// By compute shaders, with what brings the lists into order.
fn insertion(plan: &mut Plan, choices: &Choices) {
    let mut listed = vec![
        touch(SPIDS, Access::ComputeSample),
        touch(BEGINS, Access::TransferWrite),
        touch(BEGINS, Access::ComputeWrite),
        touch(COUNTERS, Access::ComputeWrite),
        touch(NODES, Access::ComputeWrite),
        touch(COLORS, Access::ComputeWrite),
    ];
    listed.extend(choices.lists.has_addresses.then(|| touch(ADDRESSES, Access::ComputeWrite)));
    if choices.lists.has_zmax {
        listed.push(touch(SHADING_DEPTHS, Access::ComputeSample));
        listed.extend([touch(ZMAX, Access::TransferWrite), touch(ZMAX, Access::ComputeWrite)]);
    }
    if choices.lists.has_marks {
        listed.extend([touch(MARKS, Access::TransferWrite), touch(MARKS, Access::ComputeWrite)]);
    }
    plan.pass(full("lists"), listed);
    if !choices.lists.is_compacted {
        return;
    }
    let mut compacted = links(choices, Access::ComputeWrite);
    compacted.extend([touch(COLORS, Access::ComputeWrite), touch(COUNTERS, Access::ComputeWrite)]);
    plan.pass(full("lists.compact"), compacted);
    if choices.lists.has_addresses {
        let mut addressed = links(choices, Access::ComputeRead);
        addressed.extend([touch(SPIDS, Access::ComputeSample), touch(ADDRESSES, Access::ComputeWrite)]);
        plan.pass(full("lists.address"), addressed);
    }
}

fn shaded_entries(choices: &Choices) -> Touches {
    let mut shaded = entries::read().to_vec();
    shaded.extend(scales(choices, Access::ComputeRead));
    shaded.extend(choices.maps.iter().filter_map(|maps| maps.read_by(NAME, Access::ComputeSample)));
    shaded.extend([touch(COLORS, Access::ComputeWrite), touch(COUNTERS, Access::ComputeWrite)]);
    shaded
}

/// What says which colours samples have.
fn shaded(choices: &Choices) -> Touches {
    let mut shaded = vec![touch(COLORS, Access::ComputeRead)];
    shaded.extend((!choices.lists.is_direct).then(|| touch(SPIDS, Access::ComputeSample)));
    if choices.has_lists && choices.lists.has_addresses {
        shaded.push(touch(ADDRESSES, Access::ComputeRead));
    } else if choices.has_lists {
        shaded.extend(links(choices, Access::ComputeRead));
    }
    shaded
}
