//! Forward shading: every surface that is seen is drawn with its whole material, under a list of lights for each object.
//!
//! Passes: shadow_maps (with `--direct-shadow map`), depth, material, blend (where the scene has BLEND surfaces). They draw
//! into a depth buffer and a picture of the technique's, whose samples, runs and means are its own.

mod choices;
pub mod material;

use choices::UNIFORM_BYTES;
pub use choices::{ForwardChoices, ListedLights};
pub use material::Targets;

use crate::bvh::LazyBvh;
use crate::caps::{Ability, Need};
use crate::error::Result;
use crate::frame::View;
use crate::gpu::shader::structs::{BvhTriangleBlock, LightBlock};
use crate::gpu::{Access, Bound, Buffer, Commands, Gpu, upload};
use crate::memory::kinds::Use;
use crate::passes::blend::{self, Blend, BlendLights, BlendTarget, SolidPicture};
use crate::passes::depth_prepass::{self, DepthPrepass};
use crate::passes::direct::{self, DirectGpu};
use crate::passes::shadow_maps::{self, MapLayout, ShadowMaps};
use crate::plan::{Plan, Resources, Shape};
use crate::resident::{DrawList, SceneGpu};
use crate::scene::Scene;
use crate::settings::Values;
use ash::vk::BufferUsageFlags;
use glam::Vec3;
use material::{Material, MaterialLights};
use std::collections::BTreeMap;
use std::sync::Arc;

fn lists_name(technique: &str) -> String {
    format!("{technique}.lights.lists")
}

/// The lights once more, where the material pass reads them as uniforms.
fn uniform_name(technique: &str) -> String {
    format!("{technique}.lights.uniform")
}

/// No virtual lights: what blended surfaces bind in their place.
fn vpls_name(technique: &str) -> String {
    format!("{technique}.vpls")
}

/// What the passes need of a device. `has_blend`: the scene has BLEND surfaces.
pub fn needs(values: &Values, has_blend: bool) -> impl Iterator<Item = Need> {
    let depth = Need { of: "the depth buffer".to_owned(), ability: Ability::FloatDepth, instead: "" };
    [depth].into_iter().chain(shadow_maps::needs(values)).chain(blend::needs(has_blend))
}

/// Settings that have shorter buffers, or none (`Technique::shorter`).
pub const SHORTER: &[(&str, &str)] = &[("light-lists", "none"), ("direct-shadow", "none")];

/// Plans the lights, their lists and the tree.
///
/// Errors: as of the tree.
pub fn plan(
    plan: &mut Plan,
    technique: &str,
    choices: &ForwardChoices,
    listed: &ListedLights,
    (bvh, scene): (&LazyBvh, &Scene),
) -> Result<()> {
    let tree = choices.direct.tree(bvh, scene)?;
    direct::plan(plan, technique, listed.lights.len(), tree);
    plan.buffer("lights", lists_name(technique), 4 * listed.lists.entries.len() as u64);
    plan.buffer("lights", vpls_name(technique), 0);
    if choices.is_uniform {
        let flags =
            BufferUsageFlags::UNIFORM_BUFFER | BufferUsageFlags::STORAGE_BUFFER | BufferUsageFlags::TRANSFER_DST;
        plan.push("lights", uniform_name(technique), Shape::Buffer { bytes: UNIFORM_BYTES, flags, usage: Use::Device });
    }
    Ok(())
}

/// Plans the passes, into a depth buffer and a picture of these full names.
pub fn plan_passes(
    plan: &mut Plan,
    technique: &str,
    choices: &ForwardChoices,
    has_blend: bool,
    [depth, drawn]: [&str; 2],
) {
    let touch = |name: &str, access| (name.to_owned(), access);
    if let Some(maps) = &choices.maps {
        maps.plan(plan, technique);
    }
    let asked = || choices.maps.iter().filter_map(|maps| maps.read(technique));
    if choices.has_prepass {
        plan.pass(depth_prepass::pass(technique), [touch(depth, Access::DepthWrite)]);
    }
    let targets = [touch(depth, depth_prepass::access(choices.has_prepass)), touch(drawn, Access::ColorWrite)];
    plan.pass(material::pass(technique), targets.into_iter().chain(asked()));
    if has_blend {
        plan.pass(format!("{technique}.blend"), blend::touches(depth, drawn).into_iter().chain(asked()));
    }
}

/// What the draws are of, beside the scene in device memory.
pub struct ForwardScene<'a> {
    pub scene: &'a Scene,
    pub view: &'a View,
    pub bvh: &'a LazyBvh,
    pub listed: &'a ListedLights,
    /// The solid triangles that are drawn.
    pub list: DrawList,
    /// Radiance where no surface is.
    pub background: Vec3,
    /// Pixels of the picture from one texel that is drawn to the next, to the right and down: 1 but where only some are
    /// drawn. Levels of textures are those of the picture's pixels.
    pub pixels_per_texel: [f32; 2],
}

/// What changes from moment to moment (`ForwardChoices::hold_at_any_moment`).
pub struct ForwardMoment<'a> {
    /// As many as those of `ListedLights`.
    pub lights: &'a [LightBlock],
    /// Those of the tree in its order; None: none has moved.
    pub triangles: Option<&'a [BvhTriangleBlock]>,
    /// Maps of these lights and triangles; None without shadow maps.
    pub maps: Option<&'a MapLayout>,
}

/// The passes on the device.
pub struct Forward {
    list: DrawList,
    maps: Option<ShadowMaps>,
    maps_once: Option<(String, u64)>,
    depth: Option<DepthPrepass>,
    material: Material,
    blend: Option<Blend>,
    direct: DirectGpu,
    lists: Buffer,
    /// The same lights as `direct` has, where the material pass reads them as uniforms.
    uniform_lights: Option<Buffer>,
    vpls: Buffer,
}

impl Forward {
    /// Fills the planned buffers, makes the pipelines, and draws shadow maps that are drawn once.
    ///
    /// Errors: the driver refuses, memory for the uploads (exit code 4).
    pub fn new(
        gpu: &Arc<Gpu>,
        resources: &mut Resources,
        technique: &str,
        choices: &ForwardChoices,
        of: ForwardScene<'_>,
        scene: &SceneGpu,
    ) -> Result<Self> {
        let tree = choices.direct.tree(of.bvh, of.scene)?;
        let list_buffer = resources.buffer(&lists_name(technique));
        upload::buffer(gpu, &list_buffer, bytemuck::cast_slice(&of.listed.lists.entries), Access::GraphicsRead)?;
        let uniform_lights = match choices.is_uniform {
            false => None,
            true => {
                let buffer = resources.buffer(&uniform_name(technique));
                upload::buffer(gpu, &buffer, bytemuck::cast_slice(&of.listed.lights), Access::GraphicsRead)?;
                Some(buffer)
            }
        };
        let [right, down] = of.pixels_per_texel.map(|pixels| (1.0 / pixels).to_bits());
        let steps = [("LEVEL_STEP_X", right), ("LEVEL_STEP_Y", down)];
        let constants: Vec<_> =
            choices.light_constants().into_iter().chain(steps).chain([choices.samples.constant()]).collect();
        let samples = choices.samples;
        let plain = BlendTarget::plain(&of.listed.lists);
        let target = BlendTarget { samples, has_shadow_maps: choices.maps.is_some(), ..plain };
        let maps = choices.maps.as_ref();
        let maps =
            maps.map(|layout| ShadowMaps::new(gpu, resources, technique, layout, of.scene, scene)).transpose()?;
        let maps_once = maps.as_ref().map(|maps| maps.draw_once(gpu, technique, scene)).transpose()?;
        Ok(Self {
            list: of.list,
            maps,
            maps_once: maps_once.flatten(),
            depth: choices.has_prepass.then(|| DepthPrepass::new(gpu, scene, samples, &steps)).transpose()?,
            material: Material::new(
                gpu,
                technique,
                scene,
                choices,
                &constants,
                (&of.listed.lists.objects, of.background),
            )?,
            blend: Blend::new(gpu, scene, of.view, blend::all_lights(0.0), &constants, &target)?,
            direct: DirectGpu::new(gpu, resources, technique, &of.listed.lights, false, tree)?,
            lists: list_buffer,
            uniform_lights,
            vpls: resources.buffer(&vpls_name(technique)),
        })
    }

    /// Draws the scene as `frame` sees it. The picture is written as `Access::ColorWrite` leaves it.
    pub fn record(
        &self,
        cmd: &mut Commands,
        technique: &str,
        frame: &Buffer,
        scene: &SceneGpu,
        targets: &Targets,
    ) -> Result<()> {
        let Targets { depth, begins, drawn } = targets;
        if let Some(maps) = &self.maps {
            maps.record(cmd, technique, scene)?;
        }
        if let Some(prepass) = &self.depth {
            prepass.record(cmd, technique, frame, scene, &self.list, (depth, *begins))?;
        }
        let mut lit = self.direct.bound();
        if let Some(uniform) = &self.uniform_lights {
            lit.retain(|(name, _)| *name != "Lights");
            lit.push(("Lights", Bound::Buffer(uniform)));
        }
        lit.push(("LightLists", Bound::Buffer(&self.lists)));
        let maps = self.maps.as_ref();
        let lights = MaterialLights { bound: &lit, maps: maps.map(|maps| maps.from(Access::DepthWrite)) };
        self.material.record(cmd, frame, scene, &self.list, &lights, targets)?;
        if let Some(blend) = &self.blend {
            let lights = BlendLights {
                lights: &self.direct.lights,
                vpls: &self.vpls,
                subsets: &self.vpls,
                bvh_nodes: &self.direct.bvh_nodes,
                bvh_triangles: &self.direct.bvh_triangles,
                lists: &self.lists,
                shadow_maps: maps.map(|maps| maps.from(Access::FragmentSample)),
            };
            let tested = depth_prepass::access(self.depth.is_some());
            let solid = SolidPicture { depth: depth.from(tested), color: drawn.from(Access::ColorWrite) };
            blend.record(cmd, technique, frame, scene, &lights, solid)?;
        }
        Ok(())
    }

    /// What the next run is drawn under where it is another moment.
    ///
    /// Errors: memory for the uploads (exit code 4).
    pub fn renew(&self, gpu: &Arc<Gpu>, moment: &ForwardMoment<'_>) -> Result<()> {
        self.direct.replace_lights(gpu, moment.lights)?;
        if let Some(uniform) = &self.uniform_lights {
            upload::buffer(gpu, uniform, bytemuck::cast_slice(moment.lights), Access::GraphicsRead)?;
        }
        if let Some(triangles) = moment.triangles {
            self.direct.move_triangles(gpu, triangles)?;
        }
        match self.maps.as_ref().zip(moment.maps) {
            Some((maps, layout)) => maps.see_from(gpu, layout),
            None => Ok(()),
        }
    }

    /// How `record` touches the depth buffer last.
    pub fn depth_access(&self) -> Access {
        depth_prepass::access(self.depth.is_some() || self.blend.is_some())
    }

    /// Passes that ran once, before the first frame.
    pub fn once(&self) -> Vec<(String, u64)> {
        self.maps_once.iter().cloned().collect()
    }

    /// What is drawn of the scene, for the report's `counters`.
    pub fn drawn(&self) -> BTreeMap<&'static str, f64> {
        let mut counters: BTreeMap<&'static str, f64> = self.list.counters().into();
        counters.insert("draws", self.list.calls().count() as f64);
        counters.extend(self.maps.iter().flat_map(ShadowMaps::counters));
        counters
    }

    /// Lights of the picture.
    pub fn light_count(&self) -> u32 {
        self.direct.light_count
    }
}
