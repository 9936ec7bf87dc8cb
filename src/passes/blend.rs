//! BLEND surfaces over the finished picture: forward, back to front by their boxes' middles, counted.
//! Shaders: mesh.vert, blend.frag.
//! reads  the scene, the lights, their lists, the depth of solid surfaces      writes  the picture
//!
//! Punctual lights come from a list for each piece of a draw (`lights::object_lists`). A fragment stage reads each light for one
//! pixel, at 19 ns a light on lavapipe, where a compute stage that reads it for 16 to 32 pixels takes 2.3: without lists what
//! blends took 27 to 83 % of the frames of two maps of a thousand lights, with them 4 to 39 % (640x360, `--cull tiled`).
//!
//! Their indirect light comes from all virtual point lights, or from the subset of the pixel as that of every other
//! surface does. A blended surface has no neighbours to filter with, so that its subsets show as a faint pattern; hall at
//! 1024x768, 480 lights, 8x6: FLIP against every light on every pixel is 0.0431 with subsets and 0.0415 without, and the
//! pass takes 15 ms instead of 104 on lavapipe.

use super::mesh;
use super::samples::Samples;
use super::shadow_maps::{self, ShadowMaps};
use crate::caps::{Ability, Caps, Need};
use crate::error::Result;
use crate::frame::View;
use crate::gpu::pipeline::{Blending, DepthBias, GraphicsDescription, GraphicsPipeline};
use crate::gpu::shader::passes::blend::FRAG_VARIANTS;
use crate::gpu::shader::structs::{BlendParams, LightBlock};
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, ColorTarget, Commands, Edge, Gpu, Image, Traffic, upload};
use crate::lights::object_lists::{ObjectLights, ObjectLists, PieceLights};
use crate::plan::{Plan, Resources};
use crate::resident::{DrawCall, SceneGpu};
use crate::scene::{AlphaMode, Scene};
use crate::settings::Values;
use ash::vk;
use bytemuck::Zeroable;
use glam::Vec3;
use std::sync::Arc;

/// How much nearer BLEND surfaces are drawn: a decal in the plane of what it lies on is seen whole, though corners are rounded
/// to a 256th of a pixel or finer and depths of two triangles of one plane differ by some steps.
pub const DECAL_BIAS: DepthBias = DepthBias { slope: 1.0 / 32.0, steps: 8.0 };

/// What the fragment stage reads beside the scene.
pub struct BlendLights<'a> {
    pub lights: &'a Buffer,
    pub vpls: &'a Buffer,
    /// Stretches of `vpls`; read where the pattern is not 0x0.
    pub subsets: &'a Buffer,
    pub bvh_nodes: &'a Buffer,
    pub bvh_triangles: &'a Buffer,
    /// `ObjectLists::entries`.
    pub lists: &'a Buffer,
    /// Where the pass was made with shadow maps.
    pub shadow_maps: Option<Edge<'a, ShadowMaps>>,
}

/// The picture of what is solid, which the pass blends over.
pub struct SolidPicture<'a> {
    pub depth: Edge<'a, Image>,
    /// The layer, where it blends over nothing: old contents are not needed.
    pub color: Edge<'a, Image>,
}

/// What BLEND surfaces are blended over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Over {
    /// The picture of what is solid.
    Picture,
    /// Nothing: a layer of what they send, premultiplied, and of how much they cover, for the picture of what is solid.
    Nothing,
}

/// What the pass needs of a device, where the scene has BLEND surfaces.
pub fn needs(has_blend: bool) -> Option<Need> {
    let of = "a scene with BLEND surfaces".to_owned();
    has_blend.then_some(Need { of, ability: Ability::BlendFloats, instead: "scenes without them can be rendered" })
}

/// What the pass touches: depth and picture of these full names.
pub fn touches(depth: &str, picture: &str) -> [(String, Access); 2] {
    [(depth.to_owned(), Access::DepthTest), (picture.to_owned(), Access::ColorWrite)]
}

/// Which punctual lights the surfaces are under, and what they are drawn into.
pub struct BlendTarget<'a> {
    /// `ObjectLists::pieces`.
    pub pieces: &'a [Vec<PieceLights>],
    pub samples: Samples,
    /// Lights have shadow maps; the constants are those of `MapLayout::constants` too.
    pub has_shadow_maps: bool,
    /// What stops virtual point lights, as the shader's axis names it.
    pub vpl_shadow: &'static str,
    pub over: Over,
}

impl<'a> BlendTarget<'a> {
    /// One sample over the picture, no shadow maps, virtual lights that nothing stops.
    pub fn plain(lists: &'a ObjectLists) -> Self {
        Self {
            pieces: &lists.pieces,
            samples: Samples::ONE,
            has_shadow_maps: false,
            vpl_shadow: "none",
            over: Over::Picture,
        }
    }
}

/// Every virtual point light on every pixel, none nearer than the root of `least_squared` (m^2).
pub fn all_lights(least_squared: f32) -> BlendParams {
    BlendParams { least_squared, weight: 1.0, ..BlendParams::zeroed() }
}

/// The BLEND draws, farthest first, by the middles of their boxes.
pub fn back_to_front(scene: &SceneGpu, view: &View) -> Vec<DrawCall> {
    let mut calls: Vec<DrawCall> = scene.calls.iter().filter(|call| call.alpha == AlphaMode::Blend).copied().collect();
    sort_farthest_first(&mut calls, view, |call| call.center_ws);
    calls
}

/// The same, each side for itself: of what is closed, the wall behind comes before the one in front.
pub fn sides_back_to_front(scene: &SceneGpu, view: &View) -> Vec<DrawCall> {
    let apart = |call: DrawCall| call.sides.apart().iter().map(move |sides| DrawCall { sides: *sides, ..call });
    back_to_front(scene, view).into_iter().flat_map(apart).collect()
}

/// Sorts BLEND draws as they are drawn, by `center_ws`, the middle of a draw's box; equally far ones stay in their order.
pub fn sort_farthest_first<T>(draws: &mut [T], view: &View, center_ws: impl Fn(&T) -> Vec3) {
    let distance = |draw: &T| center_ws(draw).distance_squared(view.eye());
    draws.sort_by(|a, b| distance(b).total_cmp(&distance(a)));
}

/// The lists of BLEND surfaces, where all others are shaded from a G-buffer. `lights`: the punctual lights of the picture.
///
/// Errors: as `ObjectLists::new`.
pub fn lists(scene: &Scene, lights: &[LightBlock], values: &Values, caps: &Caps) -> Result<ObjectLists> {
    let choice = values.choice("light-lists");
    ObjectLists::blended(scene, lights, choice, caps.limits.max_storage_buffer_range_bytes)
}

fn lists_name(technique: &str) -> String {
    format!("{technique}.blend.lists")
}

/// Plans `lists`, as a resource of `technique`.
pub fn plan_lists(plan: &mut Plan, technique: &str, lists: &ObjectLists) {
    plan.buffer("lights", lists_name(technique), size_of_val(&lists.entries[..]) as u64);
}

/// The planned lists, filled.
///
/// Errors: memory for the copy (exit code 4).
pub fn upload_lists(gpu: &Arc<Gpu>, resources: &mut Resources, technique: &str, lists: &ObjectLists) -> Result<Buffer> {
    let buffer = resources.buffer(&lists_name(technique));
    upload::buffer(gpu, &buffer, bytemuck::cast_slice(&lists.entries), Access::GraphicsRead)?;
    Ok(buffer)
}

/// Numbers for the report's `counters`; none where nothing blends.
pub fn counters(lists: &ObjectLists) -> impl Iterator<Item = (&'static str, f64)> {
    let [mean, most] = lists.lights_per_piece();
    let count = lists.pieces.iter().flatten().count();
    let all =
        [("blended_pieces", count as f64), ("blended_lights_per_piece", mean), ("blended_lights_per_piece_most", most)];
    all.into_iter().filter(move |_| count > 0)
}

pub struct Blend {
    pipeline: GraphicsPipeline,
    /// The pieces of draws, farthest draw first.
    calls: Vec<DrawCall>,
    params: BlendParams,
    /// Each call's.
    lights: Vec<ObjectLights>,
    over: Over,
}

impl Blend {
    /// None where the scene has no BLEND surface. `constants`: `DirectSettings::light_constants`.
    pub fn new(
        gpu: &Arc<Gpu>,
        scene: &SceneGpu,
        view: &View,
        params: BlendParams,
        constants: &[(&str, u32)],
        target: &BlendTarget<'_>,
    ) -> Result<Option<Self>> {
        let shadows = shadow_maps::axis(target.has_shadow_maps);
        let of_piece = |call: DrawCall, piece: &PieceLights| DrawCall {
            first_index: call.first_index + 3 * piece.triangles.start,
            index_count: 3 * piece.triangles.len() as u32,
            ..call
        };
        let (calls, lights): (Vec<DrawCall>, Vec<ObjectLights>) = sides_back_to_front(scene, view)
            .into_iter()
            .flat_map(|call| {
                target.pieces[call.draw as usize].iter().map(move |piece| (of_piece(call, piece), piece.lights))
            })
            .unzip();
        if calls.is_empty() {
            return Ok(None);
        }
        let pipeline = GraphicsPipeline::new(
            gpu,
            &GraphicsDescription {
                vertex: mesh::vertex_shader(scene),
                geometry: None,
                fragment: Some(variant(
                    FRAG_VARIANTS,
                    &[mesh::vertex_name(scene), shadows, target.samples.shaded_name(), target.vpl_shadow],
                )),
                constants: &[constants, &[scene.texture_constant()]].concat(),
                vertex_buffers: mesh::vertex_buffers(scene),
                color_formats: &[target.samples.format],
                samples: target.samples.count,
                are_placed: target.samples.are_placed,
                blending: match target.over {
                    Over::Picture => Blending::Over,
                    Over::Nothing => Blending::Layer,
                },
                depth_format: Some(vk::Format::D32_SFLOAT),
                depth_write: false,
                depth_compare: mesh::DEPTH_COMPARE,
                depth_clamp: false,
                depth_bias: DECAL_BIAS,
                conservative_margin_px: None,
                stencil: None,
                foreign_sets: &[scene.material_layout],
            },
        )?;
        Ok(Some(Self { pipeline, calls, params, lights, over: target.over }))
    }

    /// Draws over `solid` what blends.
    ///
    /// Errors: the driver has no more room for sets (exit code 4).
    pub fn record(
        &self,
        cmd: &mut Commands,
        technique: &str,
        frame: &Buffer,
        scene: &SceneGpu,
        lights: &BlendLights<'_>,
        solid: SolidPicture<'_>,
    ) -> Result<()> {
        let SolidPicture { depth, color } = solid;
        cmd.pass(&format!("{technique}.blend"), Traffic::default(), |cmd| {
            let (drawn, clear) = match self.over {
                Over::Picture => (color.to(Access::ColorWrite), None),
                Over::Nothing => {
                    (color.resource.discard(Access::ColorWrite), Some(vk::ClearColorValue { float32: [0.0; 4] }))
                }
            };
            cmd.barriers([depth.to(Access::DepthTest), drawn]);
            cmd.barriers(lights.shadow_maps.and_then(|maps| maps.to(Access::FragmentSample)));
            let extent = color.resource.description.extent;
            cmd.begin_rendering(
                extent,
                &[ColorTarget::new(color.resource, clear)],
                Some((depth.resource, None, Access::DepthTest)),
            );
            mesh::bind_streams(cmd, scene);
            let mut bound = mesh::bound(frame, scene);
            bound.extend([
                ("Materials", Bound::Buffer(&scene.materials)),
                ("Lights", Bound::Buffer(lights.lights)),
                ("Vpls", Bound::Buffer(lights.vpls)),
                ("Subsets", Bound::Buffer(lights.subsets)),
                ("BvhNodes", Bound::Buffer(lights.bvh_nodes)),
                ("BvhTriangles", Bound::Buffer(lights.bvh_triangles)),
                ("LightLists", Bound::Buffer(lights.lists)),
            ]);
            bound.extend(lights.shadow_maps.iter().flat_map(|maps| maps.resource.bound()));
            cmd.bind_graphics(&self.pipeline, bytemuck::bytes_of(&self.params), &bound)?;
            let mut lights = self.lights.iter();
            mesh::draw_each(cmd, &self.pipeline, scene, &self.calls, |_| {
                let lights = lights.next().expect("each call has its lights");
                let params = BlendParams { object: lights.block(), ..self.params };
                cmd.push(&self.pipeline.interface, bytemuck::bytes_of(&params));
            });
            cmd.end_rendering();
            Ok(())
        })
    }
}
