//! Path tracing: the integral that the other techniques approximate, with a switch for each part of it that one of them
//! leaves out, so that each is judged against what it claims to compute.
//!
//! Passes: sample, once for each path of a pixel (`--spp`).
//!
//! Paths start at the camera, anywhere in their pixel (box filter; `--pixel middle` in its middle). At each surface one punctual light is chosen as strongly
//! as each would light it, and one point of an emitter by power; both send a shadow ray, and a direction is drawn by the
//! BRDF. Points of emitters that either way finds are weighed by the power heuristic. Numbers are a Sobol sequence,
//! Owen-scrambled for each pixel (src/sampling/sobol.rs).
//!
//! What it takes for light
//! - punctual lights and materials: as the others do (glsl/shading/light.glsl, brdf.glsl, glTF's window included)
//! - emissive triangles: seen always; they light others with `--emissive`
//! - rays that leave the scene: those from the camera find `--background`, those from surfaces `--background` and
//!   `--ambient` together. What the others add to every surface as ambient light comes from outside here, and is shadowed;
//!   with `--ambient-visibility off` it is added to the surface that is seen, as the others do, and nothing comes from outside;
//!   with `seen` what leaves that surface finds `--ambient` alone, and other rays nothing
//! - backs of single-sided surfaces: not there for the camera, as the others draw them; for all other rays black walls, as
//!   for the shadow rays and light walks of the others
//! - MASK surfaces have their holes for every ray, BLEND surfaces stop the part of all rays that alpha says (the others'
//!   shadow rays take the first for solid and the second for nothing)
//! - `--rays`: rays go through this program's tree or, by ray queries, through a structure that the driver builds over the
//!   same triangles; the two pictures differ where a ray grazes an edge or meets two triangles at one distance
//! - occlusion maps: not read, because rays find what they stand for; with `--ambient-visibility off` none does, and they are
//! - unlit surfaces: seen in their colour, black for all other rays
//! - textures: `--texture-level cone` reads the level that a cone through the pixel asks for, by the triangle's constant of
//!   Akenine-Moeller et al. (2019, Texture level of detail strategies for real-time ray tracing). From a surface on the cone
//!   grows by its roughness squared a metre, by one from `--brdf lambert` and in a medium (ours); bent surfaces and the lens
//!   widen it no more. Alpha and emission stay at the finest level, so that nothing thins out and both ways to an emitter agree
//! - `--aperture`: a thin lens, whose points rays leave evenly
//! - `--stereo`: that lens to the camera's left, or to its right (`--stereo-eyes right`)
//! - `--shutter`: corners, normals, tangents, camera and lights on straight lines between their places when it opens and
//!   when it closes, one moment a path; chances of emitters are those of the opening
//! - `--volume`: values on a grid that emit and absorb along the ray that the camera sees, up to the first surface; other rays
//!   pass it unseen. The ray is walked in steps of parts of a voxel (`--volume-steps`)
//! - `--medium`: a homogeneous medium in the box around all that is drawn, the eye and the lights. On each stretch of a path
//!   one light, chosen by power, is looked for at one place, drawn by the angle under which the light sees the stretch or as
//!   transmittance falls (Kulla and Fajardo 2012); emitters by the phase function too, weighed as at surfaces. With
//!   `--airlight seen` the stretch that the camera sees is the only one, and light of lights all that is scattered
//!
//! Equal to others: `--transport direct` is `deferred --direct-shadow ray`; `--transport one-bounce --vpl-visibility off` is
//! the limit of `interleaved_deferred --split none` with ever more virtual point lights.

mod airlight;
mod bench_stages;
mod resources;
pub mod sample;
pub mod settings;

use super::bench_stage::BenchStage;
use super::notes::{self, Figures};
use super::shutter_close::ShutterClose;
use super::until_error::{sample_count, until_error};
use super::{Frame, HostPart, Inputs, Prepared, Sums, Technique, Tuned, emissive_lights};
use crate::bvh::Bvh;
use crate::bvh::nodes::{Nodes, Walk};
use crate::caps::{Ability, Caps, Need};
use crate::error::{Error, Result};
use crate::gpu::shader::structs::{FrameBlock, LightBlock, SampleParams, SourceBlock};
use crate::gpu::{Access, Buffer, Commands, Gpu, Image};
use crate::lens::Lens;
use crate::lights::LightSet;
use crate::lights::emitters::{self, Emitters};
use crate::passes::{direct, workgroup};
use crate::picture::Aov;
use crate::plan::{Plan, Resources};
use crate::resident::SceneGpu;
use crate::resident::traced::{Layout, Rays, Reads};
use crate::resident::volume::PlacedVolume;
use crate::scene::{AlphaMode, Light, Material, Medium};
use crate::settings::{Brdf, Setting, StackPlace, TREE, VOLUME_PLACE, Values, WORKGROUP};
use crate::techniques::path_traced::resources::{COLOR, NAME, SUMS};
use crate::techniques::path_traced::settings::{AmbientVisibility, PixelPlace, RaySource, Transport};
use airlight::Air;
use bytemuck::Zeroable;
use glam::Vec3;
use sample::{Choices, PathLights, PathTree, SUM_BYTES, Sample};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Rays start this part of the scene's diagonal off their surface: a hundred times what floats place points off by.
const RAY_OFFSET: f32 = 1e-5;

pub struct PathTraced;

impl Technique for PathTraced {
    fn name(&self) -> &'static str {
        NAME
    }

    fn summary(&self) -> &'static str {
        "path tracing: the integral that the others approximate"
    }

    fn scene(&self) -> &'static str {
        "cornell"
    }

    fn settings(&self) -> &'static [&'static [Setting]] {
        &[settings::SETTINGS, VOLUME_PLACE, TREE]
    }

    fn aovs(&self) -> &'static [&'static str] {
        &[]
    }

    fn needs(&self, values: &Values, _: &Caps, _: bool) -> Vec<Need> {
        let instead = "--rays tree walks a tree of this program's, to the same picture";
        let query = Need { of: "--rays query".to_owned(), ability: Ability::RayQuery, instead };
        Vec::from_iter(values.is("rays", RaySource::Query).then_some(query))
    }

    fn bounds(&self, _: &Caps) -> Vec<(&'static str, String)> {
        Vec::new()
    }

    fn tuned(&self) -> Tuned {
        &[
            ("node-width", &["4", "2"]),
            ("node-layout", &["depth-first", "breadth-first", "van-emde-boas"]),
            ("stack", &["auto", "private", "shared", "short"]),
            ("stack-entries", &["4", "8", "16"]),
            ("workgroup", &["auto", "8x8", "16x16", "64x1", "256x1"]),
        ]
    }

    fn bench_stages(&self) -> &'static [BenchStage] {
        bench_stages::STAGES
    }

    fn notes(&self, figures: &Figures<'_>) -> Vec<String> {
        let Some(samples) = figures.counter("samples") else { return Vec::new() };
        let plural = if samples == 1.0 { "" } else { "s" };
        notes::estimated_error(figures, &format!("{samples} sample{plural} a pixel"), "--spp")
    }

    fn prepare(&self, inputs: &Inputs<'_>) -> Result<Box<dyn Prepared>> {
        let bvh = inputs.bvh.whole(inputs.scene)?;
        let sources = Sources::new(inputs, bvh)?;
        let sample_count = sample_count(inputs.values, "spp", settings::DEFAULT_SAMPLES);
        let choices = choices(inputs, &sources)?;
        Ok(Box::new(PreparedPaths { choices, sources, layout: layout(inputs, bvh)?, sample_count }))
    }
}

fn layout(inputs: &Inputs<'_>, bvh: &Bvh) -> Result<Layout> {
    let (limits, values) = (&inputs.caps.limits, inputs.values);
    let rays = if values.is("rays", RaySource::Query) {
        Rays::Query { is_opaque: !is_tested(inputs) }
    } else {
        let threads = workgroup_of(inputs).iter().product();
        let walk = Walk::from_values(values);
        Rays::Tree(Nodes::new(bvh, walk, threads, limits).map_err(|error| error.within(NAME))?)
    };
    let reads = Reads {
        levels: values.choice("texture-level"),
        occlusion: values.is("ambient-visibility", AmbientVisibility::Off) && inputs.lights.ambient != Vec3::ZERO,
    };
    Layout::new(inputs.scene, bvh, rays, reads, limits.max_storage_buffer_range_bytes)
}

/// `--workgroup`, `auto` resolved: stacks that share workgroup memory want room for every thread's.
fn workgroup_of(inputs: &Inputs<'_>) -> [u32; 2] {
    let (values, caps) = (inputs.values, inputs.caps);
    let is_chosen = values.unless_auto(WORKGROUP.key, Values::pair).is_some();
    if !is_chosen && values.is("stack", StackPlace::Shared) && !caps.identity.is_software() {
        return [8, 8];
    }
    workgroup::workgroup(values, caps)
}

/// The scene has MASK or BLEND surfaces.
fn is_tested(inputs: &Inputs<'_>) -> bool {
    inputs.scene.drawn_materials().any(|material| material.alpha != AlphaMode::Opaque)
}

/// Where light comes from.
struct Sources {
    lights: LightSet,
    /// None: nothing moves.
    closing: Option<ShutterClose>,
    /// None: emissive triangles light nothing.
    emitters: Option<Emitters>,
    punctual: Vec<SourceBlock>,
    /// How likely a light walk starts on a punctual light.
    punctual_part: f64,
}

impl Sources {
    fn new(inputs: &Inputs<'_>, bvh: &Bvh) -> Result<Self> {
        let values = inputs.values;
        let (mut lights, mut closing) = (inputs.lights.clone(), ShutterClose::new(inputs)?);
        if !values.is_on("punctual") {
            for lights in [&mut lights].into_iter().chain(closing.as_mut().map(|closing| &mut closing.lights)) {
                lights.lights.clear();
                lights.has_punctual = false;
            }
        }
        let emitters = emissive_lights(values, &lights).then(|| Emitters::of(inputs.scene, bvh));
        let (punctual, power) = emitters::punctual(&lights.lights, 0.5 * inputs.scene.bounds().diagonal());
        let emitted = emitters.as_ref().map_or(0.0, Emitters::power);
        let punctual_part = if power + emitted > 0.0 { power / (power + emitted) } else { 0.0 };
        Ok(Self { lights, closing, emitters, punctual, punctual_part })
    }

    /// Those of the shutter's opening, then those of its closing.
    fn all_lights(&self) -> impl Iterator<Item = &Light> {
        self.lights.lights.iter().chain(self.closing.iter().flat_map(|closing| &closing.lights.lights))
    }

    fn emitter_count(&self) -> usize {
        self.emitters.as_ref().map_or(0, |emitters| emitters.sources.len())
    }

    /// Emitters, then punctual lights.
    fn all(&self) -> Vec<SourceBlock> {
        let emitters = self.emitters.iter().flat_map(|emitters| &emitters.sources);
        emitters.chain(&self.punctual).copied().collect()
    }
}

fn choices(inputs: &Inputs<'_>, sources: &Sources) -> Result<Choices> {
    let values = inputs.values;
    let bounds = inputs.scene.bounds();
    let transport = values.choice("transport");
    let bounces = match transport {
        Transport::Direct | Transport::SingleScatter => 1,
        Transport::OneBounce => 2,
        Transport::Full => values.integer("bounces") as u32,
    };
    let is_walked = !values.is_on("vpl-visibility");
    let least = values.length("vpl-clamp", inputs.scene.lasting_bounds().diagonal());
    let (air, medium) = Air::new(inputs)?;
    let mut params = SampleParams {
        sphere_ws: bounds.center().extend(0.5 * bounds.diagonal()).to_array(),
        least_squared: least * least,
        punctual_part: sources.punctual_part as f32,
        emitter_count: sources.emitter_count() as u32,
        punctual_count: sources.punctual.len() as u32,
        seed: values.integer("seed") as u32,
        volume_steps: values.number("volume-steps") as f32,
        ..SampleParams::zeroed()
    };
    [params.cone_width, params.cone_spread] = inputs.view.pixel_cone();
    if let Some(medium) = medium {
        params.medium = medium.around(inputs.scene, inputs.view.eye(), sources.all_lights());
    }
    let lens = Lens::new(values, inputs.view, inputs.scene, inputs.bvh.whole(inputs.scene)?);
    if let Some(lens) = lens {
        params.lens_radius = lens.radius;
        params.focus = lens.focus;
        params.lens_aside = lens.aside();
    }
    Ok(Choices {
        bounces: if is_walked { 1 } else { bounces },
        roulette: transport == Transport::Full && !is_walked,
        direct_light: values.is_on("direct-light"),
        light_visibility: values.is_on("light-visibility"),
        ambient_visibility: values.choice("ambient-visibility"),
        walk_landings: is_walked.then_some(bounces - 1),
        brdf: values.choice::<Brdf>("brdf") as u32,
        vpl_brdf: values.choice::<Brdf>("vpl-brdf") as u32,
        extras: inputs.scene.drawn_materials().any(Material::has_extras),
        workgroup: workgroup_of(inputs),
        ray_offset: RAY_OFFSET * inputs.scene.lasting_bounds().diagonal().max(1e-6),
        is_tested: is_tested(inputs),
        air,
        airlight_seen: airlight::is_seen(values),
        medium,
        has_lens: lens.is_some(),
        in_middles: values.is("pixel", PixelPlace::Middle),
        has_spheres: sources.all_lights().any(|light| light.radius > 0.0),
        volume: volume(inputs, medium)?,
        params,
    })
}

/// The volume of the scene, and where it stands.
///
/// Errors: a medium is there too (exit code 2); as `PlacedVolume::new`.
fn volume(inputs: &Inputs<'_>, medium: Option<Medium>) -> Result<Option<PlacedVolume>> {
    let Some(volume) = &inputs.scene.volume else { return Ok(None) };
    if medium.is_some() {
        let text = Medium::text(medium);
        return Err(Error::request(format!("--volume in --medium {text}: a ray is dimmed by the one or by the other"))
            .within(NAME)
            .note("--medium none leaves the volume, --volume none the medium"));
    }
    PlacedVolume::new(volume, inputs.values, inputs.scene).map(Some)
}

struct PreparedPaths {
    choices: Choices,
    sources: Sources,
    layout: Layout,
    sample_count: u32,
}

impl Prepared for PreparedPaths {
    fn plan(&self, inputs: &Inputs<'_>) -> Result<Plan> {
        let sources = &self.sources;
        let mut plan = Plan::default();
        self.layout.plan(&mut plan, NAME, inputs.requirements)?;
        let of = |count: usize, size: usize| count as u64 * size as u64;
        let light_count = sources.all_lights().count();
        plan.buffer("lights", format!("{NAME}.lights"), of(light_count, size_of::<LightBlock>()));
        plan.buffer("lights", format!("{NAME}.sources"), of(sources.all().len(), size_of::<SourceBlock>()));
        let frame_count = usize::from(sources.closing.is_some());
        plan.buffer("frame", format!("{NAME}.frame.closing"), of(frame_count, size_of::<FrameBlock>()));
        if let Some(volume) = &self.choices.volume {
            volume.plan(&mut plan, NAME);
        }
        plan.buffer("accumulation", SUMS, inputs.view.extent.pixel_count() * SUM_BYTES);
        plan.picture(COLOR, inputs.view.extent);
        plan.pass(format!("{NAME}.sample"), [(COLOR.to_owned(), Access::ComputeWrite)]);
        Ok(plan)
    }

    fn resolved(&self) -> BTreeMap<&'static str, String> {
        let emissive = if self.sources.emitters.is_some() { "on" } else { "off" };
        let mut resolved = BTreeMap::from([
            ("emissive", emissive.to_owned()),
            ("medium", Medium::text(self.choices.medium)),
            ("spp", self.sample_count.to_string()),
            ("vpl-clamp", format!("{}", self.choices.params.least_squared.sqrt())),
            (WORKGROUP.key, workgroup::text(self.choices.workgroup)),
        ]);
        if let Some(nodes) = self.layout.nodes() {
            resolved.insert("stack", nodes.stack.name().to_owned());
        }
        if self.choices.has_lens {
            resolved.insert("focus", format!("{}", self.choices.params.focus));
        }
        resolved
    }

    fn host_part(self: Box<Self>, _: &Inputs<'_>) -> Result<HostPart> {
        let light_count = self.sources.lights.lights.len();
        Ok(HostPart {
            passes: Vec::new(),
            counters: BTreeMap::from([
                ("lights", light_count as f64),
                ("emitters", self.sources.emitter_count() as f64),
            ]),
            light_counts: [light_count as u32, 0],
            build: Box::new(move |gpu, inputs, _, resources| self.build(gpu, inputs, resources)),
        })
    }
}

impl PreparedPaths {
    /// The frame on the device.
    fn build(self, gpu: &Arc<Gpu>, inputs: &Inputs<'_>, resources: &mut Resources) -> Result<Box<dyn Frame>> {
        let bvh = inputs.bvh.whole(inputs.scene)?;
        let mut lights = direct::light_blocks(&self.sources.lights, inputs.values);
        if let Some(closing) = &self.sources.closing {
            lights.extend(direct::light_blocks(&closing.lights, inputs.values));
        }
        let closing: Vec<FrameBlock> = self.sources.closing.iter().map(|closing| closing.block(inputs)).collect();
        let density_of =
            |material: &Material| self.sources.emitters.as_ref().map_or(0.0, |emitters| emitters.density_of(material));
        let (sources, layout) = (self.sources.all(), &self.layout);
        let lights = PathLights { blocks: &lights, sources: &sources, closing: &closing };
        let mut tree = vec![("triangles_traced", bvh.sources.len() as f64)];
        if let Some(nodes) = layout.nodes() {
            tree.extend([("tree_nodes", nodes.count() as f64), ("stack_entries", nodes.stack_entries().into())]);
        }
        let sample =
            Sample::new(gpu, inputs, resources, &self.choices, &lights, &PathTree { bvh, layout }, density_of)?;
        Ok(Box::new(PathFrame {
            sample,
            sample_count: self.sample_count,
            until_error: until_error(inputs.values),
            tree,
        }))
    }
}

struct PathFrame {
    sample: Sample,
    sample_count: u32,
    until_error: Option<f64>,
    /// Counters of what rays walk.
    tree: Vec<(&'static str, f64)>,
}

impl Frame for PathFrame {
    fn record(&self, cmd: &mut Commands, _: &SceneGpu, frame: &Buffer) -> Result<()> {
        self.sample.record(cmd, frame)
    }

    fn run_count(&self) -> u32 {
        self.sample_count
    }

    fn runs_alike(&self) -> bool {
        true
    }

    fn sums(&self) -> Option<Sums<'_>> {
        Some(Sums { buffer: &self.sample.sums, until_error: self.until_error })
    }

    fn drawn(&self) -> BTreeMap<&'static str, f64> {
        self.tree.iter().copied().collect()
    }

    fn picture(&self) -> (&Image, Access) {
        (&self.sample.color, Access::ComputeWrite)
    }

    fn counters(&self, _: &Arc<Gpu>) -> Result<BTreeMap<&'static str, f64>> {
        Ok(BTreeMap::new())
    }

    fn aov(&self, _: &Arc<Gpu>, name: &str) -> Result<Aov> {
        unreachable!("{NAME} has no stage {name}")
    }
}
