//! Shadow maps of every punctual light (Clarberg & Munkberg 2014, section 6: all lights of their scenes have one, of
//! 1024 x 1024 with one sample a texel, drawn anew each frame). Shaders: shadow_maps.vert and, for MASK surfaces,
//! shadow_maps.frag; shadow_maps.glsl reads them.
//! reads   the scene, where the caller says that its draws stand
//! writes  TECHNIQUE.shadow_maps.depth  array of images, 4 B a texel; beside it TECHNIQUE.shadow_maps.blocks, kept
//!
//! A spot has one map of its cone, a directional light one around the box of all that is drawn, a point light the six faces
//! of a cube. Depth is reversed: 1 at the near plane, 0 at the far one, which is where the light ends or the box does.
//! Solid surfaces cast from both sides, as they stop shadow rays; MASK surfaces have their holes; BLEND surfaces cast
//! nothing. What is nearer to a light than a thousandth of the far plane casts nothing either.
//!
//! Maps are drawn in every frame, or once (`--shadow-maps once`): then `ShadowMaps::draw_once` draws them before the first, and
//! the calls below do what is left.
//!
//! A frame takes three calls: `MapLayout::plan` where the technique plans its passes, `ShadowMaps::record` where it
//! records them, and `ShadowMaps::bound` for shaders of the axis SHADOWS=mapped, after `ShadowMaps::barrier`; pipelines of
//! such shaders get the constants of `MapLayout::constants`, lights their indices from `direct::light_blocks`. While a
//! shutter is open there is one moment that maps are of, the caller's: in the middle of the exposure.
//!
//! Why this way: a layer is drawn by itself, because not every driver takes the layer from a vertex stage (and where one
//! does, it was slower); cubes are layers of the same array, so that one binding serves every light. Depth that is pushed
//! away by a slope's part of it, in the rasteriser, cannot detach a shadow by more than as many texels, however steep the
//! surface; metres along the ray to the light are added where it is asked, because they mean the same at every distance.

mod casters;
mod format;
mod layout;
pub mod projection;

pub use casters::CasterPipelines;
pub use format::FORMAT;
pub use layout::MapLayout;

use super::mesh;
use crate::caps::{Ability, Need};
use crate::error::Result;
use crate::gpu::commands::Submits;
use crate::gpu::sampler::Sampler;
use crate::gpu::{Access, AccessSet, Barrier, Bound, Buffer, Commands, Edge, Gpu, Image, Layers, Traffic, upload};
use crate::plan::Resources;
use crate::resident::{DrawList, SceneGpu};
use crate::scene::Scene;
use crate::settings::{MapFilter, Values};
use ash::vk;
use format::{blocks_name, depth_name, pass, views_name};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The value of the shaders' axis SHADOWS.
pub fn axis(has_shadow_maps: bool) -> &'static str {
    if has_shadow_maps { "mapped" } else { "traced" }
}

/// What `values` need of a device, whether maps are drawn or not.
pub fn needs(values: &Values) -> Option<Need> {
    let of = "--shadow-filter bilinear";
    let instead = "--shadow-filter gather makes the same picture everywhere";
    values.is("shadow-filter", MapFilter::Bilinear).then(|| Need {
        of: of.to_owned(),
        ability: Ability::FilteredDepth,
        instead,
    })
}

pub struct ShadowMaps {
    pipelines: CasterPipelines,
    /// What is drawn into each layer.
    casters: Vec<DrawList>,
    depth: Image,
    blocks: Buffer,
    views: Buffer,
    sampler: Sampler,
    /// Whether they are drawn once, and not in frames.
    is_once: bool,
}

impl ShadowMaps {
    /// Takes out what `layout` planned. `posed`: the scene as its draws stand in the maps, whose boxes say what a map may
    /// hold; other places of `scene`'s own draws.
    pub fn new(
        gpu: &Arc<Gpu>,
        resources: &mut Resources,
        technique: &str,
        layout: &MapLayout,
        posed: &Scene,
        scene: &SceneGpu,
    ) -> Result<Self> {
        let casters = layout.views.iter().map(|view| DrawList::of_casters(posed, scene, view, layout.casters));
        let maps = Self {
            pipelines: CasterPipelines::new(gpu, scene, layout.slope_bias_px)?,
            casters: casters.collect(),
            depth: resources.image(&depth_name(technique)),
            blocks: resources.buffer(&blocks_name(technique)),
            views: resources.buffer(&views_name(technique)),
            sampler: sampler(gpu, layout.filter)?,
            is_once: layout.is_once,
        };
        maps.see_from(gpu, layout)?;
        Ok(maps)
    }

    /// Has the maps drawn next seen as `layout` has them, which is of as many lights of the same kinds.
    ///
    /// Errors: memory for the upload (exit code 4).
    pub fn see_from(&self, gpu: &Arc<Gpu>, layout: &MapLayout) -> Result<()> {
        let readers = Access::ComputeRead | Access::GraphicsRead;
        upload::buffer(gpu, &self.blocks, bytemuck::cast_slice(&layout.blocks), readers)?;
        upload::buffer(gpu, &self.views, bytemuck::cast_slice(&layout.clips()), Access::GraphicsRead)
    }

    /// Draws all maps anew, where every frame does. `scene`: as it stands in them, here and in `draw_once`.
    pub fn record(&self, cmd: &mut Commands, technique: &str, scene: &SceneGpu) -> Result<()> {
        if self.is_once { Ok(()) } else { self.record_all(cmd, technique, scene) }
    }

    /// Draws all maps before the first frame, and leaves them to fragments and compute shaders, where frames do not; the pass, and
    /// how long it took, nanoseconds.
    ///
    /// Errors: the device is lost or out of memory (exit code 4).
    pub fn draw_once(&self, gpu: &Arc<Gpu>, technique: &str, scene: &SceneGpu) -> Result<Option<(String, u64)>> {
        if !self.is_once {
            return Ok(None);
        }
        let mut cmd = Commands::begin(gpu, &pass(technique), Submits::One)?;
        self.record_all(&mut cmd, technique, scene)?;
        cmd.barriers([self.depth.from(Access::DepthWrite).to(Access::FragmentSample)]);
        cmd.barriers([self.depth.from(Access::FragmentSample).to(Access::ComputeSample)]);
        let recorded = cmd.finish()?;
        Ok(Some((pass(technique), recorded.run()?.figure_ns(recorded.clock()))))
    }

    fn record_all(&self, cmd: &mut Commands, technique: &str, scene: &SceneGpu) -> Result<()> {
        let traffic = Traffic {
            read_bytes: self.casters.iter().map(mesh::depth_bytes).sum(),
            written_bytes: Some(self.depth.description.bytes()),
            invocations: None,
        };
        cmd.pass(&pass(technique), traffic, |cmd| {
            cmd.barriers([self.depth.discard(Access::DepthWrite)]);
            let sets = self.pipelines.sets(cmd, scene, &self.views)?;
            for (layer, casters) in (0u32..).zip(&self.casters) {
                let target = (&self.depth, Some(0.0), Access::DepthWrite);
                cmd.begin_layers(self.depth.description.extent, Layers::One(layer), &[], Some(target));
                mesh::bind_streams(cmd, scene);
                self.pipelines.draw(cmd, scene, &sets, layer, casters);
                cmd.end_rendering();
            }
            Ok(())
        })
    }

    /// Names the access that touched them last: `Access::DepthWrite`, where they are drawn, or that of a pass that reads them.
    pub fn from(&self, access: impl Into<AccessSet>) -> Edge<'_, Self> {
        Edge { resource: self, from: access.into() }
    }

    /// What shadow_maps.glsl declares.
    pub fn bound(&self) -> [(&'static str, Bound<'_>); 2] {
        let maps = Bound::Sampled(&self.depth, self.sampler.handle, Access::FragmentSample);
        [("ShadowMaps", Bound::Buffer(&self.blocks)), ("shadow_maps", maps)]
    }

    /// Numbers for the report's `counters`: maps, and triangles that are drawn into all of them together.
    pub fn counters(&self) -> BTreeMap<&'static str, f64> {
        let triangles: u64 = self.casters.iter().map(DrawList::triangles_drawn).sum();
        BTreeMap::from([("shadow_maps", self.casters.len() as f64), ("shadow_map_triangles_drawn", triangles as f64)])
    }
}

impl Edge<'_, ShadowMaps> {
    /// Barrier of a pass whose fragments, or threads, read the maps. Maps that are drawn once need none.
    pub fn to(self, access: Access) -> Option<Barrier> {
        let maps = self.resource;
        (!maps.is_once).then(|| maps.depth.from(self.from).to(access))
    }
}

/// Light passes where a point is as near to it as what the map holds, or nearer.
fn sampler(gpu: &Arc<Gpu>, filter: MapFilter) -> Result<Sampler> {
    let edge = vk::SamplerAddressMode::CLAMP_TO_EDGE;
    let texels = if filter == MapFilter::Bilinear { vk::Filter::LINEAR } else { vk::Filter::NEAREST };
    let info = vk::SamplerCreateInfo::default()
        .mag_filter(texels)
        .min_filter(texels)
        .address_mode_u(edge)
        .address_mode_v(edge)
        .address_mode_w(edge)
        .compare_enable(true)
        .compare_op(vk::CompareOp::GREATER_OR_EQUAL);
    Sampler::new(gpu, "sampler.shadow_maps", &info)
}
