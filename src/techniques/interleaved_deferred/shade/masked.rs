//! n x m draws over the frame, each shading the pixels of its subset, which a stencil or depth test lets pass: Segovia
//! 2006, section 3.1. Shaders: fullscreen.vert, masked.frag.
//! reads   the G-buffer, the lights, mask.stencil or mask.depth
//! writes  shade.irradiance  buffer, frame order, 8 B a pixel, by way of shade.drawn

use super::super::choices::Choices;
use super::super::drawn_irradiance::{self, DrawnIrradiance};
use super::super::mask::Mask;
use super::super::split_method::MaskKind;
use super::ShadeGpu;
use crate::error::Result;
use crate::gpu::pipeline::{GraphicsDescription, GraphicsPipeline, StencilUse};
use crate::gpu::shader::techniques::interleaved_deferred::shade::masked::FRAG_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Buffer, Commands, Edge, Gpu, Traffic};
use crate::passes::direct::DirectGpu;
use crate::passes::fullscreen;
use crate::passes::gbuffer::GBuffer;
use crate::plan::Resources;
use crate::techniques::interleaved_deferred::resources::NAME;
use ash::vk;
use std::sync::Arc;

/// Which pixels a draw shades, and what it leaves of them.
pub struct Masked<'a> {
    pub mask: Edge<'a, Mask>,
    pub irradiance: &'a Buffer,
}

pub struct ShadeMasked {
    pipeline: GraphicsPipeline,
    drawn: DrawnIrradiance,
}

impl ShadeMasked {
    pub fn new(gpu: &Arc<Gpu>, resources: &mut Resources, choices: &Choices, kind: MaskKind) -> Result<Self> {
        let shader = variant(FRAG_VARIANTS, &choices.shade_axes());
        let formats = [drawn_irradiance::FORMAT];
        let (compare, stencil) = match kind {
            MaskKind::Stencil => (vk::CompareOp::ALWAYS, Some(StencilUse::RequireEqual)),
            MaskKind::Depth => (vk::CompareOp::EQUAL, None),
        };
        let description = GraphicsDescription {
            constants: &choices.irradiance_constants(),
            depth_format: Some(kind.format()),
            depth_compare: compare,
            stencil,
            ..fullscreen::description(shader, &formats)
        };
        let pipeline = GraphicsPipeline::new(gpu, &description)?;
        Ok(Self { pipeline, drawn: DrawnIrradiance::new(resources, "shade") })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        frame: &Buffer,
        shade: &ShadeGpu,
        direct: &DirectGpu,
        gbuffer: Edge<'_, GBuffer>,
        masked: Masked<'_>,
    ) -> Result<()> {
        let Masked { mask, irradiance } = masked;
        let (mapping, pixels) = (shade.mapping(), gbuffer.resource.extent().pixel_count());
        let tested_bytes = u64::from(mapping.subset_count()) * pixels * mask.resource.kind.tested_bytes();
        let traffic = Traffic {
            // Every draw tests every pixel; each pixel is shaded once.
            read_bytes: shade.read_bytes(direct, mapping.subset_count(), pixels, pixels).map(|bytes| {
                pixels * gbuffer.resource.parts_bytes(shade.parts) + bytes + tested_bytes + self.drawn.bytes()
            }),
            written_bytes: Some(pixels * 8 + self.drawn.bytes()),
            invocations: None,
        };
        cmd.pass(&format!("{NAME}.shade"), traffic, |cmd| {
            cmd.barriers(gbuffer.parts_to(shade.parts, Access::FragmentSample));
            cmd.barriers([mask.to(Access::DepthTest)]);
            cmd.barriers(shade.hidden_to(Access::GraphicsRead));
            let mut bound = shade.bound(frame, direct);
            bound.extend(gbuffer.resource.bound_parts(shade.parts));
            let depth = Some((&mask.resource.image, None, Access::DepthTest));
            self.drawn.record(cmd, mapping, depth, irradiance, |cmd| {
                cmd.bind_graphics(&self.pipeline, bytemuck::bytes_of(&shade.params), &bound)?;
                for subset in 0..mapping.subset_count() {
                    if mask.resource.kind == MaskKind::Stencil {
                        cmd.set_stencil(subset, 0);
                    }
                    fullscreen::draw(cmd, subset);
                }
                Ok(())
            })
        })
    }
}
