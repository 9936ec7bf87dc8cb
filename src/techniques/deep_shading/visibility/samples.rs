//! What samples see, one entry each, and what is drawn for them.

use crate::error::Result;
use crate::gpu::sampler::Sampler;
use crate::gpu::{Access, Bound, Buffer, ColorTarget, Commands, Gpu, Image, Layers};
use crate::plan::Resources;
use crate::resident::{DrawList, SceneGpu};
use crate::techniques::deep_shading::choices::Choices;
use crate::techniques::deep_shading::primitives::Primitives;
use crate::techniques::deep_shading::resources::{DEPTH, SHADING_DEPTHS, SPIDS, full};
use crate::techniques::deep_shading::tuples::TupleTable;
use crate::units::Extent;
use ash::vk;
use std::sync::Arc;

/// One entry a sample.
pub struct Samples {
    pub spids: Image,
    /// Depth buffer of rasterised samples.
    pub depth: Option<Image>,
    /// How SPIDs and depths at shading points were written.
    pub written: Access,
    /// With `--zmax on`.
    shading_depths: Option<Image>,
    /// Texels are fetched: it only has to be there.
    nearest: Sampler,
}

impl Samples {
    pub fn new(gpu: &Arc<Gpu>, resources: &mut Resources, choices: &Choices) -> Result<Self> {
        Ok(Self {
            spids: resources.image(&full(SPIDS)),
            depth: choices.has_depth().then(|| resources.image(&full(DEPTH))),
            written: choices.visibility.writes(),
            shading_depths: choices.has_zmax.then(|| resources.image(&full(SHADING_DEPTHS))),
            nearest: Sampler::clamped(gpu, vk::Filter::NEAREST)?,
        })
    }

    pub fn sampled<'a>(&'a self, image: &'a Image, access: Access) -> Bound<'a> {
        Bound::Sampled(image, self.nearest.handle, access)
    }

    pub fn shading_depths(&self) -> Option<&Image> {
        self.shading_depths.as_ref()
    }

    pub(super) fn bytes(&self) -> u64 {
        let images = [Some(&self.spids), self.depth.as_ref(), self.shading_depths.as_ref()];
        images.into_iter().flatten().map(|image| image.description.bytes()).sum()
    }

    pub(super) fn colors(&self) -> impl Iterator<Item = &Image> {
        std::iter::once(&self.spids).chain(self.shading_depths())
    }

    /// Opens rendering into `layers`, and clears them.
    pub(super) fn begin(&self, cmd: &mut Commands, layers: Layers) {
        // No triangle; and the depth of nothing, which no list hears of.
        let cleared = Some(vk::ClearColorValue { uint32: [u32::MAX; 4] });
        let targets: Vec<_> = self.colors().map(|image| ColorTarget::new(image, cleared)).collect();
        let depth = self.depth.as_ref().map(|depth| (depth, Some(0.0), Access::DepthWrite));
        cmd.begin_layers(self.spids.description.extent, layers, &targets, depth);
    }
}

/// What is drawn, and where.
#[derive(Clone, Copy)]
pub struct DrawInputs<'a> {
    pub scene: &'a SceneGpu,
    pub list: &'a DrawList,
    pub primitives: &'a Primitives,
    pub table: &'a TupleTable,
    pub frame: Extent,
}

/// Sets the counters of a frame to 0, for shaders of fragments to count on.
pub fn begin_counters(cmd: &mut Commands, counters: &Buffer) {
    cmd.barriers([counters.discard(Access::TransferWrite)]);
    cmd.clear(counters);
    cmd.barriers([counters.from(Access::TransferWrite).to(Access::FragmentWrite)]);
}
