//! The stages that `--aov` names: figure 3's frame buffer and the three buffers that are made of it (Clarberg & Munkberg 2014),
//! of the last set of samples. What shading space has is shown under the middle of each pixel, what samples have by the pixel's first.

use super::choices::Choices;
use super::separate::SeparateShading;
use super::stereo;
use super::visibility::ray::trace::Spid;
use super::visibility::samples::Samples;
use crate::error::Result;
use crate::gpu::shader::techniques::deep_shading::space::{NEAREST_DEPTH, NO_PRIMITIVE, NO_SHADING_PIXEL};
use crate::gpu::{Access, Buffer, Gpu, readback};
use crate::picture::{Aov, AovChannels};
use crate::techniques::deep_shading::modes::shading::Shading;
use crate::techniques::deep_shading::resources::{ADDRESSES, LENGTHS, SPIDS, ZMAX};
use crate::units::Extent;
use std::sync::Arc;

/// Figure 2: how far a sample's place in shading space lies from its pixel's.
const SHIFTS: &str = "visibility.spids.shifts";

pub const ALL: &[&str] = &[LENGTHS, SPIDS, SHIFTS, ZMAX, ADDRESSES, stereo::RIGHT];

/// What a stage is read from is there.
pub const REFUSED: &str = "a stage that the settings leave out is refused";

/// Those that the settings leave out, with the reason.
pub fn left_out(choices: &Choices) -> Vec<(&'static str, String)> {
    let is_separate = matches!(choices.shading, Shading::Deep | Shading::IndirectGbuffer);
    let mut left_out = Vec::new();
    let mut leave_out = |stage, why: &str| left_out.push((stage, why.to_owned()));
    if !is_separate {
        let why = "samples of this --shading have colours and nothing else; --shading deep makes it";
        [LENGTHS, SPIDS, SHIFTS, ZMAX, ADDRESSES].into_iter().for_each(|stage| leave_out(stage, why));
    } else {
        if !(choices.has_lists && choices.is_counted) {
            leave_out(LENGTHS, "lists are counted with --shading deep, --lists linked or direct, and --instrument on");
        }
        if choices.lists.is_direct {
            for stage in [SPIDS, SHIFTS] {
                leave_out(stage, "--lists direct has no SPIDs; --lists linked makes them");
            }
        }
        if !choices.lists.has_zmax {
            leave_out(ZMAX, "--shading deep with --shade-by fragment and --zmax on makes it");
        }
        if !choices.lists.has_addresses {
            leave_out(ADDRESSES, "--shading deep with --address-buffer on, and lists, makes it");
        }
    }
    if !choices.has_right_eye() {
        leave_out(stereo::RIGHT, "two eyes see with --stereo above 0 and --stereo-eyes both");
    }
    left_out
}

/// What stages are read from.
pub struct Stages<'a> {
    pub gpu: &'a Arc<Gpu>,
    pub choices: &'a Choices,
    pub separate: &'a SeparateShading,
    pub frame: Extent,
}

impl Stages<'_> {
    /// A stage of this name.
    ///
    /// Errors: memory for copies (exit code 4).
    pub fn read(&self, name: &str) -> Result<Aov> {
        let channels = match name {
            SPIDS => self.seen_of_samples(|_, spid| spid.primitive, NO_PRIMITIVE).map(AovChannels::YU32),
            SHIFTS => self.seen_of_samples(|pixel, spid| self.shift(pixel, spid.pixel), [0.0; 3]).map(AovChannels::Rgb),
            ADDRESSES => {
                let buffer = self.separate.lists().and_then(|lists| lists.addresses.as_ref()).expect(REFUSED);
                let addresses = self.words(buffer, Access::ComputeRead)?;
                Ok(AovChannels::YU32(self.pixels().map(|pixel| addresses[self.sample_of(pixel)]).collect()))
            }
            ZMAX => {
                let buffer = self.separate.lists().and_then(|lists| lists.zmax.as_ref()).expect(REFUSED);
                let words = self.words(buffer, Access::TransferRead)?;
                // Nothing is seen where none has lowered it: as far as can be.
                let depth = |word: u32| if word == NEAREST_DEPTH { 0.0 } else { f32::from_bits(word) };
                Ok(AovChannels::Y(self.pixels().map(|at| depth(words[self.choices.space.index_under(at)])).collect()))
            }
            _ => {
                let count = self.separate.count().expect(REFUSED);
                let lengths = self.words(&count.lengths, Access::ComputeWrite)?;
                Ok(AovChannels::YU32(self.pixels().map(|at| lengths[self.choices.space.index_under(at)]).collect()))
            }
        };
        Ok(Aov { name: name.to_owned(), channels: channels? })
    }

    fn pixels(&self) -> impl Iterator<Item = [u32; 2]> {
        let Extent { width, height, .. } = self.frame;
        (0..height).flat_map(move |y| (0..width).map(move |x| [x, y]))
    }

    fn words(&self, buffer: &Buffer, last: Access) -> Result<Vec<u32>> {
        Ok(bytemuck::pod_collect_to_vec(&readback::buffer(self.gpu, buffer, buffer.bytes, last)?))
    }

    /// Pixels of shading space from the one under the middle of a pixel to a shading point; 0 where shading space has none.
    fn shift(&self, pixel: [u32; 2], shading_point: u32) -> [f32; 3] {
        if shading_point == NO_SHADING_PIXEL {
            return [0.0; 3];
        }
        let width = self.choices.space.extent.width as usize;
        let under = self.choices.space.index_under(pixel);
        let [x, y] = [shading_point & 0xffff, shading_point >> 16].map(|side| side as f32);
        [x - (under % width) as f32, y - (under / width) as f32, 0.0]
    }

    /// Where a pixel's first sample is in what has one entry a sample.
    fn sample_of(&self, pixel: [u32; 2]) -> usize {
        self.choices.table.first_sample(self.frame, pixel)
    }

    /// `of` each pixel and the SPID of its first sample; `nothing` where that sees nothing.
    fn seen_of_samples<T: Copy>(&self, of: impl Fn([u32; 2], Spid) -> T, nothing: T) -> Result<Vec<T>> {
        let samples: &Samples = self.separate.samples().expect(REFUSED);
        let bytes = readback::image(self.gpu, &samples.spids, Access::ComputeSample)?;
        let spids: Vec<Spid> = bytemuck::pod_collect_to_vec(&bytes);
        let of_pixel = |pixel| {
            let spid = spids[self.sample_of(pixel)];
            if spid.primitive == NO_PRIMITIVE { nothing } else { of(pixel, spid) }
        };
        Ok(self.pixels().map(of_pixel).collect())
    }
}
