//! The stages of the paper's figure 3, and what `--split subsample` interpolates, read back after a frame.

use super::choices::{Choices, VplShadow};
use super::frame::InterleavedFrame;
use super::split_method::{Split, SplitMethod};
use super::split_passes::{SplitPasses, SubBuffers};
use super::sub_buffers::{Stage, Texels};
use crate::error::Result;
use crate::gpu::shader::techniques::interleaved_deferred::vpl_shadow::hidden::HIDDEN_HEAD;
use crate::gpu::{Access, Buffer, Gpu, readback};
use crate::passes::decode;
use crate::passes::filter::Filter;
use crate::picture::{Aov, AovChannels};
use crate::settings::Values;
use crate::techniques::interleaved_deferred::resources::NAME;
use std::sync::Arc;

const UNSEEN: &str = "vpl_shadow.hidden";
const SPLIT: &str = "split.normal";
const SPLIT_COLOR: &str = "split.color";
const SHADED: &str = "shade.irradiance";
const UPSCALED: &str = "upscale.irradiance";
const GATHERED: &str = "gather.irradiance";
const FLAGS: &str = "discontinuity.flags";
const FILTERED: &str = "filter.irradiance";

/// Names that `--aov` takes.
pub const AOVS: &[&str] = &[
    "gbuffer.normal",
    "gbuffer.color",
    "gbuffer.color.id",
    UNSEEN,
    SPLIT,
    SPLIT_COLOR,
    SHADED,
    UPSCALED,
    GATHERED,
    FLAGS,
    FILTERED,
];

/// Those that the settings leave out, with the reason.
pub fn left_out(choices: &Choices, values: &Values) -> Vec<(&'static str, String)> {
    let mut left_out = Vec::new();
    let split = values.choice::<Split>("split").name();
    if choices.vpl_shadow == VplShadow::None {
        left_out.push((UNSEEN, "with --vpl-shadow none nothing looks for hidden lights; ray and map do".to_owned()));
    }
    if choices.split != SplitMethod::Subsample {
        left_out.push((UPSCALED, format!("--split {split} interpolates nothing; subsample does")));
    }
    if choices.split.copies().is_none() {
        for stage in [SPLIT, SPLIT_COLOR, GATHERED] {
            left_out.push((
                stage,
                format!("--split {split} copies nothing; one-pass, two-pass, tile, layered and fragment do"),
            ));
        }
    } else {
        if choices.gather_filters() {
            left_out
                .push((GATHERED, "with --fuse on the gather filters what it reads; --fuse off makes it".to_owned()));
        }
        if !choices.moved.has_color() {
            let why = "with --sub-buffer-color off position and normal alone are split; on moves the colour too";
            left_out.push((SPLIT_COLOR, why.to_owned()));
        }
    }
    if choices.filter == Filter::None {
        let why = match choices.split.sums_all() {
            true => format!("with --split {split} all lights are summed, and nothing is filtered"),
            false if choices.subset_count() == 1 => {
                "with --pattern 1x1 all lights are summed, and nothing is filtered".to_owned()
            }
            false => "--filter none leaves it out; gauss and gauss-fast make it".to_owned(),
        };
        left_out.extend([FLAGS, FILTERED].map(|stage| (stage, why.clone())));
    } else if choices.fused {
        left_out.push((FILTERED, "with --fuse on the composite ends the filter; --fuse off makes it".to_owned()));
    }
    left_out
}

/// Reads `name` back, which the settings make.
///
/// Errors: memory for the copy (exit code 4).
pub fn read(frame: &InterleavedFrame, gpu: &Arc<Gpu>, name: &str) -> Result<Aov> {
    if let Some(aov) = frame.gbuffer.aov(gpu, name) {
        return aov;
    }
    let filter = || frame.filter.as_ref().expect("a stage that the settings leave out is refused");
    let rgb = |values: Vec<[f32; 3]>| Ok(Aov { name: name.to_owned(), channels: AovChannels::Rgb(values) });
    match (name, &frame.split_passes) {
        (UNSEEN, _) => Ok(Aov { name: name.to_owned(), channels: AovChannels::YU32(hidden_counts(frame, gpu)?) }),
        (SPLIT, SplitPasses::SubBuffers(sub_buffers)) => {
            let last = sub_buffers.copies.storage.read(Stage::Compute);
            rgb(side_by_side(frame, gpu, &sub_buffers.surface.normal, last, decode::normal)?)
        }
        (SPLIT_COLOR, SplitPasses::SubBuffers(sub_buffers)) => {
            let SubBuffers { copies, surface, .. } = sub_buffers;
            let color = surface.color.as_ref().expect("a stage that the settings leave out is refused");
            let last = match frame.shade.parts.has_color() {
                true => copies.storage.read(Stage::Compute),
                // Nothing has touched it since the split.
                false => copies.storage.written(copies.stage()),
            };
            rgb(side_by_side(frame, gpu, color, last, decode::halves)?)
        }
        (SHADED, SplitPasses::SubBuffers(sub_buffers)) => {
            let last = sub_buffers.copies.storage.read(sub_buffers.copies.stage());
            rgb(side_by_side(frame, gpu, &sub_buffers.shaded, last, decode::halves)?)
        }
        (SHADED, SplitPasses::Subsample { cells: shaded, .. }) => {
            let texels = texels(gpu, shaded, decode::halves)?;
            rgb(cells(frame, &texels))
        }
        (UPSCALED, SplitPasses::Subsample { irradiance, .. }) => rgb(in_frame_order(frame, gpu, irradiance)?),
        (
            SHADED,
            SplitPasses::Branch { irradiance, .. }
            | SplitPasses::Strided { irradiance, .. }
            | SplitPasses::Masked { irradiance, .. },
        ) => rgb(in_frame_order(frame, gpu, irradiance)?),
        (GATHERED, SplitPasses::SubBuffers(sub_buffers)) => rgb(in_frame_order(frame, gpu, &sub_buffers.gathered)?),
        (FLAGS, _) => {
            let flags = &filter().flags;
            let bytes = readback::buffer(gpu, flags, flags.bytes, Access::ComputeRead)?;
            let flags =
                rows(frame, bytes.chunks_exact(4).map(|flag| u32::from_le_bytes([flag[0], flag[1], flag[2], flag[3]])));
            Ok(Aov { name: name.to_owned(), channels: AovChannels::YU32(flags) })
        }
        (FILTERED, _) => {
            let irradiance = filter().irradiance().expect("with --fuse on it is refused");
            rgb(in_frame_order(frame, gpu, irradiance)?)
        }
        _ => unreachable!("{NAME} has no stage {name} with this split"),
    }
}

fn texels(gpu: &Arc<Gpu>, buffer: &Buffer, decode: fn([u32; 2]) -> [f32; 3]) -> Result<Vec<[f32; 3]>> {
    let bytes = readback::buffer(gpu, buffer, buffer.bytes, Access::ComputeRead)?;
    Ok(decode::words(&bytes).map(decode).collect())
}

fn side_by_side(
    frame: &InterleavedFrame,
    gpu: &Arc<Gpu>,
    texels: &Texels,
    last: Access,
    decode: fn([u32; 2]) -> [f32; 3],
) -> Result<Vec<[f32; 3]>> {
    let mapping = frame.shade.mapping();
    let words: Vec<[u32; 2]> = decode::words(&texels.read(gpu, last)?).collect();
    Ok(mapping.side_by_side().into_iter().map(|pixel| decode(words[texels.index_of(mapping, pixel)])).collect())
}

/// Each pixel shows its pattern's one texel.
fn cells(frame: &InterleavedFrame, texels: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let mapping = frame.shade.mapping();
    let cell = |x: u32, y: u32| (y / mapping.pattern_y * mapping.sub_width_px + x / mapping.pattern_x) as usize;
    (0..mapping.height_px).flat_map(|y| (0..mapping.width_px).map(move |x| texels[cell(x, y)])).collect()
}

fn in_frame_order(frame: &InterleavedFrame, gpu: &Arc<Gpu>, buffer: &Buffer) -> Result<Vec<[f32; 3]>> {
    Ok(rows(frame, texels(gpu, buffer, decode::halves)?.into_iter()))
}

/// How many virtual lights of its subset each pixel does not see, of those that would light it; each pixel shows its
/// pattern's one with `--split subsample`.
fn hidden_counts(frame: &InterleavedFrame, gpu: &Arc<Gpu>) -> Result<Vec<u32>> {
    let hidden = frame.shade.hidden.as_ref().expect("a stage that the settings leave out is refused");
    let stage = if let SplitPasses::Masked { .. } = frame.split_passes { Stage::Fragment } else { Stage::Compute };
    let bytes = readback::buffer(gpu, hidden, hidden.bytes, stage.reads())?;
    let words: &[u32] = bytemuck::cast_slice(&bytes);
    let (mapping, words_a_point) = (frame.shade.mapping(), frame.shade.params.words_a_point as usize);
    let of_cells = matches!(frame.split_passes, SplitPasses::Subsample { .. });
    let count = |pixel: [u32; 2]| {
        let [x, y, subset] = mapping.texel_of_pixel(pixel);
        let place = mapping.linear_of([x, y, if of_cells { 0 } else { subset }]) as usize;
        let first = HIDDEN_HEAD as usize + place * words_a_point;
        words[first..first + words_a_point].iter().map(|word| word.count_ones()).sum()
    };
    Ok((0..mapping.height_px).flat_map(|y| (0..mapping.width_px).map(move |x| [x, y])).map(count).collect())
}

/// Leaves the padding of the rows out.
fn rows<T>(frame: &InterleavedFrame, texels: impl Iterator<Item = T>) -> Vec<T> {
    let mapping = frame.shade.mapping();
    let (pitch, width) = (mapping.row_pitch() as usize, mapping.width_px as usize);
    texels.enumerate().filter(|(index, _)| index % pitch < width).map(|(_, texel)| texel).collect()
}
