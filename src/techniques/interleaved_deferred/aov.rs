//! The stages of the paper's figure 3, read back after a frame.

use super::frame::InterleavedFrame;
use super::roads::Roads;
use super::sub_buffers::{Stage, Texels};
use super::{AOVS, NAME};
use crate::error::Result;
use crate::gpu::{Access, Buffer, Gpu, readback};
use crate::passes::decode;
use crate::report::image_file::{Aov, AovChannels};
use crate::techniques::left_out;
use std::sync::Arc;

/// Reads `name` back.
///
/// Errors: the settings leave its pass out (exit code 2).
pub fn read(frame: &InterleavedFrame, gpu: &Arc<Gpu>, name: &str) -> Result<Aov> {
    if let Some(aov) = frame.gbuffer.aov(gpu, name) {
        return aov;
    }
    let why_no_split = "of the roads of --split only one-pass, two-pass, tile, layered and fragment copy";
    let why_no_filter = "--filter none, --split none, --split subsample and a pattern of 1x1 leave it out";
    let rgb = |values: Vec<[f32; 3]>| Ok(Aov { name: name.to_owned(), channels: AovChannels::Rgb(values) });
    match (name, &frame.roads) {
        ("split.normal", Roads::SubBuffers(road)) => {
            let last = road.copies.storage.read(Stage::Compute);
            rgb(side_by_side(frame, gpu, &road.surface.normal, last, decode::normal)?)
        }
        ("shade.irradiance", Roads::SubBuffers(road)) => {
            let last = road.copies.storage.read(road.copies.stage());
            rgb(side_by_side(frame, gpu, &road.shaded, last, decode::halves)?)
        }
        ("shade.irradiance", Roads::Subsample { cells: shaded, .. }) => {
            let texels = texels(gpu, shaded, decode::halves)?;
            rgb(cells(frame, &texels))
        }
        ("upscale.irradiance", Roads::Subsample { irradiance, .. }) => rgb(in_frame_order(frame, gpu, irradiance)?),
        ("upscale.irradiance", _) => Err(left_out(NAME, name, "--split subsample alone interpolates")),
        (
            "shade.irradiance",
            Roads::Branch { irradiance, .. } | Roads::Strided { irradiance, .. } | Roads::Masked { irradiance, .. },
        ) => rgb(in_frame_order(frame, gpu, irradiance)?),
        ("gather.irradiance", Roads::SubBuffers(road)) if road.gather_filters() => {
            Err(left_out(NAME, name, "with --fuse on the gather filters what it reads; --fuse off"))
        }
        ("gather.irradiance", Roads::SubBuffers(road)) => rgb(in_frame_order(frame, gpu, &road.gathered)?),
        ("discontinuity.flags", _) => match &frame.filter {
            Some(filter) => {
                let bytes = readback::buffer(gpu, &filter.flags, filter.flags.bytes, Access::ComputeRead)?;
                let flags = rows(
                    frame,
                    bytes.chunks_exact(4).map(|flag| u32::from_le_bytes([flag[0], flag[1], flag[2], flag[3]])),
                );
                Ok(Aov { name: name.to_owned(), channels: AovChannels::YU32(flags) })
            }
            None => Err(left_out(NAME, name, why_no_filter)),
        },
        ("filter.irradiance", _) => match &frame.filter {
            Some(filter) => match filter.irradiance() {
                Some(irradiance) => rgb(in_frame_order(frame, gpu, irradiance)?),
                None => Err(left_out(NAME, name, "with --fuse on the composite ends the filter; --fuse off")),
            },
            None => Err(left_out(NAME, name, why_no_filter)),
        },
        ("split.normal" | "gather.irradiance", _) => Err(left_out(NAME, name, why_no_split)),
        _ => Err(left_out(NAME, name, &format!("it has {}", AOVS.join(", ")))),
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

/// Leaves the padding of the rows out.
fn rows<T>(frame: &InterleavedFrame, texels: impl Iterator<Item = T>) -> Vec<T> {
    let mapping = frame.shade.mapping();
    let (pitch, width) = (mapping.row_pitch() as usize, mapping.width_px as usize);
    texels.enumerate().filter(|(index, _)| index % pitch < width).map(|(_, texel)| texel).collect()
}
