//! Each sub-buffer with its own lights, by draws, as in the paper: a viewport on it, or a quad. Segovia 2006, section 4.3.
//! Shaders: fullscreen.vert or, for quads, drawn.vert; drawn.frag.
//! reads  split.position, split.normal, split.color where surfaces are glossy  images, the lights      writes  shade.irradiance  an image, 8 B a texel

use super::super::choices::Choices;
use super::super::split_method::ShadeBy;
use super::super::sub_buffers::{Surface, Texels, texel_bytes, words_format};
use super::ShadeGpu;
use crate::error::Result;
use crate::gpu::pipeline::{GraphicsDescription, GraphicsPipeline};
use crate::gpu::shader::techniques::interleaved_deferred::shade::drawn::{FRAG_VARIANTS, VERT};
use crate::gpu::shader::variant;
use crate::gpu::{Access, Buffer, ColorTarget, Commands, Edge, Gpu, Traffic};
use crate::passes::direct::DirectGpu;
use crate::passes::fullscreen;
use crate::techniques::interleaved_deferred::resources::NAME;
use crate::units::Extent;
use std::sync::Arc;

pub struct ShadeDrawn {
    pipeline: GraphicsPipeline,
    is_quad: bool,
    texel_bytes: u64,
}

impl ShadeDrawn {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices) -> Result<Self> {
        let is_quad = choices.shade_by == ShadeBy::Quad;
        let shader = variant(FRAG_VARIANTS, &choices.shade_axes());
        let formats = [words_format(8)];
        let plain = fullscreen::description(shader, &formats);
        let description = GraphicsDescription {
            vertex: if is_quad { &VERT } else { plain.vertex },
            constants: &choices.irradiance_constants(),
            ..plain
        };
        let pipeline = GraphicsPipeline::new(gpu, &description)?;
        Ok(Self { pipeline, is_quad, texel_bytes: texel_bytes(choices.shaded(), choices.shading.position) })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        frame: &Buffer,
        shade: &ShadeGpu,
        direct: &DirectGpu,
        split: Edge<'_, Surface>,
        irradiance: &Texels,
    ) -> Result<()> {
        let mapping = shade.mapping();
        let texels = mapping.texel_count();
        let light_bytes = shade.read_bytes(direct, mapping.subset_count(), texels, texels);
        let traffic = Traffic {
            read_bytes: light_bytes.map(|bytes| texels * self.texel_bytes + bytes),
            written_bytes: Some(texels * 8),
            invocations: None,
        };
        cmd.pass(&format!("{NAME}.shade"), traffic, |cmd| {
            cmd.barriers(split.to(shade.parts, Access::FragmentSample));
            cmd.barriers(shade.hidden_to(Access::GraphicsRead));
            cmd.barriers([irradiance.discard(Access::ColorWrite)]);
            let mut bound = shade.bound(frame, direct);
            bound.extend(split.resource.source(shade.parts));
            // Every texel is drawn: a clear spares the load.
            let target = ColorTarget::new(irradiance.attachment(), Some(Default::default()));
            cmd.begin_rendering(mapping.padded(), &[target], None);
            cmd.bind_graphics(&self.pipeline, bytemuck::bytes_of(&shade.params), &bound)?;
            for subset in 0..mapping.subset_count() {
                if self.is_quad {
                    fullscreen::draw_quad(cmd, subset);
                    continue;
                }
                let sub_buffer = Extent::new(mapping.sub_width_px, mapping.sub_height_px);
                cmd.set_window(mapping.tiled_of([0, 0, subset]), sub_buffer);
                fullscreen::draw(cmd, subset);
            }
            cmd.end_rendering();
            Ok(())
        })
    }
}
