//! Shading with the lights of the subsets, all of them (SNSM) or those that a pixel sees (SSM, vpl_shadow/): Segovia 2006, section 4.3.
//! Every split sums the same function over its lights (irradiance.glsl): float, in the order of the list, packed to halves
//! once.

pub mod branch;
pub mod drawn;
pub mod masked;
pub mod strided;
pub mod sub_buffers;
pub mod subsample;

use super::choices::Choices;
use super::vpl_shadow::held::HIDDEN;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::Shader;
use crate::gpu::shader::structs::{LightBlock, MappingParams, ShadeParams, SubsetBlock, VplBlock};
use crate::gpu::{Access, Barrier, Bound, Buffer, Gpu, upload};
use crate::passes::direct::DirectGpu;
use crate::passes::gbuffer::{GBuffer, SurfaceParts};
use crate::plan::{Plan, Resources};
use crate::techniques::interleaved_deferred::resources::NAME;
use std::sync::Arc;

/// The lights of all subsets, on the host.
pub struct SubsetLights {
    pub vpls: Vec<VplBlock>,
    /// Punctual lights joined to the subsets; empty without `--direct interleaved`.
    pub lights: Vec<LightBlock>,
    pub subsets: Vec<SubsetBlock>,
}

/// Plans the lists: virtual point lights, punctual lights joined to the subsets, subsets.
pub fn plan(plan: &mut Plan, vpl_count: u32, joined_count: u32, subset_count: u32) {
    let mut list = |what: &str, count: u32, size: usize| {
        plan.buffer("lights", format!("{NAME}.{what}"), u64::from(count) * size as u64);
    };
    list("vpls", vpl_count, size_of::<VplBlock>());
    list("subset_lights", joined_count, size_of::<LightBlock>());
    list("subsets", subset_count, size_of::<SubsetBlock>());
}

/// The lists on the device.
pub struct ShadeGpu {
    pub vpls: Buffer,
    vpl_count: u32,
    subset_lights: Buffer,
    joined_count: u32,
    pub subsets: Buffer,
    /// Which of them a pixel does not see, where that is looked for.
    pub hidden: Option<Buffer>,
    /// Parameters of shading that every split has.
    pub params: ShadeParams,
    /// What shading reads of a surface.
    pub parts: SurfaceParts,
}

impl ShadeGpu {
    pub fn new(
        gpu: &Arc<Gpu>,
        resources: &mut Resources,
        lights: &SubsetLights,
        params: ShadeParams,
        parts: SurfaceParts,
    ) -> Result<Self> {
        let mut filled = |what: &str, bytes: &[u8]| {
            let buffer = resources.buffer(&format!("{NAME}.{what}"));
            // Compute and fragment shaders shade; blended surfaces read virtual lights too.
            upload::buffer(gpu, &buffer, bytes, Access::ComputeRead | Access::GraphicsRead)?;
            Ok(buffer)
        };
        let words_a_point = params.words_a_point;
        Ok(Self {
            vpls: filled("vpls", bytemuck::cast_slice(&lights.vpls))?,
            vpl_count: lights.vpls.len() as u32,
            subset_lights: filled("subset_lights", bytemuck::cast_slice(&lights.lights))?,
            joined_count: lights.lights.len() as u32,
            subsets: filled("subsets", bytemuck::cast_slice(&lights.subsets))?,
            hidden: (words_a_point > 0).then(|| resources.buffer(HIDDEN)),
            params,
            parts,
        })
    }

    /// Bytes that shading reads of the lights: so many threads, spread evenly over `subset_count` of the subsets, each of its own
    /// subset's, and of so many points what they do not see. None where shadow rays decide.
    fn read_bytes(&self, direct: &DirectGpu, subset_count: u32, threads: u64, points: u64) -> Option<u64> {
        let is_known = self.joined_count == 0 || !direct.casts_rays;
        let light_bytes = u64::from(self.vpl_count) * size_of::<VplBlock>() as u64
            + u64::from(self.joined_count) * size_of::<LightBlock>() as u64;
        let hidden_bytes = points * u64::from(self.params.words_a_point) * 4;
        is_known.then(|| threads * light_bytes / u64::from(subset_count) + hidden_bytes)
    }

    /// What is hidden becomes readable as `access` says, where it was found.
    pub fn hidden_to(&self, access: Access) -> Option<Barrier> {
        self.hidden.as_ref().map(|hidden| hidden.from(Access::ComputeWrite).to(access))
    }

    /// What a pass binds that looks for hidden lights (find.glsl).
    pub fn bound_to_find<'a>(
        &'a self,
        frame: &'a Buffer,
        gbuffer: &'a GBuffer,
        hidden: &'a Buffer,
    ) -> Vec<(&'static str, Bound<'a>)> {
        let mut bound = gbuffer.bound_surface();
        bound.extend([
            ("Frame", Bound::Buffer(frame)),
            ("Vpls", Bound::Buffer(&self.vpls)),
            ("Subsets", Bound::Buffer(&self.subsets)),
            ("Hidden", Bound::Buffer(hidden)),
        ]);
        bound
    }

    pub fn mapping(&self) -> &MappingParams {
        &self.params.mapping
    }

    /// Bindings of irradiance.glsl.
    fn bound<'a>(&'a self, frame: &'a Buffer, direct: &'a DirectGpu) -> Vec<(&'static str, Bound<'a>)> {
        let hidden = self.hidden.iter().map(|hidden| ("Hidden", Bound::Buffer(hidden)));
        let lights = [
            ("Frame", Bound::Buffer(frame)),
            ("Vpls", Bound::Buffer(&self.vpls)),
            ("SubsetLights", Bound::Buffer(&self.subset_lights)),
            ("Subsets", Bound::Buffer(&self.subsets)),
            ("BvhNodes", Bound::Buffer(&direct.bvh_nodes)),
            ("BvhTriangles", Bound::Buffer(&direct.bvh_triangles)),
        ];
        lights.into_iter().chain(hidden).collect()
    }
}

/// A compute pipeline over a list of texels, some a thread (listed.glsl).
struct TexelListPipeline {
    pipeline: ComputePipeline,
    workgroup_count: u32,
}

impl TexelListPipeline {
    /// Over the texels of a sub-buffer.
    fn new(gpu: &Arc<Gpu>, choices: &Choices, shader: &Shader) -> Result<Self> {
        let (settings, count) = (&choices.shading, choices.mapping.sub_texel_count());
        let (lanes, texels) = (u64::from(settings.lane_count()), choices.list_texels());
        let own = [("TEXELS", texels)];
        let constants = [&settings.workgroup_constants()[..], &choices.irradiance_constants(), &own].concat();
        let workgroup_count = count.div_ceil(lanes * u64::from(texels)) as u32;
        Ok(Self { pipeline: ComputePipeline::new(gpu, shader, &constants)?, workgroup_count })
    }

    /// Threads of `list_count` such lists.
    fn invocations(&self, list_count: u32) -> u64 {
        let [x, y, _] = self.pipeline.workgroup.map(u64::from);
        u64::from(self.workgroup_count) * x * y * u64::from(list_count)
    }
}
