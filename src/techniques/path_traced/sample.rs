//! Sample: one path a pixel, added to those before it. Shader: sample.comp.
//! reads  the whole tree or a structure over it, the traced scene, the lights      writes  path_traced.sums  buffer, four floats a pixel, kept
//! from run to run, and path_traced.color  image, RGBA32F, frame extent: the mean so far

use super::airlight::Air;
use crate::bvh::Bvh;
use crate::bvh::nodes::Nodes;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::structs::{FrameBlock, LightBlock, SampleParams, SourceBlock};
use crate::gpu::shader::techniques::path_traced::path::{AMBIENT_ADDED, AMBIENT_FOUND, AMBIENT_FOUND_ONCE};
use crate::gpu::shader::techniques::path_traced::sample::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Gpu, Image, Traffic, upload};
use crate::plan::Resources;
use crate::progress::Stage;
use crate::resident::traced::{Layout, TracedGpu};
use crate::resident::volume::{PlacedVolume, VolumeGpu};
use crate::shading::medium::Medium;
use crate::techniques::Inputs;
use crate::techniques::path_traced::resources::{COLOR, NAME, SUMS};
use crate::techniques::path_traced::settings::AmbientVisibility;
use bytemuck::bytes_of;
use std::sync::Arc;

/// Bytes that a pixel sums up in: three channels, and the sum of their squares.
pub const SUM_BYTES: u64 = 16;

/// What the pass is made with.
pub struct Choices {
    /// Surfaces that scatter a path at most.
    pub bounces: u32,
    pub roulette: bool,
    pub direct_light: bool,
    pub light_visibility: bool,
    /// What surrounds the scene lights it as rays find it.
    pub ambient_visibility: AmbientVisibility,
    /// Light walks instead of paths between surfaces, each with this many landings.
    pub walk_landings: Option<u32>,
    pub brdf: u32,
    /// Under virtual lights, where light between surfaces is walked.
    pub vpl_brdf: u32,
    pub extras: bool,
    pub workgroup: [u32; 2],
    /// Metres that a ray starts off its surface.
    pub ray_offset: f32,
    /// The scene has MASK or BLEND surfaces.
    pub is_tested: bool,
    pub air: Air,
    /// Its airlight is that of the ray that is seen.
    pub airlight_seen: bool,
    /// What `--medium` comes to.
    pub medium: Option<Medium>,
    /// The camera has a lens that is open.
    pub has_lens: bool,
    /// Rays leave through the middles of pixels.
    pub in_middles: bool,
    /// Some of the lights are spheres.
    pub has_spheres: bool,
    /// What emits and absorbs on the ray that is seen, and where it stands.
    pub volume: Option<PlacedVolume>,
    pub params: SampleParams,
}

/// The lights that paths find, as buffers hold them.
pub struct PathLights<'a> {
    /// When the shutter opens, and behind them when it closes, where the scene moves.
    pub blocks: &'a [LightBlock],
    pub sources: &'a [SourceBlock],
    /// The frame's numbers when the shutter closes, where the scene moves.
    pub closing: &'a [FrameBlock],
}

/// What rays meet.
pub struct PathTree<'a> {
    pub bvh: &'a Bvh,
    pub layout: &'a Layout,
}

pub struct Sample {
    pipeline: ComputePipeline,
    params: SampleParams,
    traced: TracedGpu,
    volume: Option<VolumeGpu>,
    lights: Buffer,
    sources: Buffer,
    /// Frame when the shutter closes.
    closing: Buffer,
    pub sums: Buffer,
    pub color: Image,
}

impl Sample {
    /// Takes the planned resources and fills them. `density_of`: of the materials that light others.
    pub fn new(
        gpu: &Arc<Gpu>,
        inputs: &Inputs<'_>,
        resources: &mut Resources,
        choices: &Choices,
        lights: &PathLights<'_>,
        tree: &PathTree<'_>,
        density_of: impl Fn(&crate::scene::Material) -> f32,
    ) -> Result<Self> {
        let PathTree { bvh, layout } = *tree;
        let alpha = if choices.is_tested { "tested" } else { "opaque" };
        let ambient_visibility = match choices.ambient_visibility {
            AmbientVisibility::Off => AMBIENT_ADDED,
            AmbientVisibility::On => AMBIENT_FOUND,
            AmbientVisibility::Seen => AMBIENT_FOUND_ONCE,
        };
        let own = [
            ("WORKGROUP_X", choices.workgroup[0]),
            ("WORKGROUP_Y", choices.workgroup[1]),
            ("BRDF_KIND", choices.brdf),
            ("VPL_BRDF", choices.vpl_brdf),
            ("SURFACE_EXTRAS", u32::from(choices.extras)),
            ("RAY_OFFSET", choices.ray_offset.to_bits()),
            ("BOUNCES", choices.bounces),
            ("ROULETTE", u32::from(choices.roulette)),
            ("DIRECT_LIGHT", u32::from(choices.direct_light)),
            ("LIGHT_VISIBILITY", u32::from(choices.light_visibility)),
            ("AMBIENT_VISIBILITY", ambient_visibility),
            ("IS_WALKED", u32::from(choices.walk_landings.is_some())),
            ("WALK_LANDINGS", choices.walk_landings.unwrap_or(0)),
            ("MEDIUM", choices.air as u32),
            ("AIRLIGHT_SEEN", u32::from(choices.airlight_seen)),
            ("HAS_LENS", u32::from(choices.has_lens)),
            ("HAS_SPHERES", u32::from(choices.has_spheres)),
            ("IN_MIDDLES", u32::from(choices.in_middles)),
        ];
        let mut constants = [&own[..], &layout.constants()].concat();
        constants.extend(layout.nodes().into_iter().flat_map(Nodes::constants));
        let stage = Stage::begin("uploading what rays meet");
        let traced = TracedGpu::new(gpu, resources, NAME, inputs.scene, bvh, layout, density_of)?;
        drop(stage);
        let read = [Access::ComputeRead, Access::ComputeSample];
        let volume = choices.volume.as_ref();
        let volume = volume.map(|volume| volume.upload(gpu, resources, NAME, read)).transpose()?;
        let mut filled = |what: &str, bytes: &[u8]| {
            let buffer = resources.buffer(&format!("{NAME}.{what}"));
            upload::buffer(gpu, &buffer, bytes, Access::ComputeRead)?;
            Result::Ok(buffer)
        };
        Ok(Self {
            pipeline: ComputePipeline::new(
                gpu,
                variant(COMP_VARIANTS, &[alpha, layout.variant(), if volume.is_some() { "seen" } else { "none" }]),
                &constants,
            )?,
            params: choices.params,
            traced,
            volume,
            lights: filled("lights", bytemuck::cast_slice(lights.blocks))?,
            sources: filled("sources", bytemuck::cast_slice(lights.sources))?,
            closing: filled("frame.closing", bytemuck::cast_slice(lights.closing))?,
            sums: resources.buffer(SUMS),
            color: resources.image(COLOR),
        })
    }

    pub fn record(&self, cmd: &mut Commands, frame: &Buffer) -> Result<()> {
        let extent = self.color.description.extent;
        let pixels = extent.pixel_count();
        let traffic = Traffic {
            // Rays decide what they read of the tree, of materials and of lights.
            read_bytes: None,
            written_bytes: Some(pixels * (SUM_BYTES + 16)),
            invocations: Some(pixels),
        };
        cmd.pass("path_traced.sample", traffic, |cmd| {
            // The run before ended with its fence: nothing of this frame has touched the sums.
            cmd.barriers([self.sums.from(Access::ComputeRead).to(Access::ComputeWrite)]);
            cmd.barriers([self.color.discard(Access::ComputeWrite)]);
            let mut bound: Vec<_> = self.traced.bound().collect();
            bound.extend([
                ("Frame", Bound::Buffer(frame)),
                ("Lights", Bound::Buffer(&self.lights)),
                ("Sources", Bound::Buffer(&self.sources)),
                ("FrameClosing", Bound::Buffer(&self.closing)),
                ("Sums", Bound::Buffer(&self.sums)),
                ("color", Bound::Storage(&self.color)),
            ]);
            bound.extend(self.volume.iter().flat_map(VolumeGpu::bound));
            let groups = self.pipeline.groups([extent.width, extent.height, 1]);
            cmd.dispatch(&self.pipeline, bytes_of(&self.params), &bound, groups)
        })
    }
}
