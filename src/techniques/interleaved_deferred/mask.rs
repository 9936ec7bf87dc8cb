//! Mask: which subset each pixel belongs to, where a test can find it (Segovia 2006, section 3.1). Shaders:
//! fullscreen.vert, mask.frag.
//! writes  mask.stencil  image, 5 B a pixel, with a driver's padding 8 (depth unused), or mask.depth  image, 4 B a pixel

use super::split_method::MaskKind;
use crate::error::Result;
use crate::gpu::pipeline::{GraphicsDescription, GraphicsPipeline, StencilUse};
use crate::gpu::shader::structs::MappingParams;
use crate::gpu::shader::techniques::interleaved_deferred::mask::FRAG_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, AccessSet, Barrier, Commands, Edge, Gpu, Image, Traffic};
use crate::passes::fullscreen;
use crate::plan::{Plan, Resources};
use crate::techniques::interleaved_deferred::resources::NAME;
use ash::vk;
use std::sync::Arc;

impl MaskKind {
    /// The value of the shader's axis MASK, and the resource's name.
    fn name(self) -> &'static str {
        match self {
            Self::Stencil => "stencil",
            Self::Depth => "depth",
        }
    }

    /// Vulkan promises this format with stencil or one of 24 bits; desktop drivers have this one. One of stencil alone is
    /// optional.
    pub fn format(self) -> vk::Format {
        match self {
            Self::Stencil => vk::Format::D32_SFLOAT_S8_UINT,
            Self::Depth => vk::Format::D32_SFLOAT,
        }
    }

    /// Bytes that a test reads of a pixel.
    pub fn tested_bytes(self) -> u64 {
        match self {
            Self::Stencil => 1,
            Self::Depth => 4,
        }
    }

    /// Full name of the image.
    pub fn resource(self) -> String {
        format!("{NAME}.mask.{}", self.name())
    }
}

/// Plans the image and the pass.
pub fn plan(plan: &mut Plan, kind: MaskKind, mapping: &MappingParams) {
    let usage = vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT;
    plan.image("mask", kind.resource(), mapping.extent(), kind.format(), usage);
    plan.pass(format!("{NAME}.mask"), [(kind.resource(), Access::DepthWrite)]);
}

pub struct Mask {
    pub kind: MaskKind,
    pub image: Image,
    pipeline: GraphicsPipeline,
}

impl Edge<'_, Mask> {
    /// Barrier of a pass that tests the mask.
    pub fn to(self, access: Access) -> Barrier {
        self.resource.image.from(self.from).to(access)
    }
}

impl Mask {
    /// Names the access that touched it last.
    pub fn from(&self, access: impl Into<AccessSet>) -> Edge<'_, Self> {
        Edge { resource: self, from: access.into() }
    }

    pub fn new(gpu: &Arc<Gpu>, resources: &mut Resources, kind: MaskKind) -> Result<Self> {
        let description = GraphicsDescription {
            depth_format: Some(kind.format()),
            depth_write: kind == MaskKind::Depth,
            stencil: (kind == MaskKind::Stencil).then_some(StencilUse::Replace),
            ..fullscreen::description(variant(FRAG_VARIANTS, &[kind.name()]), &[])
        };
        let pipeline = GraphicsPipeline::new(gpu, &description)?;
        Ok(Self { kind, image: resources.image(&kind.resource()), pipeline })
    }

    pub fn record(&self, cmd: &mut Commands, mapping: &MappingParams) -> Result<()> {
        // A draw for each bit of the greatest number; depth takes them all at once.
        let bit_count = u32::BITS - (mapping.subset_count() - 1).leading_zeros();
        let pixels = mapping.extent().pixel_count();
        let written_bytes = match self.kind {
            // Each draw writes one bit where it is set: half of the pixels, as good as.
            MaskKind::Stencil => pixels * u64::from(bit_count) / 2,
            MaskKind::Depth => pixels * 4,
        };
        let traffic = Traffic { read_bytes: Some(0), written_bytes: Some(written_bytes), invocations: None };
        cmd.pass(&format!("{NAME}.mask"), traffic, |cmd| {
            cmd.barriers([self.image.discard(Access::DepthWrite)]);
            cmd.begin_rendering(mapping.extent(), &[], Some((&self.image, Some(0.0), Access::DepthWrite)));
            cmd.bind_graphics(&self.pipeline, bytemuck::bytes_of(mapping), &[])?;
            match self.kind {
                MaskKind::Stencil => (0..bit_count).for_each(|bit| {
                    cmd.set_stencil(0xff, 1 << bit);
                    fullscreen::draw(cmd, bit);
                }),
                MaskKind::Depth => fullscreen::draw(cmd, 0),
            }
            cmd.end_rendering();
            Ok(())
        })
    }
}
