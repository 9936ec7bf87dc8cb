//! Stages that can be written beside the picture.

use super::combine;
use super::members::{Drawing, Members};
use crate::error::Result;
use crate::gpu::{Access, Buffer, Gpu, Image, readback};
use crate::picture::{Aov, AovChannels};
use std::sync::Arc;

/// Samples of each pixel.
pub const SAMPLES: &str = "combine.sums.samples";
/// The last member as it was drawn, its samples at the pixels that they lie in; 0 where it drew none.
pub const MEMBER: &str = "material.color";

pub const ALL: &[&str] = &[SAMPLES, MEMBER];

/// Errors: memory for the copy (exit code 4).
pub fn samples(gpu: &Arc<Gpu>, members: &Members, sums: &Buffer) -> Result<Aov> {
    let bytes = readback::buffer(gpu, sums, sums.bytes, Access::ComputeRead)?;
    let sums: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(&bytes);
    // Sums of pixels without a sample were never written.
    let sources = members.sources();
    let has = |pixel: usize| sources.is_none_or(|sources| sources[pixel] == pixel as u32);
    let counts = sums.iter().enumerate().map(|(pixel, sum)| if has(pixel) { sum[3] as u32 } else { 0 });
    Ok(Aov { name: SAMPLES.to_owned(), channels: AovChannels::YU32(counts.collect()) })
}

/// `drawn`: the picture of the last member.
///
/// Errors: as `samples`.
pub fn member(gpu: &Arc<Gpu>, members: &Members, drawn: &Image) -> Result<Aov> {
    let bytes = readback::image(gpu, drawn, combine::reads(members.drawing()))?;
    let texels: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(&bytes);
    let rgb = |[r, g, b, _]: [f32; 4]| [r, g, b];
    let (frame, grid, member) = (members.frame(), members.grid(), members.count() - 1);
    let mut colors = vec![[0.0; 3]; frame.pixel_count() as usize];
    match members.drawing() {
        Drawing::Tuples | Drawing::SampleLocations => {
            colors.iter_mut().zip(texels).for_each(|(color, texel)| *color = rgb(texel))
        }
        Drawing::Layers | Drawing::Stipple => {
            for (index, texel) in (0..).zip(texels) {
                let [x, y] =
                    [members.pixel(member, 0, index % grid.width), members.pixel(member, 1, index / grid.width)];
                if x < frame.width && y < frame.height {
                    colors[(y * frame.width + x) as usize] = rgb(texel);
                }
            }
        }
    }
    Ok(Aov { name: MEMBER.to_owned(), channels: AovChannels::Rgb(colors) })
}
