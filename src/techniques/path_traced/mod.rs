//! Path tracing: the integral that the other techniques approximate, with a switch for each part of it that one of them
//! leaves out, so that each is judged against what it claims to compute.
//!
//! Passes: sample, once for each path of a pixel (`--spp`).
//!
//! Paths start at the camera, anywhere in their pixel (box filter). At each surface one punctual light is chosen as strongly
//! as each would light it, and one point of an emitter by power; both send a shadow ray, and a direction is drawn by the
//! BRDF. Points of emitters that either way finds are weighed by the power heuristic. Numbers are a Sobol sequence,
//! Owen-scrambled for each pixel (src/sampling/sobol.rs).
//!
//! What it takes for light
//! - punctual lights and materials: as the others do (glsl/shading/light.glsl, brdf.glsl, glTF's window included)
//! - emissive triangles: seen always; they light others with `--emissive`
//! - rays that leave the scene: those from the camera find `--background`, those from surfaces `--background` and
//!   `--ambient` together. What the others add to every surface as ambient light comes from outside here, and is shadowed
//! - backs of single-sided surfaces: not there for the camera, as the others draw them; for all other rays black walls, as
//!   for the shadow rays and light walks of the others
//! - MASK surfaces have their holes for every ray, BLEND surfaces stop the part of all rays that alpha says (the others'
//!   shadow rays take the first for solid and the second for nothing)
//! - occlusion maps: not read, because rays find what they stand for
//! - unlit surfaces: seen in their colour, black for all other rays
//!
//! Equal to others: `--transport direct` is `deferred --direct-shadow ray`; `--transport one-bounce --vpl-visibility off` is
//! what `interleaved_deferred --split none` comes to with ever more virtual point lights.

pub mod sample;
pub mod settings;

use super::{Frame, Inputs, Prepared, Sums, Technique, left_out};
use crate::bvh::Bvh;
use crate::error::Result;
use crate::gpu::shader::structs::{LightBlock, SampleParams, SourceBlock};
use crate::gpu::{Access, Buffer, Caps, Commands, Gpu, Image, Need};
use crate::lights::LightSet;
use crate::lights::emitters::{self, Emitters};
use crate::passes::direct;
use crate::plan::{Plan, Resources};
use crate::report::image_file::Aov;
use crate::resident::SceneGpu;
use crate::resident::traced::Layout;
use crate::scene::{AlphaMode, Material};
use crate::settings::{Setting, Values};
use crate::shading::brdf::Brdf;
use bytemuck::Zeroable;
use sample::{Choices, SUM_BYTES, Sample};
use std::collections::BTreeMap;
use std::sync::Arc;

const NAME: &str = "path_traced";
/// The finished picture.
const COLOR: &str = "path_traced.color";
/// What is summed from run to run.
const SUMS: &str = "path_traced.sums";

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
        &[settings::SETTINGS]
    }

    fn aovs(&self) -> &'static [&'static str] {
        &[]
    }

    fn needs(&self, _: &Values, _: &Caps, _: bool) -> Vec<Need> {
        Vec::new()
    }

    fn bounds(&self, _: &Caps) -> Vec<(&'static str, String)> {
        Vec::new()
    }

    fn plan(&self, inputs: &Inputs<'_>) -> Result<Plan> {
        let bvh = inputs.bvh.whole(inputs.scene)?;
        let sources = Sources::new(inputs, bvh);
        let mut plan = Plan::default();
        layout(inputs, bvh)?.plan(&mut plan, NAME);
        let of = |count: usize, size: usize| count as u64 * size as u64;
        let light_count = sources.lights.lights.len();
        plan.buffer("lights", format!("{NAME}.lights"), of(light_count, size_of::<LightBlock>()));
        plan.buffer("lights", format!("{NAME}.sources"), of(sources.all().len(), size_of::<SourceBlock>()));
        plan.buffer("accumulation", SUMS, inputs.view.extent.pixel_count() * SUM_BYTES);
        plan.picture(COLOR, inputs.view.extent);
        plan.pass(format!("{NAME}.sample"), [(COLOR.to_owned(), Access::ComputeWrite)]);
        Ok(plan)
    }

    fn prepare(&self, inputs: &Inputs<'_>) -> Result<Box<dyn Prepared>> {
        let sources = Sources::new(inputs, inputs.bvh.whole(inputs.scene)?);
        let sample_count = settings::sample_count(inputs.values);
        Ok(Box::new(PreparedPaths { choices: choices(inputs, &sources), sources, sample_count }))
    }
}

fn layout(inputs: &Inputs<'_>, bvh: &Bvh) -> Result<Layout> {
    Layout::new(inputs.scene, bvh, inputs.caps.limits.max_storage_buffer_range_bytes)
}

/// Where light comes from.
struct Sources {
    lights: LightSet,
    /// None: emissive triangles light nothing.
    emitters: Option<Emitters>,
    punctual: Vec<SourceBlock>,
    /// How likely a light walk starts on a punctual light.
    punctual_part: f64,
}

impl Sources {
    fn new(inputs: &Inputs<'_>, bvh: &Bvh) -> Self {
        let values = inputs.values;
        let mut lights = inputs.lights.clone();
        if !values.is_on("punctual") {
            lights.lights.clear();
            lights.has_punctual = false;
        }
        let is_emissive = match values.text("emissive") {
            "auto" => !lights.has_punctual,
            text => text == "on",
        };
        let emitters = is_emissive.then(|| Emitters::of(inputs.scene, bvh));
        let (punctual, power) = emitters::punctual(&lights.lights, 0.5 * inputs.scene.bounds().diagonal());
        let emitted = emitters.as_ref().map_or(0.0, Emitters::power);
        let punctual_part = if power + emitted > 0.0 { power / (power + emitted) } else { 0.0 };
        Self { lights, emitters, punctual, punctual_part }
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

fn choices(inputs: &Inputs<'_>, sources: &Sources) -> Choices {
    let values = inputs.values;
    let bounds = inputs.scene.bounds();
    let bounces = match values.text("transport") {
        "direct" => 1,
        "one-bounce" => 2,
        _ => values.integer("bounces") as u32,
    };
    let is_walked = !values.is_on("vpl-visibility");
    let least = values.length("vpl-clamp", inputs.scene.lasting_bounds().diagonal());
    Choices {
        bounces: if is_walked { 1 } else { bounces },
        roulette: values.text("transport") == "full" && !is_walked,
        light_visibility: values.is_on("light-visibility"),
        walk_landings: is_walked.then_some(bounces - 1),
        brdf: Brdf::from_setting(values.text("brdf")) as u32,
        extras: inputs.scene.drawn_materials().any(Material::has_extras),
        workgroup: values.pair("workgroup"),
        ray_offset: RAY_OFFSET * inputs.scene.lasting_bounds().diagonal().max(1e-6),
        is_tested: inputs.scene.drawn_materials().any(|material| material.alpha != AlphaMode::Opaque),
        params: SampleParams {
            sphere_ws: bounds.center().extend(0.5 * bounds.diagonal()).to_array(),
            least_squared: least * least,
            punctual_part: sources.punctual_part as f32,
            emitter_count: sources.emitter_count() as u32,
            punctual_count: sources.punctual.len() as u32,
            seed: values.integer("seed") as u32,
            ..SampleParams::zeroed()
        },
    }
}

struct PreparedPaths {
    choices: Choices,
    sources: Sources,
    sample_count: u32,
}

impl Prepared for PreparedPaths {
    fn host_passes(&self) -> Vec<(String, u64)> {
        Vec::new()
    }

    fn counters(&self) -> BTreeMap<&'static str, f64> {
        BTreeMap::from([
            ("lights", self.sources.lights.lights.len() as f64),
            ("emitters", self.sources.emitter_count() as f64),
        ])
    }

    fn resolved(&self) -> BTreeMap<&'static str, String> {
        let emissive = if self.sources.emitters.is_some() { "on" } else { "off" };
        BTreeMap::from([
            ("emissive", emissive.to_owned()),
            ("spp", self.sample_count.to_string()),
            ("vpl-clamp", format!("{}", self.choices.params.least_squared.sqrt())),
        ])
    }

    fn light_counts(&self) -> [u32; 2] {
        [self.sources.lights.lights.len() as u32, 0]
    }

    fn build(
        self: Box<Self>,
        gpu: &Arc<Gpu>,
        inputs: &Inputs<'_>,
        _: &SceneGpu,
        resources: &mut Resources,
    ) -> Result<Box<dyn Frame>> {
        let bvh = inputs.bvh.whole(inputs.scene)?;
        let lights = direct::light_blocks(&self.sources.lights, inputs.values);
        let density_of =
            |material: &Material| self.sources.emitters.as_ref().map_or(0.0, |emitters| emitters.density_of(material));
        let (sources, layout) = (self.sources.all(), layout(inputs, bvh)?);
        let lit = (&lights[..], &sources[..]);
        let sample = Sample::new(gpu, inputs, resources, &self.choices, lit, (bvh, &layout), density_of)?;
        Ok(Box::new(PathFrame {
            sample,
            sample_count: self.sample_count,
            until_error: settings::until_error(inputs.values),
            triangle_count: bvh.sources.len(),
        }))
    }
}

struct PathFrame {
    sample: Sample,
    sample_count: u32,
    until_error: Option<f64>,
    triangle_count: usize,
}

impl Frame for PathFrame {
    fn record(&self, cmd: &mut Commands, _: &SceneGpu, frame: &Buffer) -> Result<()> {
        self.sample.record(cmd, frame)
    }

    fn run_count(&self) -> u32 {
        self.sample_count
    }

    fn sums(&self) -> Option<Sums<'_>> {
        Some(Sums { buffer: &self.sample.sums, until_error: self.until_error })
    }

    fn drawn(&self) -> BTreeMap<&'static str, f64> {
        BTreeMap::from([("triangles_traced", self.triangle_count as f64)])
    }

    fn picture(&self) -> (&Image, Access) {
        (&self.sample.color, Access::ComputeWrite)
    }

    fn counters(&self, _: &Arc<Gpu>) -> Result<BTreeMap<&'static str, f64>> {
        Ok(BTreeMap::new())
    }

    fn aov(&self, _: &Arc<Gpu>, name: &str) -> Result<Aov> {
        Err(left_out(NAME, name, "it has no stages"))
    }
}
