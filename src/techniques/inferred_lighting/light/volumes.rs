//! Light, a draw a light: over the whole light buffer, or within the rectangle that bounds what the light reaches.
//! Shaders: fullscreen.vert, volumes.frag.
//! reads  geometry.normal, geometry.depth, geometry.extras      writes  light.sums, or light.l_buffer
//!
//! Beyond its range a light adds exactly 0, so what a rectangle leaves out changes no bit of a float sum.

use super::super::NAME;
use super::super::geometry::{LowGeometry, extras_name};
use super::Volumes;
use super::reach::{self, Rectangle};
use crate::error::Result;
use crate::frame::View;
use crate::gpu::pipeline::{Blending, GraphicsDescription, GraphicsPipeline};
use crate::gpu::shader::structs::{LightBlock, VolumesParams};
use crate::gpu::shader::techniques::inferred_lighting::light::volumes::FRAG_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, ColorTarget, Commands, Edge, Gpu, Image, Traffic};
use crate::passes::direct::DirectGpu;
use crate::passes::fullscreen;
use crate::units::Extent;
use ash::vk;
use glam::Vec3;
use std::sync::Arc;

pub struct LightVolumes {
    pipeline: GraphicsPipeline,
    /// The lights that reach something on the screen, in their order, and where.
    drawn: Vec<(u32, Rectangle)>,
    ambient: Vec3,
}

impl LightVolumes {
    /// `constants`: BRDF_KIND and those that `surface.glsl` has beside it. `target_format`: what lights are summed in.
    /// `ambient`: radiance.
    #[allow(clippy::too_many_arguments)]
    pub fn new(
        gpu: &Arc<Gpu>,
        constants: &[(&str, u32)],
        has_extras: bool,
        volumes: Volumes,
        lights: &[LightBlock],
        view: &View,
        extent: Extent,
        target_format: vk::Format,
        ambient: Vec3,
    ) -> Result<Self> {
        let shader = variant(FRAG_VARIANTS, &[extras_name(has_extras)]);
        let formats = [target_format];
        let description =
            GraphicsDescription { constants, blending: Blending::Add, ..fullscreen::description(shader, &formats) };
        let whole = Rectangle { corner_px: [0, 0], extent };
        let rectangle = |light: &LightBlock| match volumes {
            Volumes::Quad | Volumes::Tiled => Some(whole),
            Volumes::Scissor => reach::rectangle(light, view, extent),
        };
        let drawn = lights.iter().enumerate();
        let drawn = drawn.filter_map(|(index, light)| Some((index as u32, rectangle(light)?))).collect();
        Ok(Self { pipeline: GraphicsPipeline::new(gpu, &description)?, drawn, ambient })
    }

    /// Texels times lights that are drawn.
    pub fn evaluations(&self) -> u64 {
        self.drawn.iter().map(|(_, rectangle)| rectangle.extent.pixel_count()).sum()
    }

    /// `frame`: the block of the light buffer's extent. `target`: where lights are summed.
    pub fn record(
        &self,
        cmd: &mut Commands,
        frame: &Buffer,
        lights: &DirectGpu,
        geometry: Edge<'_, LowGeometry>,
        target: &Image,
    ) -> Result<()> {
        let extent = geometry.resource.extent();
        let texel_bytes = u64::from(crate::gpu::image::texel_bytes(target.description.format));
        let traffic = Traffic {
            read_bytes: self.evaluations() * (geometry.resource.lit_bytes() + texel_bytes),
            written_bytes: self.evaluations() * texel_bytes,
            invocations: None,
        };
        cmd.pass(&format!("{NAME}.light"), traffic, |cmd| {
            cmd.barriers(geometry.lit_to(Access::FragmentSample));
            cmd.barriers([target.discard(Access::ColorWrite)]);
            // As lighting.glsl's ambient_lighting: a float times a float, rounded once.
            let [r, g, b] = (std::f32::consts::PI * self.ambient).to_array();
            let ambient = Some(vk::ClearColorValue { float32: [r, g, b, 0.0] });
            cmd.begin_rendering(extent, &[ColorTarget::new(target, ambient)], None);
            for (turn, (light, Rectangle { corner_px, extent })) in self.drawn.iter().enumerate() {
                let params = VolumesParams { light: *light };
                if turn == 0 {
                    let mut bound = geometry.resource.bound(Access::FragmentSample);
                    bound.extend(lights.bound());
                    bound.push(("Frame", Bound::Buffer(frame)));
                    cmd.bind_graphics(&self.pipeline, bytemuck::bytes_of(&params), &bound)?;
                } else {
                    cmd.push(&self.pipeline.interface, bytemuck::bytes_of(&params));
                }
                cmd.set_scissor(*corner_px, *extent);
                fullscreen::draw(cmd, 0);
            }
            cmd.end_rendering();
            Ok(())
        })
    }
}
