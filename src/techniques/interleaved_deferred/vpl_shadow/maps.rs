//! Shadow maps of the virtual lights, as many at once as the atlas holds: drawn, asked by every pixel that has one of these lights, and
//! drawn over. Shaders: shadow_maps.vert, shadow_maps.frag, maps.comp.
//! reads   the scene, the G-buffer, the lights
//! writes  vpl_shadow.maps  image, 4 B a texel; vpl_shadow.hidden

use super::super::shade::ShadeGpu;
use super::draws::{FaceDraws, MapDraws};
use super::held::{GROUP, INDICES, MAPS, Turn, VIEWS, VPL_MAPS, VplMaps, drawing_pass, finding_pass, turns};
use super::index::{self, IndexCube};
use super::sought::{Sought, clear, groups, params};
use super::unrolled::{MapIndex, MapShape};
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::sampler::Sampler;
use crate::gpu::shader::structs::{HiddenParams, SubsetBlock, VplBlock, VplMapBlock};
use crate::gpu::shader::techniques::interleaved_deferred::vpl_shadow::hidden::LIGHTS_A_WORD;
use crate::gpu::shader::techniques::interleaved_deferred::vpl_shadow::maps::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Image, Layers, Traffic, upload};
use crate::memory::kinds::Use;
use crate::passes::gbuffer::GBuffer;
use crate::passes::mesh;
use crate::passes::shadow_maps::CasterPipelines;
use crate::plan::{Plan, Resources, Shape};
use crate::resident::coarse::CoarseMeshes;
use crate::resident::{Casters, SceneGpu};
use crate::techniques::{Inputs, Run};
use ash::vk;
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::sync::Arc;

pub struct HiddenByMaps {
    maps: VplMaps,
    pipelines: CasterPipelines,
    /// Maps of the run whose turn it is.
    draws: RefCell<MapDraws>,
    /// What stands for triangles where a map's texels are large, and its index list.
    coarse: CoarseMeshes,
    indices: Option<Buffer>,
    depth: Image,
    views: Buffer,
    blocks: Buffer,
    index: Option<IndexCube>,
    nearest: Sampler,
    compare: ComputePipeline,
    params: HiddenParams,
    groups: [u32; 3],
    subsets: Vec<SubsetBlock>,
}

/// Plans the atlas and what says where its maps are.
pub fn plan(plan: &mut Plan, maps: &VplMaps, vpl_count: u32) {
    let count = |a_light: usize| u64::from(vpl_count) * a_light as u64;
    plan.push(GROUP, MAPS, Shape::Image(maps.atlas.description()));
    if maps.index == MapIndex::CubeMap {
        index::plan(plan, &maps.atlas);
    }
    if let Some(bytes) = maps.coarse_bytes() {
        let flags = vk::BufferUsageFlags::INDEX_BUFFER | vk::BufferUsageFlags::TRANSFER_DST;
        plan.push(GROUP, INDICES, Shape::Buffer { bytes, flags, usage: Use::Device });
    }
    plan.buffer(GROUP, VIEWS, count(maps.atlas.face_count() as usize * size_of::<[[f32; 4]; 4]>()));
    plan.buffer(GROUP, VPL_MAPS, count(size_of::<VplMapBlock>()));
}

impl HiddenByMaps {
    /// Takes out what `plan` put in.
    ///
    /// Errors: the driver refuses, memory for the upload, more draws than can be recorded (exit code 4).
    pub fn new(
        gpu: &Arc<Gpu>,
        inputs: &Inputs<'_>,
        scene: &SceneGpu,
        resources: &mut Resources,
        maps: VplMaps,
        sought: &Sought<'_>,
    ) -> Result<Self> {
        let Sought { choices, lights, least_squared } = *sought;
        let atlas = maps.atlas;
        let indices = maps.coarse_bytes().map(|_| resources.buffer(INDICES));
        let coarse = match &indices {
            Some(_) => CoarseMeshes::of(inputs.scene, scene),
            None => CoarseMeshes::default(),
        };
        if let Some(indices) = indices.as_ref().filter(|_| !coarse.indices.is_empty()) {
            upload::buffer(gpu, indices, bytemuck::cast_slice(&coarse.indices), Access::VertexRead)?;
        }
        let draws = MapDraws::of(&maps, inputs.scene, inputs.view, scene, &coarse, &lights.vpls)?;
        let (views, blocks) = (resources.buffer(VIEWS), resources.buffer(VPL_MAPS));
        draws.upload(gpu, &views, &blocks)?;
        let settings = &choices.shading;
        let own = [("MAP_COLUMNS", atlas.columns), ("MAP_BIAS", maps.bias_m.to_bits())];
        let shader = variant(COMP_VARIANTS, &[settings.position.name(), maps.axis()]);
        let mut constants = [&settings.workgroup_constants()[..], &own].concat();
        let index = match maps.index {
            MapIndex::Arithmetic => {
                constants.push(("MAP_SIZE", atlas.size_px));
                None
            }
            MapIndex::CubeMap => {
                let [width, height] = atlas.tile_px();
                constants.extend([("MAP_TILE_X", width), ("MAP_TILE_Y", height)]);
                Some(IndexCube::new(gpu, resources, &atlas)?)
            }
        };
        let params = params(choices, least_squared);
        Ok(Self {
            pipelines: CasterPipelines::new(gpu, scene, maps.slope_bias_px)?,
            draws: RefCell::new(draws),
            coarse,
            indices,
            depth: resources.image(MAPS),
            views,
            blocks,
            index,
            nearest: Sampler::clamped(gpu, vk::Filter::NEAREST)?,
            compare: ComputePipeline::new(gpu, shader, &constants)?,
            groups: groups(choices, &params),
            params,
            subsets: lights.subsets.clone(),
            maps,
        })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        frame: &Buffer,
        scene: &SceneGpu,
        lights: &ShadeGpu,
        gbuffer: Edge<'_, GBuffer>,
        hidden: &Buffer,
    ) -> Result<()> {
        let MapDraws { faces, .. } = &*self.draws.borrow();
        for turn in turns(Some(&self.maps), faces.len() as u32) {
            self.draw(cmd, &turn, scene, faces)?;
            self.find(cmd, &turn, frame, lights, gbuffer, hidden)?;
        }
        Ok(())
    }

    /// Draws the maps of the lights whose turn it is.
    fn draw(&self, cmd: &mut Commands, turn: &Turn, scene: &SceneGpu, faces: &[Vec<FaceDraws>]) -> Result<()> {
        let lights = || turn.first..turn.end;
        let drawn = || lights().flat_map(|light| &faces[light as usize]);
        let traffic = Traffic {
            read_bytes: drawn()
                .flat_map(|face| [&face.casters.fine, &face.casters.coarse])
                .map(mesh::depth_bytes)
                .sum(),
            written_bytes: Some(self.depth.description.bytes()),
            invocations: None,
        };
        let (atlas, face_count) = (&self.maps.atlas, self.maps.atlas.face_count());
        let target = (&self.depth, Some(0.0), Access::DepthWrite);
        cmd.pass(&drawing_pass(turn), traffic, |cmd| {
            cmd.barriers([match turn.index {
                0 => self.depth.discard(Access::DepthWrite),
                _ => self.depth.from(Access::ComputeSample).to(Access::DepthWrite),
            }]);
            let sets = self.pipelines.sets(cmd, scene, &self.views)?;
            let extent = self.depth.description.extent;
            let draw = |cmd: &mut Commands, light: u32, face: &FaceDraws| {
                let view = light * face_count + face.index;
                let Casters { fine, coarse } = &face.casters;
                self.pipelines.draw(cmd, scene, &sets, view, fine);
                if let Some(indices) = self.indices.as_ref().filter(|_| !coarse.opaque.is_empty()) {
                    cmd.bind_indices(indices);
                    self.pipelines.draw(cmd, scene, &sets, view, coarse);
                    cmd.bind_indices(&scene.indices);
                }
            };
            if atlas.shape == MapShape::Layers {
                for light in lights() {
                    for index in 0..face_count {
                        // What is not drawn is cleared all the same: nothing stands in the way.
                        let layer = atlas.window(light - turn.first, index).layer;
                        cmd.begin_layers(extent, Layers::One(layer), &[], Some(target));
                        mesh::bind_streams(cmd, scene);
                        let found = faces[light as usize].iter().find(|face| face.index == index);
                        found.into_iter().for_each(|face| draw(cmd, light, face));
                        cmd.end_rendering();
                    }
                }
                return Ok(());
            }
            cmd.begin_rendering(extent, &[], Some(target));
            mesh::bind_streams(cmd, scene);
            for light in lights() {
                for face in &faces[light as usize] {
                    let window = atlas.window(light - turn.first, face.index);
                    cmd.set_window(window.at_px, window.extent);
                    draw(cmd, light, face);
                }
            }
            cmd.end_rendering();
            Ok(())
        })
    }

    /// Asks these maps for every pixel that has one of their lights.
    fn find(
        &self,
        cmd: &mut Commands,
        turn: &Turn,
        frame: &Buffer,
        lights: &ShadeGpu,
        gbuffer: Edge<'_, GBuffer>,
        hidden: &Buffer,
    ) -> Result<()> {
        let stretches = |subset: &SubsetBlock| {
            let (first, end) = (subset.vpl_first.max(turn.first), (subset.vpl_first + subset.vpl_count).min(turn.end));
            (first < end).then(|| [first, end - 1].map(|light| (light - subset.vpl_first) / LIGHTS_A_WORD))
        };
        let found =
            || self.subsets.iter().enumerate().filter_map(|(index, subset)| Some((index as u32, stretches(subset)?)));
        let subset_first = found().map(|(index, _)| index).min().unwrap_or_default();
        let subset_end = found().map(|(index, _)| index + 1).max().unwrap_or_default();
        let word_first = found().map(|(_, [first, _])| first).min().unwrap_or_default();
        let word_end = found().map(|(_, [_, last])| last + 1).max().unwrap_or_default();
        let params =
            HiddenParams { subset_first, word_first, light_first: turn.first, light_end: turn.end, ..self.params };
        let groups = [self.groups[0], word_end - word_first, subset_end - subset_first];
        let invocations: u64 = groups.iter().chain(&self.compare.workgroup).map(|count| u64::from(*count)).product();
        let traffic = Traffic {
            // Where lights look decides what is read of their maps.
            read_bytes: None,
            written_bytes: Some(hidden.bytes),
            invocations: Some(invocations),
        };
        cmd.pass(&finding_pass(turn), traffic, |cmd| {
            match turn.index {
                0 => {
                    clear(cmd, hidden);
                    cmd.barriers(gbuffer.surface_to_sampled());
                }
                _ => {
                    cmd.barriers([hidden.from(Access::ComputeWrite).to(Access::ComputeWrite)]);
                    cmd.barriers(gbuffer.after(Access::ComputeSample).surface_to_sampled());
                }
            }
            cmd.barriers([self.depth.from(Access::DepthWrite).to(Access::ComputeSample)]);
            let mut bound = lights.bound_to_find(frame, gbuffer.resource, hidden);
            bound.push(("VplMaps", Bound::Buffer(&self.blocks)));
            bound.push(("atlas", Bound::Sampled(&self.depth, self.nearest.handle, Access::ComputeSample)));
            bound.extend(self.index.iter().map(IndexCube::bound));
            cmd.dispatch(&self.compare, bytemuck::bytes_of(&params), &bound, groups)
        })
    }

    /// Numbers for the report's `counters`: maps that are drawn of those that lights have, their faces and triangles, and turns.
    pub fn counters(&self) -> BTreeMap<&'static str, f64> {
        let MapDraws { faces: of_lights, .. } = &*self.draws.borrow();
        let faces = || of_lights.iter().flatten();
        let triangles: u64 = faces().map(|face| face.casters.triangles_drawn()).sum();
        let coarse: u64 = faces().map(|face| face.casters.coarse.triangles_drawn()).sum();
        BTreeMap::from([
            ("vpl_maps", of_lights.iter().filter(|faces| !faces.is_empty()).count() as f64),
            ("vpl_map_faces", faces().count() as f64),
            ("vpl_map_triangles_drawn", triangles as f64),
            ("vpl_map_coarse_triangles_drawn", coarse as f64),
            ("vpl_map_turns", turns(Some(&self.maps), of_lights.len() as u32).count() as f64),
        ])
    }

    /// From now on, maps are those of `vpls`, as many as before.
    ///
    /// Errors: memory for the upload, more draws than can be recorded (exit code 4).
    pub fn begin_run(&self, run: &Run<'_>, vpls: &[VplBlock]) -> Result<()> {
        let draws = MapDraws::of(&self.maps, run.scene, run.view, run.scene_gpu, &self.coarse, vpls)?;
        draws.upload(run.gpu, &self.views, &self.blocks)?;
        self.draws.replace(draws);
        Ok(())
    }
}
