//! Which light has which shadow maps, from where each is drawn, and how large all of them are: arithmetic, before anything
//! is made.

use crate::caps::Caps;
use crate::error::{Error, Result};
use crate::frame::View;
use crate::gpu::shader::structs::ShadowMapBlock;
use crate::gpu::{Access, ImageDescription};
use crate::lights::LightSet;
use crate::passes::shadow_maps::format::{FORMAT, blocks_name, depth_name, filter, pass, views_name};
use crate::passes::shadow_maps::projection::{across, around, depths, face_axes, perspective};
use crate::plan::{Plan, Requirements, Shape};
use crate::resident::SceneStats;
use crate::scene::{Bounds, Camera, Light, LightSource, Scene};
use crate::settings::{DirectShadow, GeometryChoice, MapDrawing, MapFilter, Values};
use crate::shading::light;
use crate::units::{Bytes, Extent};
use ash::vk;
use bytemuck::Zeroable;
use glam::{Mat4, Vec3};

/// Row of the memory table.
const GROUP: &str = "shadow_maps";
/// Greatest half angle of a cone with one map, radians: 89 degrees. A wider one has the six of a point light.
const MOST_CONE: f32 = 89.0 * std::f32::consts::PI / 180.0;
/// Texels that a map has beyond what it must hold, on each side: what four comparisons reach.
const BORDER_PX: f32 = 1.0;
/// The least that `--shadow-map-size` may be.
const LEAST_SIZE_PX: u32 = 16;

/// The shadow maps of a picture.
#[derive(Clone)]
pub struct MapLayout {
    /// One for each light.
    pub(super) blocks: Vec<ShadowMapBlock>,
    /// One for each layer.
    pub(super) views: Vec<View>,
    pub(super) filter: MapFilter,
    /// Texels whose change of depth surfaces are pushed away by.
    pub(super) slope_bias_px: f32,
    pub(super) casters: GeometryChoice,
    /// Whether they are drawn before the first frame, and kept.
    pub(super) is_once: bool,
    size_px: u32,
    bias_m: f32,
    cutoff_lux: f32,
}

impl MapLayout {
    /// The maps of `lights` where `--direct-shadow` is `map` and there are any. `scene`: as it stands in them.
    ///
    /// Errors: a side or the number of layers is beyond the device's (exit code 2), the bytes are beyond its images, its
    /// memory or the budget (4).
    pub fn new(
        values: &Values,
        lights: &LightSet,
        scene: &Scene,
        stats: &SceneStats,
        caps: &Caps,
        requirements: Requirements<'_>,
    ) -> Result<Option<Self>> {
        if !values.is("direct-shadow", DirectShadow::Map) || lights.lights.is_empty() {
            return Ok(None);
        }
        let size_px = values.integer("shadow-map-size") as u32;
        let layer_count: u32 = lights.lights.iter().map(|light| LightMaps::of(light).layer_count()).sum();
        let asked = MapDemand { size_px, layer_count, light_count: lights.lights.len() };
        asked.require_fitting(values, stats, caps, requirements)?;
        let mut layout = Self {
            blocks: Vec::new(),
            views: Vec::new(),
            filter: filter(values, caps),
            slope_bias_px: values.number("shadow-slope-bias") as f32,
            casters: values.choice("shadow-casters"),
            is_once: values.is("shadow-maps", MapDrawing::Once),
            size_px,
            bias_m: values.length("shadow-bias", scene.lasting_bounds().diagonal().max(1e-6)),
            cutoff_lux: values.number("light-cutoff") as f32,
        };
        layout.see(lights, scene);
        Ok(Some(layout))
    }

    /// For maps that move from run to run: any triangle may come into one.
    pub fn hold_all_casters(&mut self) {
        self.casters = GeometryChoice::All;
    }

    /// The same maps of `lights` and `scene` at another moment: as many lights of the same kinds.
    pub fn see(&mut self, lights: &LightSet, scene: &Scene) {
        (self.blocks, self.views) = (Vec::new(), Vec::new());
        let bounds = match scene.bounds() {
            bounds if bounds.is_empty() => Bounds { min: Vec3::ZERO, max: Vec3::ZERO },
            bounds => bounds,
        };
        for light in &lights.lights {
            self.add(light, light::block(light, self.cutoff_lux).intensity[3], &bounds);
        }
    }

    /// `range`: metres, 0 where the light does not end.
    fn add(&mut self, light: &Light, range: f32, bounds: &Bounds) {
        let first_layer = self.views.len() as u32;
        let maps = LightMaps::of(light);
        let block = ShadowMapBlock { first_layer, layer_count: maps.layer_count(), ..ShadowMapBlock::zeroed() };
        let border = self.size_px as f32 / (self.size_px as f32 - 2.0 * BORDER_PX);
        let block = match maps {
            LightMaps::Parallel { direction } => {
                self.views.push(self.view(around(bounds, direction, border)));
                ShadowMapBlock { clip_from_world: self.last_clip(), ..block }
            }
            LightMaps::Cone { position, direction, half_angle } => {
                let tangent = border * half_angle.tan();
                let depths = depths(position, range, tangent, bounds);
                let (right, up) = across(direction);
                let axes = [right, up, -direction];
                self.views.push(self.view(perspective(position, axes, tangent, depths)));
                ShadowMapBlock { clip_from_world: self.last_clip(), ..block }
            }
            LightMaps::Cube { position } => {
                let [near, far] = depths(position, range, border, bounds);
                for face in 0..6 {
                    let camera = perspective(position, face_axes(face), border, [near, far]);
                    self.views.push(self.view(camera));
                }
                // As View::clip_from_world has it.
                ShadowMapBlock {
                    depth_far: -near / (far - near),
                    depth_over: near * far / (far - near),
                    face_scale: 1.0 / border,
                    ..block
                }
            }
        };
        self.blocks.push(block);
    }

    fn view(&self, camera: Camera) -> View {
        View { extent: Extent::new(self.size_px, self.size_px), camera, made_up: false }
    }

    fn last_clip(&self) -> [[f32; 4]; 4] {
        self.views.last().map_or(Mat4::IDENTITY, View::clip_from_world).to_cols_array_2d()
    }

    /// Plans the maps as resources of `technique`, and the pass that draws them, where every frame does, as its next one.
    pub fn plan(&self, plan: &mut Plan, technique: &str) {
        let description = description(self.size_px, self.views.len() as u32);
        plan.push(GROUP, depth_name(technique), Shape::Image(description));
        plan.buffer(GROUP, blocks_name(technique), size_of_val(self.blocks.as_slice()) as u64);
        plan.buffer(GROUP, views_name(technique), (self.views.len() * size_of::<Mat4>()) as u64);
        if !self.is_once {
            plan.pass(pass(technique), [(depth_name(technique), Access::DepthWrite)]);
        }
    }

    /// The maps, as a pass touches them whose fragments read them; None for maps that are kept.
    pub fn read(&self, technique: &str) -> Option<(String, Access)> {
        self.read_by(technique, Access::FragmentSample)
    }

    /// The same for a pass that reads them by `access`.
    pub fn read_by(&self, technique: &str, access: Access) -> Option<(String, Access)> {
        (!self.is_once).then(|| (depth_name(technique), access))
    }

    /// Clip space of each layer, column by column.
    pub(super) fn clips(&self) -> Vec<[[f32; 4]; 4]> {
        self.views.iter().map(|view| view.clip_from_world().to_cols_array_2d()).collect()
    }

    /// SHADOW_BIAS and SHADOW_FILTER.
    pub fn constants(&self) -> [(&'static str, u32); 2] {
        let filter = u32::from(self.filter == MapFilter::Gather);
        [("SHADOW_BIAS", self.bias_m.to_bits()), ("SHADOW_FILTER", filter)]
    }

    /// Resolved value of `--shadow-filter`.
    pub fn resolved(&self) -> (&'static str, String) {
        ("shadow-filter", self.filter.name().to_owned())
    }
}

fn description(size_px: u32, layer_count: u32) -> ImageDescription {
    use vk::ImageUsageFlags as Usage;
    let usage = Usage::DEPTH_STENCIL_ATTACHMENT | Usage::SAMPLED;
    let plain = ImageDescription::plain(Extent::new(size_px, size_px), FORMAT, 1, usage);
    ImageDescription { layer_count: Some(layer_count), ..plain }
}

/// Which maps show all that a light may reach.
enum LightMaps {
    /// One in parallel projection, along `direction`.
    Parallel { direction: Vec3 },
    /// One in perspective, around the cone.
    Cone { position: Vec3, direction: Vec3, half_angle: f32 },
    /// Six in perspective, a cube's faces around the light.
    Cube { position: Vec3 },
}

impl LightMaps {
    fn of(light: &Light) -> Self {
        match (light.source(), light.kind.half_angle()) {
            (LightSource::Along(direction), _) => Self::Parallel { direction },
            (LightSource::At(position), Some(half_angle)) if half_angle <= MOST_CONE => {
                Self::Cone { position, direction: light.direction, half_angle }
            }
            (LightSource::At(position), _) => Self::Cube { position },
        }
    }

    fn layer_count(&self) -> u32 {
        match self {
            Self::Parallel { .. } | Self::Cone { .. } => 1,
            Self::Cube { .. } => 6,
        }
    }
}

/// How many maps of which size.
struct MapDemand {
    size_px: u32,
    layer_count: u32,
    light_count: usize,
}

impl MapDemand {
    /// Errors: as `MapLayout::new`.
    fn require_fitting(
        &self,
        values: &Values,
        stats: &SceneStats,
        caps: &Caps,
        requirements: Requirements<'_>,
    ) -> Result<()> {
        let Self { size_px, layer_count, light_count } = *self;
        let limits = &caps.limits;
        if size_px > limits.max_image_side_px {
            let most = limits.max_image_side_px;
            let why = format!("--shadow-map-size {size_px}: this device allows {most} pixels a side");
            return Err(Error::request(why).note(format!("--shadow-map-size {most} would fit")));
        }
        if layer_count > limits.max_image_layers {
            let why = format!(
                "--direct-shadow map: {light_count} lights have {layer_count} shadow maps: this device allows {} in an image",
                limits.max_image_layers
            );
            let out = "fewer lights would fit (six maps a point light); --direct-shadow ray needs no maps";
            return Err(Error::request(why).note(out));
        }
        let budget_bytes = caps.budget_bytes(values.bytes("memory-budget"));
        let image_bytes = requirements.greatest_image_bytes(&description(size_px, layer_count));
        let held_bytes = stats.plan().bytes();
        let (holds, room) = [
            ("one image of this device holds", image_bytes.min(limits.max_allocation_bytes)),
            ("beside the scene memory has", budget_bytes.saturating_sub(held_bytes)),
        ]
        .into_iter()
        .min_by_key(|(_, room)| *room)
        .expect("there are two");
        let bytes = |size_px: u32| description(size_px, layer_count).bytes();
        if bytes(size_px) <= room {
            return Ok(());
        }
        let mut powers = (LEAST_SIZE_PX.ilog2()..=size_px.ilog2()).rev().map(|power| 1 << power);
        let fitting = powers.find(|size_px| bytes(*size_px) <= room);
        Err(Error::memory(format!(
            "--shadow-map-size {size_px}: the {layer_count} maps of {light_count} lights need {}, and {holds} {}",
            Bytes(bytes(size_px)),
            Bytes(room)
        ))
        .note(match fitting {
            Some(size_px) => format!("--shadow-map-size {size_px} would fit: {}", Bytes(bytes(size_px))),
            None => "no size would fit; --direct-shadow ray needs no maps".to_owned(),
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::caps::known;
    use crate::scene::LightKind;
    use crate::settings::{COMMON, MAPPED_DIRECT_SHADOW, SHADOW_MAPS};
    use proptest::prelude::*;

    const ROOM: Bounds = Bounds { min: Vec3::new(-4.0, -1.0, -3.0), max: Vec3::new(5.0, 3.0, 2.0) };

    fn light(kind: LightKind, position: Vec3, direction: Vec3) -> Light {
        Light { name: String::new(), kind, intensity: Vec3::ONE, position, direction, range: None, radius: 0.0 }
    }

    fn values(changes: &[(&str, &str)]) -> Values {
        let rows: Vec<_> = COMMON.iter().chain(SHADOW_MAPS).chain([&MAPPED_DIRECT_SHADOW]).copied().collect();
        let mut values = Values::defaults(&rows);
        for (key, text) in [("direct-shadow", "map")].iter().chain(changes) {
            values.set(rows.iter().find(|row| row.key == *key).unwrap(), text).unwrap();
        }
        values
    }

    fn layout(lights: Vec<Light>, changes: &[(&str, &str)], caps: &Caps) -> Result<Option<MapLayout>> {
        let set = LightSet {
            lights,
            ambient: Vec3::ZERO,
            has_rig: false,
            faint_part: None,
            is_emissive_alone: false,
            has_punctual: true,
        };
        let rules = caps.layout.as_ref().unwrap();
        let scene = Scene { reach: Some(ROOM), ..Scene::default() };
        let stats = SceneStats::of(&scene);
        MapLayout::new(&values(changes), &set, &scene, &stats, caps, Requirements::Rules(rules))
    }

    /// The maps of one light in a room.
    fn of(light: &Light, range: f32) -> MapLayout {
        let mut layout = layout(vec![], &[], &known::caps(known::DEFAULT).unwrap()).unwrap();
        assert!(layout.take().is_none(), "no light, no map");
        let mut layout = MapLayout {
            blocks: vec![],
            views: vec![],
            filter: MapFilter::Nearest,
            slope_bias_px: 0.0,
            casters: GeometryChoice::All,
            is_once: false,
            size_px: 16,
            bias_m: 0.0,
            cutoff_lux: 0.0,
        };
        layout.add(light, range, &ROOM);
        layout
    }

    /// Layer and place that shadow_maps.glsl asks at.
    fn asked(block: &ShadowMapBlock, light: &Light, at_ws: Vec3) -> (u32, Vec3) {
        if block.layer_count == 1 {
            let clip = Mat4::from_cols_array_2d(&block.clip_from_world) * at_ws.extend(1.0);
            return (block.first_layer, clip.truncate() / clip.w);
        }
        let away = at_ws - light.position;
        let size = away.abs();
        let axis = if size.z > size.x.max(size.y) { 2 } else { usize::from(size.y > size.x) };
        let [along, next, after] = [0, 1, 2].map(|step| away[(axis + step) % 3]);
        let scale = block.face_scale / along.abs();
        let depth = block.depth_far + block.depth_over / along.abs();
        let face = 2 * axis as u32 + u32::from(along < 0.0);
        (block.first_layer + face, Vec3::new(next * scale, after * along.signum() * scale, depth))
    }

    fn point_in_room(parts: [f32; 3]) -> Vec3 {
        ROOM.min + (ROOM.max - ROOM.min) * Vec3::from_array(parts)
    }

    proptest! {
        /// Where a shader asks is where the rasteriser has put the point, inside the map by what a filter reaches.
        #[test]
        fn shaders_ask_where_maps_are_drawn(
            at in [0f32..1.0, 0f32..1.0, 0f32..1.0],
            from in [-0.5f32..1.5, -0.5f32..1.5, -0.5f32..1.5],
            towards in [-1f32..1.0, -1f32..1.0, -1f32..1.0],
            kind in 0u32..3,
        ) {
            let (at_ws, position) = (point_in_room(at), point_in_room(from));
            let direction = Vec3::from_array(towards).try_normalize().unwrap_or(Vec3::X);
            let kind = match kind {
                0 => LightKind::Directional,
                1 => LightKind::Point,
                _ => LightKind::Spot { inner_angle: 0.1, outer_angle: 1.2 },
            };
            let light = light(kind, position, direction);
            let away = at_ws - position;
            let lit = match kind {
                LightKind::Spot { outer_angle, .. } => away.normalize_or_zero().dot(direction) > outer_angle.cos(),
                _ => true,
            };
            prop_assume!(lit && away.length() > 0.2);
            let layout = of(&light, 0.0);
            let (layer, place) = asked(&layout.blocks[0], &light, at_ws);
            let drawn = layout.views[layer as usize].clip_from_world().project_point3(at_ws);
            prop_assert!((place - drawn).abs().max_element() < 2e-5, "{place} and {drawn} of layer {layer}");
            let most = 1.0 - 2.0 * BORDER_PX / 16.0 + 1e-4;
            prop_assert!(place.x.abs() <= most && place.y.abs() <= most, "{place}");
            prop_assert!((0.0..=1.0).contains(&place.z), "{place}");
        }

        /// A light that ends has all of what it reaches between its planes, and depth falls with the distance.
        #[test]
        fn depth_falls_from_the_near_plane_to_where_light_ends(range in 0.5f32..20.0, part in 0.05f32..0.9) {
            let light = light(LightKind::Point, Vec3::new(0.5, 1.0, -0.5), -Vec3::Y);
            let layout = of(&light, range);
            let farthest = (ROOM.max - light.position).max(light.position - ROOM.min).length();
            let far = range.min(farthest);
            let [nearer, farther] = [part, 1.1 * part].map(|part| light.position + Vec3::X * (part * far));
            let depth = |at| asked(&layout.blocks[0], &light, at).1.z;
            prop_assert!(depth(nearer) > depth(farther) && depth(farther) >= 0.0 && depth(nearer) <= 1.0);
        }
    }

    #[test]
    fn a_wide_spot_has_six_maps_and_others_one() {
        let spot = |degrees: f32| LightKind::Spot { inner_angle: 0.0, outer_angle: degrees.to_radians() };
        let kinds = [spot(5.0), spot(88.9), spot(90.0), LightKind::Point, LightKind::Directional];
        let counts = kinds.map(|kind| LightMaps::of(&light(kind, Vec3::ZERO, -Vec3::Y)).layer_count());
        assert_eq!(counts, [1, 1, 6, 6, 1]);
        let lights = [spot(20.0), LightKind::Point, LightKind::Directional];
        let lights = lights.map(|kind| light(kind, Vec3::ZERO, -Vec3::Y)).to_vec();
        let made = layout(lights, &[], &known::caps(known::DEFAULT).unwrap()).unwrap().unwrap();
        let firsts: Vec<[u32; 2]> = made.blocks.iter().map(|block| [block.first_layer, block.layer_count]).collect();
        assert_eq!((firsts, made.views.len()), (vec![[0, 1], [1, 6], [7, 1]], 8));
    }

    #[test]
    fn maps_that_do_not_fit_are_refused_with_what_would() {
        let caps = known::caps(known::DEFAULT).unwrap();
        let refused = |count: usize, changes: &[(&str, &str)]| {
            let lights = vec![light(LightKind::Point, Vec3::ZERO, -Vec3::Y); count];
            let error = layout(lights, changes, &caps).err().expect("too much was asked for");
            (error.exit_code(), error.to_string())
        };
        // 120 maps of 4 MiB.
        let (code, text) = refused(20, &[("memory-budget", "200MiB")]);
        assert_eq!(code, 4, "{text}");
        assert!(text.contains("the 120 maps of 20 lights need 480 MiB"), "{text}");
        assert!(text.contains("--shadow-map-size 512 would fit: 120 MiB"), "{text}");
        let (code, text) = refused(20, &[("memory-budget", "64KiB")]);
        assert!(code == 4 && text.contains("no size would fit; --direct-shadow ray"), "{text}");
        // 2 GiB is what the driver's heap and its greatest allocation are.
        let (code, text) = refused(1, &[("shadow-map-size", "8192"), ("memory-budget", "1GiB")]);
        assert!(code == 4 && text.contains("--shadow-map-size 4096 would fit: 384 MiB"), "{text}");
        let (code, text) = refused(342, &[("shadow-map-size", "16")]);
        assert!(code == 2 && text.contains("2052 shadow maps: this device allows 2048"), "{text}");
        let mut small = caps.clone();
        small.limits.max_image_side_px = 4096;
        let lights = vec![light(LightKind::Directional, Vec3::ZERO, -Vec3::Y)];
        let error = layout(lights, &[("shadow-map-size", "8192")], &small).err().unwrap().to_string();
        assert!(error.contains("4096 pixels a side") && error.contains("--shadow-map-size 4096 would fit"), "{error}");
    }
}
