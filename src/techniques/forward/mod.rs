//! Forward shading with a depth pre-pass and a list of lights for each object: what Kircher and Lawrance 2009, section 5,
//! call an optimized forward renderer and beat with inferred lighting. Direct light only.
//!
//! Passes: lights (on the host: the lists), shadow_maps (with `--direct-shadow map`), depth, material, blend (where the scene has BLEND surfaces), resolve (with
//! `--msaa` above 1), accumulate (with `--supersample` above 1).
//!
//! Differs from the paper, which says of its forward renderer no more than that it is one
//! - lists are by the box around an object and the light's range; the floor of a hall is one object, under all its lights
//! - the samples of MSAA are 32-bit floats of linear light, averaged before any tone mapping
//! - shadow maps (`--direct-shadow map`) are Clarberg and Munkberg's (2014, section 6); each run of `--supersample` draws
//!   them again, as every frame does
//! - holes of MASK surfaces are cut once a pixel: their edges stay as jagged as without MSAA
//!
//! Equal to others: with `--msaa 1` it is `deferred` except for what that one's G-buffer rounds. `--light-lists none`,
//! `--light-buffer storage` and, with one sample, `--depth-prepass off` are the plain ways to its own bits (with more a
//! driver may choose the place in a pixel that is shaded among the samples that pass the depth test). `--supersample` is the reference of edges: the same picture
//! from N x N places in each pixel, every one of them shaded.
//!
//! Why this way: a list is found by the draw's push constants. An index of the object in the fragment shader would be one
//! more thing to interpolate for every technique that shares the vertex stage.

mod bench_stages;
mod choices;
pub mod material;
mod plan;
mod resources;
mod settings;

use super::bench_stage::BenchStage;
use super::notes::{self, Figures};
use super::{Frame, HostPart, Inputs, Prepared, Technique, light_visibility};
use crate::caps::{Ability, Caps, Need};
use crate::error::Result;
use crate::gpu::shader::structs::LightBlock;
use crate::gpu::{Access, Bound, Buffer, Commands, Gpu, Image, readback, upload};
use crate::lights::LightSet;
use crate::lights::object_lists::ObjectLists;
use crate::passes::accumulate::Accumulate;
use crate::passes::blend::{self, Blend, BlendLights, BlendTarget, SolidPicture};
use crate::passes::depth_prepass::{self, DepthPrepass};
use crate::passes::direct::DirectGpu;
use crate::passes::resolve;
use crate::passes::shadow_maps::{self, MapLayout, Places, ShadowMaps};
use crate::picture::{Aov, AovChannels};
use crate::plan::{Plan, Resources};
use crate::resident::{DrawList, SceneGpu};
use crate::settings::{LIGHT_LISTS, MULTISAMPLE, SHADOW_MAPS, Setting, Values};
use crate::techniques::forward::choices::Choices;
use crate::techniques::forward::material::{MaterialLights, Targets};
use crate::techniques::forward::resources::NAME;
use glam::Vec2;
use material::Material;
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Instant;

const DEPTH_STAGE: &str = "depth.reversed";

pub struct Forward;

impl Technique for Forward {
    fn name(&self) -> &'static str {
        NAME
    }

    fn summary(&self) -> &'static str {
        "forward shading with a depth pre-pass and a list of lights for each object"
    }

    fn scene(&self) -> &'static str {
        "lamps"
    }

    fn settings(&self) -> &'static [&'static [Setting]] {
        &[settings::SETTINGS, LIGHT_LISTS, SHADOW_MAPS, MULTISAMPLE]
    }

    fn aovs(&self) -> &'static [&'static str] {
        &[DEPTH_STAGE]
    }

    fn shorter(&self) -> &'static [(&'static str, &'static str)] {
        &[("light-lists", "none"), ("direct-shadow", "none")]
    }

    fn needs(&self, values: &Values, _: &Caps, has_blend: bool) -> Vec<Need> {
        let depth = Need { of: "the depth buffer".to_owned(), ability: Ability::FloatDepth, instead: "" };
        let chosen = resolve::needs(values).into_iter().chain(shadow_maps::needs(values));
        [depth].into_iter().chain(chosen).chain(blend::needs(has_blend)).collect()
    }

    fn bounds(&self, _: &Caps) -> Vec<(&'static str, String)> {
        Vec::new()
    }

    /// Punctual lights, straight.
    fn reference_settings(&self, values: &Values, lights: &LightSet) -> Result<Vec<(&'static str, String)>> {
        Ok(vec![
            ("transport", "direct".to_owned()),
            ("light-visibility", light_visibility(values, lights, 0)?),
            ("emissive", "off".to_owned()),
            ("ambient-visibility", "off".to_owned()),
        ])
    }

    fn bench_stages(&self) -> &'static [BenchStage] {
        bench_stages::STAGES
    }

    fn notes(&self, figures: &Figures<'_>) -> Vec<String> {
        Vec::from_iter(notes::direct_light(figures, None))
    }

    fn prepare(&self, inputs: &Inputs<'_>) -> Result<Box<dyn Prepared>> {
        let choices = Choices::new(inputs)?;
        let began = Instant::now();
        let (lights, lists) = choices.lists(inputs)?;
        let lists_ns = began.elapsed().as_nanos() as u64;
        Ok(Box::new(PreparedForward { choices, lights, lists, lists_ns }))
    }
}

struct PreparedForward {
    choices: Choices,
    lights: Vec<LightBlock>,
    lists: ObjectLists,
    lists_ns: u64,
}

impl Prepared for PreparedForward {
    fn plan(&self, inputs: &Inputs<'_>) -> Result<Plan> {
        plan::plan(&self.choices, inputs, &self.lists)
    }

    fn stages_left_out(&self, _: &Inputs<'_>) -> Vec<(&'static str, String)> {
        let samples = self.choices.samples;
        let why = format!("with --msaa {samples} a pixel has several depths; --msaa 1 makes it");
        Vec::from_iter((samples > 1).then_some((DEPTH_STAGE, why)))
    }

    fn resolved(&self) -> BTreeMap<&'static str, String> {
        let buffer = if self.choices.is_uniform { "uniform" } else { "storage" };
        let maps = self.choices.maps.as_ref().map(MapLayout::resolved);
        [("light-buffer", buffer.to_owned())].into_iter().chain(maps).collect()
    }

    fn host_part(self: Box<Self>, _: &Inputs<'_>) -> Result<HostPart> {
        let [mean, most] = self.lists.lights_per_object();
        let mut counters = BTreeMap::from([
            ("lights", self.lights.len() as f64),
            ("lights_per_object", mean),
            ("lights_per_object_most", most),
            ("objects", self.lists.objects.len() as f64),
        ]);
        counters.extend(blend::counters(&self.lists));
        Ok(HostPart {
            passes: vec![(format!("{NAME}.lights"), self.lists_ns)],
            counters,
            light_counts: [self.lights.len() as u32, 0],
            build: Box::new(move |gpu, inputs, scene, resources| self.build(gpu, inputs, scene, resources)),
        })
    }
}

impl PreparedForward {
    /// The frame on the device.
    fn build(
        self,
        gpu: &Arc<Gpu>,
        inputs: &Inputs<'_>,
        scene: &SceneGpu,
        resources: &mut Resources,
    ) -> Result<Box<dyn Frame>> {
        let Self { choices, lights, lists, .. } = self;
        let Choices { samples, runs_per_side, has_prepass, .. } = choices;
        let tree = choices.direct.tree(inputs.bvh, inputs.scene)?;
        let list_buffer = resources.buffer(resources::LISTS);
        upload::buffer(gpu, &list_buffer, bytemuck::cast_slice(&lists.entries), Access::GraphicsRead)?;
        let uniform_lights = match choices.is_uniform {
            false => None,
            true => {
                let buffer = resources.buffer(resources::UNIFORM);
                upload::buffer(gpu, &buffer, bytemuck::cast_slice(&lights), Access::GraphicsRead)?;
                Some(buffer)
            }
        };
        let constants = choices.light_constants();
        let target = BlendTarget { pieces: &lists.pieces, samples, has_shadow_maps: choices.maps.is_some() };
        let maps = choices.maps.as_ref();
        let maps = maps.map(|layout| ShadowMaps::new(gpu, resources, NAME, layout, inputs.scene, scene)).transpose()?;
        let maps_once = maps.as_ref().map(|maps| maps.draw_once(gpu, NAME, scene, Places::of(scene))).transpose()?;
        let background = inputs.values.color("background");
        Ok(Box::new(ForwardFrame {
            list: inputs.draw_list(scene, choices.coverage()),
            maps,
            maps_once: maps_once.flatten(),
            depth: if has_prepass { Some(DepthPrepass::new(gpu, scene, samples)?) } else { None },
            material: Material::new(gpu, scene, &choices, &lists.objects, background)?,
            blend: Blend::new(gpu, scene, inputs.view, blend::all_lights(0.0), &constants, &target)?,
            accumulate: if runs_per_side > 1 { Some(Accumulate::new(gpu, NAME, resources)?) } else { None },
            targets: Targets {
                depth: resources.image(resources::DEPTH),
                drawn: resources.image(resources::DRAWN),
                resolved: (samples > 1).then(|| resources.image(resources::RESOLVED)),
            },
            direct: DirectGpu::new(gpu, resources, NAME, &lights, false, tree)?,
            lists: list_buffer,
            uniform_lights,
            vpls: resources.buffer(resources::VPLS),
            runs_per_side,
        }))
    }
}

struct ForwardFrame {
    list: DrawList,
    maps: Option<ShadowMaps>,
    maps_once: Option<(String, u64)>,
    depth: Option<DepthPrepass>,
    material: Material,
    blend: Option<Blend>,
    accumulate: Option<Accumulate>,
    targets: Targets,
    direct: DirectGpu,
    lists: Buffer,
    /// The same lights as `direct` has, where the material pass reads them as uniforms.
    uniform_lights: Option<Buffer>,
    vpls: Buffer,
    runs_per_side: u32,
}

impl Frame for ForwardFrame {
    fn record(&self, cmd: &mut Commands, scene: &SceneGpu, frame: &Buffer) -> Result<()> {
        let Targets { depth, drawn, resolved } = &self.targets;
        if let Some(maps) = &self.maps {
            maps.record(cmd, NAME, scene, Places::of(scene))?;
        }
        if let Some(prepass) = &self.depth {
            prepass.record(cmd, NAME, frame, scene, &self.list, depth)?;
        }
        let mut lit = self.direct.bound();
        if let Some(uniform) = &self.uniform_lights {
            lit.retain(|(name, _)| *name != "Lights");
            lit.push(("Lights", Bound::Buffer(uniform)));
        }
        lit.push(("LightLists", Bound::Buffer(&self.lists)));
        let maps = self.maps.as_ref();
        let lights = MaterialLights { bound: &lit, maps: maps.map(|maps| maps.from(Access::DepthWrite)) };
        self.material.record(cmd, frame, scene, &self.list, &lights, &self.targets)?;
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
            blend.record(cmd, NAME, frame, scene, &lights, solid)?;
        }
        if let Some(plain) = resolved {
            resolve::record(cmd, NAME, drawn.from(Access::ColorWrite), plain)?;
        }
        if let Some(accumulate) = &self.accumulate {
            accumulate.record(cmd, NAME, frame, self.run_picture().from(Access::ColorWrite))?;
        }
        Ok(())
    }

    fn run_count(&self) -> u32 {
        self.runs_per_side * self.runs_per_side
    }

    /// The middles of `runs_per_side` x `runs_per_side` equal parts of a pixel, in row order.
    fn offset_px(&self, run: u32) -> Vec2 {
        let place = |index: u32| (index as f32 + 0.5) / self.runs_per_side as f32 - 0.5;
        Vec2::new(place(run % self.runs_per_side), place(run / self.runs_per_side))
    }

    fn once(&self) -> Vec<(String, u64)> {
        self.maps_once.iter().cloned().collect()
    }

    fn drawn(&self) -> BTreeMap<&'static str, f64> {
        let mut counters: BTreeMap<&'static str, f64> = self.list.counters().into();
        counters.insert("draws", self.list.calls().count() as f64);
        counters.extend(self.maps.iter().flat_map(ShadowMaps::counters));
        counters
    }

    fn picture(&self) -> (&Image, Access) {
        match &self.accumulate {
            Some(accumulate) => (&accumulate.color, Access::ComputeWrite),
            None => (self.run_picture(), Access::ColorWrite),
        }
    }

    /// Lights that were evaluated for the solid surfaces that are seen: pixels of several samples count with the mean.
    fn counters(&self, gpu: &Arc<Gpu>) -> Result<BTreeMap<&'static str, f64>> {
        let (picture, last) = self.picture();
        let pixels = picture.description.extent.pixel_count() as f64;
        let texels: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(&readback::image(gpu, picture, last)?);
        let evaluated: f64 = texels.iter().map(|[.., lights]| f64::from(*lights)).sum();
        let every = pixels * f64::from(self.direct.light_count);
        Ok(BTreeMap::from([
            ("light_evaluations", evaluated),
            ("light_evaluations_culled", every - evaluated),
            ("lights_per_pixel", evaluated / pixels),
        ]))
    }

    fn aov(&self, gpu: &Arc<Gpu>, name: &str) -> Result<Aov> {
        let depth = &self.targets.depth;
        let last = depth_prepass::access(self.depth.is_some() || self.blend.is_some());
        let depths = bytemuck::pod_collect_to_vec(&readback::image(gpu, depth, last)?);
        Ok(Aov { name: name.to_owned(), channels: AovChannels::Y(depths) })
    }
}

impl ForwardFrame {
    /// The plain picture of a run.
    fn run_picture(&self) -> &Image {
        self.targets.resolved.as_ref().unwrap_or(&self.targets.drawn)
    }
}
