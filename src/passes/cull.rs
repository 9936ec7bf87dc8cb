//! Tiled culling: a mask of punctual lights for each tile of 16x16 pixels. Shader: cull.comp.
//! reads  the G-buffer, the lights      writes  cull.masks  buffer, one bit a light, tiles in row order
//!
//! Beyond its range a light adds exactly 0, so a mask that leaves it out changes no bit of the picture.

use crate::caps::Caps;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::passes::cull::COMP_VARIANTS;
use crate::gpu::shader::passes::cull::TILE_PX;
use crate::gpu::shader::passes::tile_masks::THREADS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Barrier, Bound, Buffer, Commands, Edge, Gpu, Traffic, readback};
use crate::passes::gbuffer::GBuffer;
use crate::plan::Plan;
use crate::settings::{CullBy, PositionStorage, Values};
use crate::units::Extent;
use std::sync::Arc;

impl CullBy {
    /// As `--cull-by` says it; `auto`: an invocation on software drivers (Mesa 22.3.6, 81 lamps at
    /// 1280x720: by a workgroup a frame takes 1.12 times as long, 1.06 to 1.19).
    pub fn new(values: &Values, caps: &Caps) -> Self {
        let best = if caps.identity.is_software() { Self::Invocation } else { Self::Workgroup };
        values.unless_auto("cull-by", Values::choice).unwrap_or(best)
    }
}

/// Bytes of the masks.
fn mask_bytes(extent: Extent, light_count: u32) -> u64 {
    tile_count(extent) * u64::from(light_count.div_ceil(32)) * 4
}

/// Tiles side by side, and one above the other.
fn tiles(extent: Extent) -> [u32; 2] {
    [extent.width.div_ceil(TILE_PX), extent.height.div_ceil(TILE_PX)]
}

fn tile_count(extent: Extent) -> u64 {
    let [x, y] = tiles(extent);
    u64::from(x) * u64::from(y)
}

/// Plans the masks, as a resource of `technique`.
pub fn plan(plan: &mut Plan, technique: &str, extent: Extent, light_count: u32) {
    plan.buffer("lights", format!("{technique}.cull.masks"), mask_bytes(extent, light_count));
}

/// The masks, as `access` touches them.
pub fn masks(technique: &str, access: Access) -> (String, Access) {
    (format!("{technique}.cull.masks"), access)
}

/// What culling left, counted after a frame: pixels times lights that were evaluated, and that were left out.
///
/// A pixel counts with every light of its tile's mask, whether or not it shows a surface. Errors: memory for the copy
/// (exit code 4).
pub fn evaluations(gpu: &Arc<Gpu>, masks: &Buffer, extent: Extent, light_count: u32) -> Result<[u64; 2]> {
    let bytes = readback::buffer(gpu, masks, mask_bytes(extent, light_count), Access::ComputeRead)?;
    let tiles_x = extent.width.div_ceil(TILE_PX);
    let side = |tile: u32, length: u32| u64::from((length - tile * TILE_PX).min(TILE_PX));
    let of_tile = |(index, mask): (usize, &[u8])| {
        let (x, y) = (index as u32 % tiles_x, index as u32 / tiles_x);
        let lights: u32 = mask.iter().map(|byte| byte.count_ones()).sum();
        side(x, extent.width) * side(y, extent.height) * u64::from(lights)
    };
    let words = light_count.div_ceil(32) as usize;
    let evaluated = bytes.chunks_exact(4 * words).enumerate().map(of_tile).sum();
    Ok([evaluated, extent.pixel_count() * u64::from(light_count) - evaluated])
}

/// The surface whose tiles get masks.
pub struct CullSurface<'a> {
    pub extent: Extent,
    /// What the pipeline reads of a pixel.
    pub texel_bytes: u64,
    /// Barriers that make it readable by compute shaders.
    pub barriers: Vec<Barrier>,
    pub bound: Vec<(&'static str, Bound<'a>)>,
}

/// A pipeline of lights/tile_masks.glsl.
pub struct MaskPipeline {
    pub pipeline: ComputePipeline,
    pub by: CullBy,
}

/// The punctual lights that masks are made of.
#[derive(Clone, Copy)]
pub struct CullLights<'a> {
    pub blocks: &'a Buffer,
    pub count: u32,
}

/// Records the pass `TECHNIQUE.cull`. `frame`: of the surface's extent.
pub fn record(
    cmd: &mut Commands,
    technique: &str,
    MaskPipeline { pipeline, by }: &MaskPipeline,
    surface: CullSurface<'_>,
    frame: &Buffer,
    lights: CullLights<'_>,
    masks: &Buffer,
) -> Result<()> {
    let CullSurface { extent, texel_bytes, barriers, mut bound } = surface;
    let light_count = lights.count;
    let threads = match (by, tiles(extent)) {
        (CullBy::Invocation, [x, y]) => [x * y, 1, 1],
        (CullBy::Workgroup, [x, y]) => [x * THREADS, y, 1],
    };
    let traffic = Traffic {
        read_bytes: Some(
            extent.pixel_count() * texel_bytes
                + tile_count(extent)
                    * u64::from(light_count)
                    * size_of::<crate::gpu::shader::structs::LightBlock>() as u64,
        ),
        written_bytes: Some(mask_bytes(extent, light_count)),
        invocations: Some(threads.into_iter().map(u64::from).product()),
    };
    cmd.pass(&format!("{technique}.cull"), traffic, |cmd| {
        cmd.barriers(barriers);
        cmd.barriers([masks.discard(Access::ComputeWrite)]);
        bound.extend([
            ("Frame", Bound::Buffer(frame)),
            ("Lights", Bound::Buffer(lights.blocks)),
            ("LightMasks", Bound::Buffer(masks)),
        ]);
        let groups = pipeline.groups(threads);
        cmd.dispatch(pipeline, &[], &bound, groups)
    })
}

/// The pass over a G-buffer.
pub struct Cull {
    masks: MaskPipeline,
}

impl Cull {
    pub fn new(gpu: &Arc<Gpu>, position: PositionStorage, by: CullBy) -> Result<Self> {
        let shader = variant(COMP_VARIANTS, &[position.name(), by.name()]);
        Ok(Self { masks: MaskPipeline { pipeline: ComputePipeline::new(gpu, shader, &[])?, by } })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        technique: &str,
        gbuffer: Edge<'_, GBuffer>,
        frame: &Buffer,
        lights: CullLights<'_>,
        masks: &Buffer,
    ) -> Result<()> {
        let surface = CullSurface {
            extent: gbuffer.resource.extent(),
            texel_bytes: gbuffer.resource.surface_bytes(),
            barriers: gbuffer.surface_to_sampled(),
            bound: gbuffer.resource.bound_surface(),
        };
        record(cmd, technique, &self.masks, surface, frame, lights, masks)
    }
}
