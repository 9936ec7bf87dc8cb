//! Reconstruct: the picture from few samples under blur, in place of the mean of each pixel's own (`--reconstruct on`).
//!
//! Clarberg & Munkberg 2014 (section 4.5) hand their samples' colours, motion vectors and depths to the filter of Munkberg et
//! al. 2014, "Layered Reconstruction for Defocus and Motion Blur", which their paper does not describe. The filter here is not
//! theirs: it is of our choice, from two ideas of the literature
//! - axis-aligned filtering (Mehta, Wang & Ramamoorthi 2012; of several effects Mehta et al. 2014; Egan et al. 2009 say why):
//!   what a lens and motion have blurred has no detail finer than its blur, so that colours may be spread as far as a fixed
//!   part of it. A sample's circle of confusion and its way on the screen give the filter's ellipse (blur.glsl)
//! - depth layers of a tile (Munkberg et al. 2014; Vaidyanathan et al. 2015): what is filtered together must be blurred alike, so
//!   that a tile's samples are parted by depth into up to four layers; each is filtered for its colour and for the part that it
//!   hides of what lies behind it, and they are put over each other from front to back. A tile's samples are counted by depth
//!   (bins.comp), its own bins and those around it cut into layers (layers.comp), each pixel's samples of a layer summed up
//!   (means.comp), and these sums filtered (filter.comp)
//! - all tuples of the table: where some of a pixel's samples see a layer and others see past it, filters are at least as wide
//!   as the table of tuples, so that its pattern does not show; and a layer that none of the tuples around a pixel see stays out
//!   of it, so that nothing is drawn beyond the blur
//!
//! Colours and parts are ratios of sums with the same weights: one colour stays one colour, and nothing gets darker. A pixel
//! whose layers are sharp has the bits of the resolve. More samples a pixel have narrower filters. They end after 16 pixels: of 8
//! samples, blur with a radius over 32 pixels, or a way of over 131, keeps noise.

pub(super) mod bins;
pub(super) mod filter;
mod filter_buffers;
pub(super) mod layers;
pub(super) mod means;
pub(super) mod samples;

use super::choices::Choices;
use super::sample_colors::{SampleColors, fetch};
use crate::error::Result;
use crate::gpu::shader::structs::{BinBlock, TileBlock};
use crate::gpu::shader::techniques::deep_shading::reconstruct::blur::TILE_PX;
use crate::gpu::shader::techniques::deep_shading::reconstruct::depth_bins::BIN_COUNT;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Image};
use crate::plan::{Plan, Resources};
use crate::techniques::deep_shading::reconstruct::filter_buffers::{BINS, FilterBuffers, TILES};
use crate::techniques::deep_shading::resources::{
    LAYER_MEANS, MEANS_BYTES, SAMPLE_BYTES, SAMPLE_COLORS, SAMPLE_VECTORS, full,
};
use crate::units::Extent;
use bins::Bins;
use filter::Filter;
use layers::Layers;
use means::Means;
use samples::Gather;
use std::sync::Arc;

pub const COLOR: &str = "reconstruct.filter.color";

/// Tiles across and down.
fn tiles(frame: Extent) -> [u32; 2] {
    [frame.width.div_ceil(TILE_PX), frame.height.div_ceil(TILE_PX)]
}

/// Everything but the picture. `draws` of the scene.
pub fn plan(plan: &mut Plan, choices: &Choices, frame: Extent) {
    let bytes = frame.pixel_count() * u64::from(choices.table.samples) * SAMPLE_BYTES;
    plan.buffer("reconstruction", full(SAMPLE_COLORS), bytes);
    plan.buffer("reconstruction", full(SAMPLE_VECTORS), bytes);
    let [across, down] = tiles(frame).map(u64::from);
    plan.buffer("reconstruction", full(BINS), across * down * u64::from(BIN_COUNT) * size_of::<BinBlock>() as u64);
    plan.buffer("reconstruction", full(TILES), across * down * size_of::<TileBlock>() as u64);
    plan.buffer("reconstruction", full(LAYER_MEANS), frame.pixel_count() * MEANS_BYTES);
}

/// The passes, after the resolve. `shaded`: what that one reads; `resolved`: what it leaves.
pub fn plan_passes(plan: &mut Plan, shaded: Vec<(String, Access)>, resolved: &str) {
    let both = |access| [SAMPLE_COLORS, SAMPLE_VECTORS].map(|name| (full(name), access));
    plan.pass(full(samples::PASS), shaded.into_iter().chain(both(Access::ComputeWrite)));
    let [bins, tiles, means] = [BINS, TILES, LAYER_MEANS].map(|name| move |access| (full(name), access));
    plan.pass(full(bins::PASS), both(Access::ComputeRead).into_iter().chain([bins(Access::ComputeWrite)]));
    plan.pass(full(layers::PASS), [bins(Access::ComputeRead), tiles(Access::ComputeWrite)]);
    let summed = [tiles(Access::ComputeRead), means(Access::ComputeWrite)];
    plan.pass(full(means::PASS), both(Access::ComputeRead).into_iter().chain(summed));
    let pictures = [(full(resolved), Access::ComputeRead), (full(COLOR), Access::ComputeWrite)];
    plan.pass(full(filter::PASS), [means(Access::ComputeRead), tiles(Access::ComputeRead)].into_iter().chain(pictures));
}

pub struct Reconstruct {
    gather: Gather,
    bins: Bins,
    layers: Layers,
    means: Means,
    filter: Filter,
    buffers: FilterBuffers,
    /// The picture.
    pub color: Image,
}

impl Reconstruct {
    /// Errors: memory for the upload (exit code 4).
    pub fn new(gpu: &Arc<Gpu>, resources: &mut Resources, choices: &Choices) -> Result<Self> {
        Ok(Self {
            gather: Gather::new(gpu, choices, fetch(choices))?,
            bins: Bins::new(gpu, choices)?,
            layers: Layers::new(gpu, choices)?,
            means: Means::new(gpu, choices)?,
            filter: Filter::new(gpu, choices)?,
            buffers: FilterBuffers::new(resources),
            color: resources.image(&full(COLOR)),
        })
    }

    /// The buffers with entries for each sample or pixel.
    pub fn buffers(&self) -> [&Buffer; 3] {
        [&self.buffers.colors, &self.buffers.vectors, &self.buffers.means]
    }

    /// `resolved`: the picture without the filter.
    pub fn record(
        &self,
        cmd: &mut Commands,
        bound: &[(&'static str, Bound<'_>)],
        shaded: SampleColors<'_>,
        resolved: Edge<'_, Image>,
    ) -> Result<()> {
        let (buffers, extent) = (&self.buffers, resolved.resource.description.extent);
        self.gather.record(cmd, bound, shaded, buffers, extent)?;
        self.bins.record(cmd, bound, buffers, tiles(extent))?;
        self.layers.record(cmd, bound, buffers, tiles(extent))?;
        self.means.record(cmd, bound, buffers, extent)?;
        self.filter.record(cmd, bound, buffers, resolved, &self.color)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_cover_a_frame_that_they_do_not_divide() {
        assert_eq!(tiles(Extent::new(1280, 720)), [80, 45]);
        assert_eq!(tiles(Extent::new(161, 91)), [11, 6]);
        assert_eq!(tiles(Extent::new(1, 16)), [1, 1]);
    }
}
