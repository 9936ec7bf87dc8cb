//! Look-up textures: for each texel that a fragment program writes, where it comes from (Segovia 2006, sections 3.2 and
//! 4.2). Made once on the host from the mapping; R16G16_UINT, 4 B a texel.

use crate::error::Result;
use crate::gpu::sampler::Sampler;
use crate::gpu::{Access, Bound, Gpu, Image, upload};
use crate::plan::{Plan, Resources};
use crate::techniques::interleaved_deferred::resources::NAME;
use crate::units::Extent;
use ash::vk;
use std::sync::Arc;

/// Bytes that a fragment program reads of it for each texel.
pub const TEXEL_BYTES: u64 = 4;

/// Entry for padding, which comes from no pixel: fragment.frag's NOWHERE. No image is that large.
const NOWHERE: [u16; 2] = [u16::MAX; 2];

pub struct Lookup {
    image: Image,
    nearest: Sampler,
}

impl Lookup {
    /// Plans the look-up texture `what`, as large as what is written with it.
    pub fn plan(plan: &mut Plan, what: &str, extent: Extent) {
        let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
        plan.image("lookup", format!("{NAME}.{what}"), extent, vk::Format::R16G16_UINT, usage);
    }

    /// Takes it out and fills it. `source_of`: where the texel at [x, y] comes from; None where it is padding.
    pub fn new(
        gpu: &Arc<Gpu>,
        resources: &mut Resources,
        what: &str,
        source_of: impl Fn([u32; 2]) -> Option<[u32; 2]>,
    ) -> Result<Self> {
        let image = resources.image(&format!("{NAME}.{what}"));
        let Extent { width, height } = image.description.extent;
        let texels: Vec<[u16; 2]> = (0..height)
            .flat_map(|y| (0..width).map(move |x| [x, y]))
            .map(|at| source_of(at).map_or(NOWHERE, |source| source.map(|side| side as u16)))
            .collect();
        let fill = |bytes: &mut [u8]| bytes.copy_from_slice(bytemuck::cast_slice(&texels));
        upload::image(gpu, &image, Access::FragmentSample, fill)?;
        Ok(Self { image, nearest: Sampler::clamped(gpu, vk::Filter::NEAREST)? })
    }

    /// What fragment programs bind.
    pub fn bound(&self) -> (&'static str, Bound<'_>) {
        ("lookup", Bound::Sampled(&self.image, self.nearest.handle, Access::FragmentSample))
    }
}
