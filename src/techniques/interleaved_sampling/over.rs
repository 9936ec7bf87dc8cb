//! Over: a layer, light of its own and how much it hides, over an image of the same extent, by fixed-function blending. Shader:
//! over.frag. Part of the pass `slices`.
//! reads  a layer, premultiplied      writes  what it is laid over

use crate::error::Result;
use crate::gpu::pipeline::{Blending, GraphicsDescription, GraphicsPipeline};
use crate::gpu::sampler::Sampler;
use crate::gpu::shader::techniques::interleaved_sampling::over::FRAG;
use crate::gpu::{Access, Bound, ColorTarget, Commands, Gpu, Image};
use crate::passes::fullscreen;
use ash::vk;
use std::sync::Arc;

/// No light, and nothing hidden.
pub const NOTHING: vk::ClearColorValue = vk::ClearColorValue { float32: [0.0; 4] };

pub struct Over {
    pipeline: GraphicsPipeline,
    sampler: Sampler,
}

impl Over {
    /// Over images of `format`: pictures, whose alpha stays (`Blending::Over`), or other layers (`Blending::Layer`).
    ///
    /// Errors: the driver refuses (exit code 4).
    pub fn new(gpu: &Arc<Gpu>, format: vk::Format, blending: Blending) -> Result<Self> {
        let formats = [format];
        let description = GraphicsDescription { blending, ..fullscreen::description(&FRAG, &formats) };
        let pipeline = GraphicsPipeline::new(gpu, &description)?;
        Ok(Self { pipeline, sampler: Sampler::clamped(gpu, vk::Filter::NEAREST)? })
    }

    /// Lays `layer`, which fragments may sample, over `target`, which stands as colours are written.
    ///
    /// Errors: the driver has no more room for sets (exit code 4).
    pub fn lay(&self, cmd: &mut Commands, layer: &Image, target: ColorTarget<'_>) -> Result<()> {
        cmd.begin_rendering(target.image.description.extent, &[target], None);
        let bound = [("layer", Bound::Sampled(layer, self.sampler.handle, Access::FragmentSample))];
        cmd.bind_graphics(&self.pipeline, &[], &bound)?;
        fullscreen::draw(cmd, 0);
        cmd.end_rendering();
        Ok(())
    }
}
