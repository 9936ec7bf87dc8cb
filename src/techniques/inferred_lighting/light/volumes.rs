//! Light, a draw a light: over the whole light buffer, within the rectangle that bounds what the light reaches, where its
//! volume meets a surface, or both. Kircher 2009, section 2.2. Shaders: fullscreen.vert, volumes.vert, volumes.frag.
//! reads  geometry.normal, geometry.depth, geometry.extras      writes  light.sums and light.more_sums, or light.l_buffer
//!
//! Beyond its range a light adds exactly 0, so what a rectangle or a volume leaves out changes no bit of a float sum. A volume
//! is counted into the stencil by the depth-fail test, which is right with the eye inside of it too; depth is clamped, so
//! that it may reach beyond the far plane. The draw that lights what was counted sets the stencil back to 0.
//!
//! A light that casts shadow volumes (shadow_volumes.rs) has the stencil for these alone: of `--volumes` it keeps the
//! rectangle.

use super::super::geometry::{LowGeometry, extras_name};
use super::reach::{self, Rectangle};
use super::shadow_volumes::ShadowVolumes;
use super::{LBuffer, Volumes};
use crate::error::Result;
use crate::frame::View;
use crate::gpu::occlusion::Occlusion;
use crate::gpu::pipeline::{Blending, GraphicsDescription, GraphicsPipeline, StencilUse};
use crate::gpu::shader::structs::{LightBlock, VolumesParams};
use crate::gpu::shader::techniques::inferred_lighting::light::volumes::{FRAG_VARIANTS, VERT};
use crate::gpu::shader::{constants_of, variant};
use crate::gpu::{Access, Bound, Buffer, ColorTarget, Commands, Edge, Gpu, Image, Traffic};
use crate::lights::shadow_casters::{CastingLight, ShadowCasters};
use crate::passes::direct::DirectGpu;
use crate::passes::fullscreen;
use crate::plan::Resources;
use crate::techniques::inferred_lighting::resources::NAME;
use crate::units::Extent;
use ash::vk;
use glam::Vec3;
use std::sync::Arc;

/// Corners of volumes.vert's surface.
const VOLUME_VERTICES: u32 = 60;

/// The draw of one light.
#[derive(Clone, Debug)]
struct LightDraw {
    light: u32,
    rectangle: Rectangle,
    mask: Mask,
}

/// Which texels of its rectangle a light is drawn at.
#[derive(Clone, Debug)]
enum Mask {
    All,
    /// Where its volume meets a surface.
    Volume,
    /// Outside of the shadows that it casts.
    Shadows(CastingLight),
}

/// The pipelines of volumes in the stencil.
struct StencilPipelines {
    count: GraphicsPipeline,
    light: GraphicsPipeline,
}

pub struct LightVolumes {
    plain: GraphicsPipeline,
    counted: Option<StencilPipelines>,
    shadows: Option<ShadowVolumes>,
    /// The lights that reach something on the screen, in their order.
    draws: Vec<LightDraw>,
    /// Counts the texels of each.
    occlusion: Option<Occlusion>,
    ambient: Vec3,
}

/// What the draws are made of.
pub struct VolumeSettings<'a> {
    /// The technique's, of which the shader has some.
    pub constants: &'a [(&'static str, u32)],
    pub has_extras: bool,
    /// Depth format of the geometry pass, where lights or shadows are counted in its stencil.
    pub depth_format: Option<vk::Format>,
    pub casters: &'a ShadowCasters,
    /// `--volumes auto`: lights whose rectangle has fewer texels go without the stencil.
    pub least_counted_texels: u64,
    pub l_buffer: LBuffer,
    /// Texels are counted that depth and stencil leave of a light: the device can.
    pub is_counted: bool,
    /// Radiance.
    pub ambient: Vec3,
}

impl LightVolumes {
    /// `extent`: of the light buffer.
    pub fn new(
        gpu: &Arc<Gpu>,
        settings: &VolumeSettings<'_>,
        resources: &mut Resources,
        lights: &[LightBlock],
        view: &View,
        extent: Extent,
    ) -> Result<Self> {
        let l_buffer = settings.l_buffer;
        let shader = variant(FRAG_VARIANTS, &[extras_name(settings.has_extras), l_buffer.targets_axis()]);
        let constants = constants_of(settings.constants, &[Some(shader)]);
        let formats = l_buffer.target_formats();
        let light = |stencil| GraphicsDescription {
            constants: &constants,
            blending: Blending::Add,
            depth_format: settings.depth_format,
            stencil,
            ..fullscreen::description(shader, &formats)
        };
        let counted = if settings.l_buffer.volumes.counts() {
            let count = GraphicsDescription {
                vertex: &VERT,
                fragment: None,
                constants: &[],
                blending: Blending::Keep,
                depth_compare: vk::CompareOp::GREATER,
                depth_clamp: true,
                ..light(Some(StencilUse::CountBehind))
            };
            Some(StencilPipelines {
                count: GraphicsPipeline::new(gpu, &count)?,
                light: GraphicsPipeline::new(gpu, &light(Some(StencilUse::TakeUnequal)))?,
            })
        } else {
            None
        };
        let casting = &settings.casters.lights;
        let shadows = if casting.is_empty() {
            None
        } else {
            Some(ShadowVolumes::new(gpu, resources, settings.casters, &light(None))?)
        };
        let draw = |(index, light): (usize, &LightBlock)| {
            let bounds = reach::rectangle(light, view, extent)?;
            let whole = Rectangle { corner_px: [0, 0], extent };
            let has_end = light.intensity[3] > 0.0;
            let is_large = bounds.extent.pixel_count() >= settings.least_counted_texels;
            let (rectangle, is_counted) = match settings.l_buffer.volumes {
                Volumes::Quad | Volumes::Tiled => (whole, false),
                Volumes::Scissor => (bounds, false),
                Volumes::Stencil => (whole, has_end),
                Volumes::Both => (bounds, has_end),
                Volumes::Auto => (bounds, has_end && is_large),
            };
            let light = index as u32;
            let mask = match casting.binary_search_by_key(&light, |casting| casting.light) {
                Ok(found) => Mask::Shadows(casting[found].clone()),
                Err(_) if is_counted => Mask::Volume,
                Err(_) => Mask::All,
            };
            Some(LightDraw { light, rectangle, mask })
        };
        let draws: Vec<LightDraw> = lights.iter().enumerate().filter_map(draw).collect();
        let is_counted = settings.is_counted && !draws.is_empty();
        let occlusion = is_counted.then(|| Occlusion::new(gpu, draws.len() as u32)).transpose()?;
        let plain = GraphicsPipeline::new(gpu, &light(None))?;
        Ok(Self { plain, counted, shadows, draws, occlusion, ambient: settings.ambient })
    }

    /// Texels times lights that are drawn, whatever the stencil leaves of them.
    fn drawn_texels(&self) -> u64 {
        self.draws.iter().map(|draw| draw.rectangle.extent.pixel_count()).sum()
    }

    /// Those that the last frame evaluated; all that are drawn where the device counts none.
    ///
    /// Errors: the device is lost (exit code 4).
    pub fn evaluations(&self) -> Result<u64> {
        self.occlusion.as_ref().map_or_else(|| Ok(self.drawn_texels()), Occlusion::sum)
    }

    /// Lights whose volumes are counted.
    pub fn counted_lights(&self) -> usize {
        self.draws.iter().filter(|draw| matches!(draw.mask, Mask::Volume)).count()
    }

    /// `frame`: the block of the light buffer's extent. `targets`: where lights are summed.
    pub fn record(
        &self,
        cmd: &mut Commands,
        frame: &Buffer,
        lights: &DirectGpu,
        geometry: Edge<'_, LowGeometry>,
        targets: &[Image],
    ) -> Result<()> {
        let extent = geometry.resource.extent();
        let bytes_of = |target: &Image| u64::from(crate::gpu::image::texel_bytes(target.description.format));
        let texel_bytes: u64 = targets.iter().map(bytes_of).sum();
        let traffic = Traffic {
            read_bytes: Some(self.drawn_texels() * (geometry.resource.lit_bytes() + texel_bytes)),
            written_bytes: Some(self.drawn_texels() * texel_bytes),
            invocations: None,
        };
        cmd.pass(&format!("{NAME}.light"), traffic, |cmd| {
            let has_stencil = self.counted.is_some() || self.shadows.is_some();
            let depth_access = if has_stencil { Access::StencilWrite } else { Access::FragmentSample };
            cmd.barriers(geometry.lit_with_depth_to(Access::FragmentSample, depth_access));
            cmd.barriers(targets.iter().map(|target| target.discard(Access::ColorWrite)));
            // As lighting.glsl's ambient_lighting: a float times a float, rounded once.
            let [r, g, b] = (std::f32::consts::PI * self.ambient).to_array();
            let ambient = Some(vk::ClearColorValue { float32: [r, g, b, 0.0] });
            let dark = Some(vk::ClearColorValue { float32: [0.0; 4] });
            let colors = targets.iter().zip([ambient, dark]).map(|(target, clear)| ColorTarget::new(target, clear));
            let colors: Vec<_> = colors.collect();
            let depth = has_stencil.then_some((&geometry.resource.depth, None, depth_access));
            if let Some(occlusion) = &self.occlusion {
                occlusion.reset(cmd.buffer());
            }
            cmd.begin_rendering(extent, &colors, depth);
            let mut bound = geometry.resource.bound_with_depth(Access::FragmentSample, depth_access);
            bound.extend(lights.bound());
            bound.push(("Frame", Bound::Buffer(frame)));
            self.draw(cmd, &bound, frame, lights)?;
            cmd.end_rendering();
            Ok(())
        })
    }

    /// Inside rendering.
    fn draw(
        &self,
        cmd: &mut Commands,
        bound: &[(&'static str, Bound<'_>)],
        frame: &Buffer,
        lights: &DirectGpu,
    ) -> Result<()> {
        let plain_set = cmd.set_for(&self.plain, bound)?;
        let counted_sets = match &self.counted {
            Some(StencilPipelines { count, light }) => {
                let places = [("Frame", Bound::Buffer(frame)), ("Lights", Bound::Buffer(&lights.lights))];
                Some((count, cmd.set_for(count, &places)?, light, cmd.set_for(light, bound)?))
            }
            None => None,
        };
        let shadow_sets = self.shadows.as_ref().map(|shadows| shadows.sets(cmd, bound, frame, lights)).transpose()?;
        for (index, LightDraw { light, rectangle, mask }) in self.draws.iter().enumerate() {
            let params = VolumesParams { light: *light };
            let params = bytemuck::bytes_of(&params);
            cmd.set_scissor(rectangle.corner_px, rectangle.extent);
            match (mask, counted_sets, &self.shadows, shadow_sets) {
                (Mask::Shadows(casting), _, Some(shadows), Some(sets)) => {
                    shadows.draw(cmd, casting, sets, params);
                }
                (Mask::Volume, Some((count, count_set, light, light_set)), ..) => {
                    cmd.bind_with_set(count, params, count_set);
                    cmd.set_stencil(0, 0xff);
                    draw_volume(cmd);
                    cmd.bind_with_set(light, params, light_set);
                    cmd.set_stencil(0, 0xff);
                }
                _ => cmd.bind_with_set(&self.plain, params, plain_set),
            }
            match &self.occlusion {
                Some(occlusion) => occlusion.count(cmd.buffer(), index as u32, || fullscreen::draw(cmd, 0)),
                None => fullscreen::draw(cmd, 0),
            }
        }
        Ok(())
    }
}

/// The light's volume, both sides of it, inside rendering.
fn draw_volume(cmd: &Commands) {
    let (device, buffer) = (&cmd.gpu().device, cmd.buffer());
    // SAFETY: the buffer is being recorded inside rendering; the stage reads no vertex buffer.
    unsafe {
        device.cmd_set_cull_mode(buffer, vk::CullModeFlags::NONE);
        device.cmd_set_front_face(buffer, vk::FrontFace::COUNTER_CLOCKWISE);
        device.cmd_draw(buffer, VOLUME_VERTICES, 1, 0, 0);
    }
}
