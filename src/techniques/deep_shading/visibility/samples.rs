//! What samples see, one entry each.

use crate::error::Result;
use crate::gpu::sampler::Sampler;
use crate::gpu::{Access, AccessSet, Barrier, Bound, Buffer, ColorTarget, Commands, Edge, Gpu, Image, Layers};
use crate::plan::Resources;
use crate::techniques::deep_shading::choices::Choices;
use crate::techniques::deep_shading::resources::{DEPTH, SHADING_DEPTHS, SPIDS, full};
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
            shading_depths: choices.lists.has_zmax.then(|| resources.image(&full(SHADING_DEPTHS))),
            nearest: Sampler::clamped(gpu, vk::Filter::NEAREST)?,
        })
    }

    /// Names the access that touched SPIDs and depths at shading points last.
    pub fn from(&self, access: impl Into<AccessSet>) -> Edge<'_, Self> {
        Edge { resource: self, from: access.into() }
    }

    pub fn sampled<'a>(&'a self, image: &'a Image, access: Access) -> Bound<'a> {
        Bound::Sampled(image, self.nearest.handle, access)
    }

    pub fn shading_depths(&self) -> Option<&Image> {
        self.shading_depths.as_ref()
    }

    /// A thread each: size of a layer, and layers.
    pub fn threads(&self) -> [u32; 3] {
        let extent = self.spids.description.extent;
        [extent.width, extent.height, self.spids.description.layers()]
    }

    pub fn count(&self) -> u64 {
        self.threads().into_iter().map(u64::from).product()
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

impl Edge<'_, Samples> {
    /// SPIDs become readable as `access` says.
    pub fn spids_to(self, access: Access) -> Barrier {
        self.resource.spids.from(self.from).to(access)
    }

    /// SPIDs and, with `--zmax on`, depths at shading points become readable as `access` says.
    pub fn colors_to(self, access: Access) -> impl Iterator<Item = Barrier> {
        self.resource.colors().map(move |image| image.from(self.from).to(access))
    }
}

/// Sets the counters of a frame to 0, for shaders of fragments to count on.
pub fn begin_counters(cmd: &mut Commands, counters: &Buffer) {
    cmd.barriers([counters.discard(Access::TransferWrite)]);
    cmd.clear(counters);
    cmd.barriers([counters.from(Access::TransferWrite).to(Access::FragmentWrite)]);
}
