//! A frame of inferred lighting on the device: the passes in the order of figure 2.

use super::choices::{Choices, LightFilter};
use super::cull::Cull;
use super::decals::Decals;
use super::encoding::Packing;
use super::geometry::{Geometry, LowGeometry};
use super::light::pack::Pack;
use super::light::tiled::Tiled;
use super::light::volumes::{LightVolumes, VolumeSettings};
use super::light::{self, LBuffer, Volumes};
use super::material::{FilterSettings, Material, MaterialDraws};
use super::motion::PreviousMoment;
use super::stipple::{self, Shares, StippledDraw};
use super::survivors::Survivors;
use crate::caps::Ability;
use crate::error::Result;
use crate::gpu::shader::structs::{FrameBlock, LightBlock};
use crate::gpu::{Access, Buffer, Gpu, Image, upload};
use crate::lights::shadow_casters::ShadowCasters;
use crate::passes::blend;
use crate::passes::direct::DirectGpu;
use crate::plan::Resources;
use crate::resident::{Coverage, DrawCall, DrawList, Raster, SceneGpu};
use crate::techniques::Inputs;
use crate::techniques::inferred_lighting::resources::{NAME, light_frame};
use std::sync::Arc;

/// How lights reach the L-buffer.
pub(super) enum LightPass {
    Tiled(Tiled),
    /// Without `pack` blended into the L-buffer itself.
    Drawn {
        volumes: Box<LightVolumes>,
        pack: Option<Box<Pack>>,
    },
}

pub struct InferredFrame {
    pub(super) geometry_pass: Geometry,
    pub(super) decals: Option<Decals>,
    pub(super) cull: Option<Cull>,
    pub(super) light_pass: LightPass,
    pub(super) material: Material,
    pub(super) geometry: LowGeometry,
    pub(super) l_buffer: [Image; 1],
    pub(super) described: LBuffer,
    pub(super) depth_range_m: [f32; 2],
    pub(super) lights: DirectGpu,
    /// The frame's block at the light buffer's extent.
    pub(super) light_frame: Buffer,
    pub(super) shares: Shares,
    /// Where the scene has BLEND draws that are stippled.
    pub(super) survivors: Option<Survivors>,
    filter: LightFilter,
    pub(super) packing: Packing,
}

impl InferredFrame {
    /// Makes the pipelines and takes the planned resources out.
    pub fn new(
        gpu: &Arc<Gpu>,
        inputs: &Inputs<'_>,
        scene: &SceneGpu,
        resources: &mut Resources,
        choices: &Choices,
        lights: &[LightBlock],
        casters: &ShadowCasters,
    ) -> Result<Self> {
        let light_extent = choices.light_extent;
        let bounds = inputs.scene.bounds();
        let ambient = inputs.lights.ambient;
        let background = inputs.values.color("background");
        let numbers = FrameBlock {
            width_px: light_extent.width,
            height_px: light_extent.height,
            ..inputs.view.block(&bounds, background, ambient, lights.len() as u32, 0)
        };
        let light_frame = resources.buffer(&light_frame());
        upload::buffer(gpu, &light_frame, bytemuck::bytes_of(&numbers), Access::ComputeRead | Access::GraphicsRead)?;
        let tree = choices.shading.direct.tree(inputs.bvh, inputs.scene)?;
        let direct = DirectGpu::new(gpu, resources, NAME, lights, choices.shading.culls(lights.len()), tree)?;
        let [first_m, last_m] = inputs.view.depth_range(&bounds);
        let depth_range_m = [first_m, last_m - first_m];
        let coverage = if choices.samples.are_many() { Coverage::Anywhere } else { Coverage::Middle };
        let mut lists = [
            inputs.draw_list_into(scene, Raster { extent: light_extent, coverage: Coverage::Middle }),
            inputs.draw_list(scene, coverage),
        ];
        let (stippled, shares) = if choices.tests_alpha {
            let blended = blend::back_to_front(scene, inputs.view);
            lists.iter_mut().for_each(|list| list.mask.extend(blended.iter().copied()));
            (Vec::new(), Shares::default())
        } else {
            let sides = blend::sides_back_to_front(scene, inputs.view);
            stipple::assign(inputs.scene, inputs.view, sides, choices.stipple_rules())
        };
        let [low_list, list]: [DrawList; 2] = lists;
        let constants = choices.light_constants();
        let l_buffer = choices.l_buffer;
        let volumes = |resources: &mut Resources| {
            let settings = VolumeSettings {
                constants: &constants,
                has_extras: choices.has_extras,
                depth_format: choices.has_stencil().then_some(choices.depth_format()),
                casters,
                least_counted_texels: choices.least_counted_texels,
                l_buffer,
                is_counted: choices.is_counted && Ability::PreciseOcclusion.is_there(&gpu.caps),
                ambient,
            };
            LightVolumes::new(gpu, &settings, resources, lights, inputs.view, light_extent)
        };
        let light_pass = if choices.volumes == Volumes::Tiled {
            LightPass::Tiled(Tiled::new(gpu, &choices.shading, &constants, choices.has_extras, lights.len())?)
        } else {
            let volumes = Box::new(volumes(resources)?);
            let constants = [&choices.shading.workgroup_constants()[..], &l_buffer.store.constants()].concat();
            let pack = l_buffer.has_sums().then(|| Pack::new(gpu, resources, l_buffer, &constants)).transpose()?;
            LightPass::Drawn { volumes, pack: pack.map(Box::new) }
        };
        let survivors = (!stippled.is_empty()).then(|| {
            let stipple = choices.stipple.clone();
            Survivors::new(inputs.scene, inputs.view, &stippled, stipple, choices.packing, depth_range_m)
        });
        let earlier = choices.has_motion.then(|| PreviousMoment::new(gpu, inputs, resources)).transpose()?;
        let filter = FilterSettings {
            kind: choices.filter,
            depth_range_m,
            depth_threshold: choices.depth_threshold,
            light_extent,
            stipple_side: choices.stipple_side(),
            samples: choices.samples,
            is_sampled: l_buffer.is_sampled,
            has_prepass: choices.has_prepass,
            is_counted: choices.is_counted,
        };
        let draws = MaterialDraws { solid: list, stippled: stippled.clone() };
        let material_constants = choices.material_constants();
        let (decals, lit): (Vec<StippledDraw>, Vec<StippledDraw>) =
            stippled.into_iter().partition(StippledDraw::is_decal);
        let decals: Vec<DrawCall> = decals.into_iter().map(|decal| decal.call).collect();
        let decals = (!decals.is_empty()).then(|| Decals::new(gpu, scene, decals, depth_range_m, choices));
        Ok(Self {
            cull: direct.masks.as_ref().map(|_| Cull::new(gpu, choices.shading.cull_by)).transpose()?,
            light_pass,
            geometry: LowGeometry::new(gpu, resources, choices)?,
            geometry_pass: Geometry::new(gpu, scene, low_list, lit, depth_range_m, choices, earlier)?,
            decals: decals.transpose()?,
            material: Material::new(gpu, resources, scene, draws, filter, &material_constants, background)?,
            l_buffer: [resources.image(&light::l_buffer())],
            described: l_buffer,
            depth_range_m,
            lights: direct,
            light_frame,
            shares,
            survivors,
            filter: choices.filter,
            packing: choices.packing,
        })
    }
}

impl InferredFrame {
    /// How the light pass left what it read.
    pub(super) fn lit_access(&self) -> Access {
        if matches!(self.light_pass, LightPass::Tiled(_)) { Access::ComputeSample } else { Access::FragmentSample }
    }

    /// The access that read the normals last.
    pub(super) fn normal_access(&self) -> Access {
        if self.filter.reads_normals() { Access::FragmentSample } else { self.lit_access() }
    }
}
