//! The techniques: what each needs, and the table of all of them.
//!
//! A technique is asked once, and what it answers goes on by itself: `prepare` makes its choices, `Prepared::plan` is
//! arithmetic (so that memory can be studied without a device), `Prepared::host_part` does what the host computes,
//! `HostPart::build` makes pipelines and takes the planned resources, and `Frame::record` writes the commands of one
//! frame, in the order of the paper's overview figure.

pub mod adaptive_interleaved;
mod all;
pub mod bench_stage;
pub mod bindable;
pub mod deep_shading;
pub mod deferred;
mod exposure;
pub mod fitness;
pub mod forward;
pub mod inferred_lighting;
pub mod interleaved_deferred;
pub mod interleaved_sampling;
pub mod notes;
pub mod own_pass;
pub mod parts;
pub mod path_traced;
pub mod patterns;
mod shutter_close;
pub mod stages;
pub mod until_error;

pub use all::{ALL, DEFAULT_TECHNIQUE, find};

use crate::bvh::LazyBvh;
use crate::caps::{Caps, Need};
use crate::error::{Error, Result};
use crate::frame::View;
use crate::gpu::shader::structs::{FrameBlock, MediumBlock};
use crate::gpu::{Access, Buffer, Commands, Gpu, Image};
use crate::lights::LightSet;
use crate::picture::Aov;
use crate::plan::{Plan, Requirements, Resources};
use crate::resident::{Coverage, DrawList, Raster, SceneGpu, SceneStats, Sweep};
use crate::sampling::pattern::Pattern;
use crate::scene::Scene;
use crate::settings::{COMMON, DirectShadow, EMISSIVE, INSTRUMENT, Setting, Values};
use crate::shading::medium::Medium;
use bench_stage::{BenchStage, PlainForm};
use notes::Figures;
use parts::{InParts, Part};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Everything that the plan and the host's part of a technique may read.
pub struct Inputs<'a> {
    pub caps: &'a Caps,
    /// Source of the sizes that only a driver knows.
    pub requirements: Requirements<'a>,
    pub scene: &'a Scene,
    pub stats: &'a SceneStats,
    pub bvh: &'a LazyBvh,
    pub view: &'a View,
    pub lights: &'a LightSet,
    pub values: &'a Values,
}

impl Inputs<'_> {
    /// Whether emissive triangles light other surfaces (`--emissive`).
    fn emissive_lights(&self) -> bool {
        emissive_lights(self.values, self.lights)
    }

    /// What `--medium` comes to.
    fn medium(&self) -> Option<Medium> {
        Medium::chosen(self.values, self.scene)
    }

    /// The same in its box.
    fn medium_block(&self) -> Option<MediumBlock> {
        Some(self.medium()?.around(self.scene, self.view.eye(), self.lights.lights.iter()))
    }

    /// The triangles of solid surfaces that are drawn.
    fn draw_list(&self, scene: &SceneGpu, coverage: Coverage) -> DrawList {
        self.draw_list_into(scene, Raster { extent: self.view.extent, coverage })
    }

    /// The same, drawn into images of another extent than the picture's.
    fn draw_list_into(&self, scene: &SceneGpu, raster: Raster) -> DrawList {
        DrawList::new(self.scene, scene, self.view, raster, self.values.choice("geometry"), Sweep::default())
    }
}

/// Whether emissive triangles light other surfaces under `lights` (`--emissive`).
fn emissive_lights(values: &Values, lights: &LightSet) -> bool {
    values.unless_auto(EMISSIVE.key, Values::is_on).unwrap_or(!lights.has_punctual)
}

/// The memory of a published rival of a technique, which stands beside its own.
pub struct Rival {
    pub name: &'static str,
    /// Where it is published: the paper and its section.
    pub paper: &'static str,
    /// How the bytes come out, in words.
    pub formula: String,
    pub bytes: u64,
}

/// Settings by key, each with several values.
pub type Tuned = &'static [(&'static str, &'static [&'static str])];

/// A pattern of samples that settings of a technique choose.
pub struct NamedPattern {
    /// Its name on the command line, different from every other pattern's.
    pub name: &'static str,
    /// One line for the list.
    pub summary: &'static str,
    /// Keys of those settings.
    pub keys: &'static [&'static str],
    /// The pattern.
    ///
    /// Errors: the settings contradict each other (exit code 2).
    pub make: fn(&Values) -> Result<Pattern>,
}

/// One way of making a picture.
pub trait Technique: Sync {
    /// Its name on the command line, in labels and in reports.
    fn name(&self) -> &'static str;

    /// One line for the list.
    fn summary(&self) -> &'static str;

    /// The built-in scene that shows it best.
    fn scene(&self) -> &'static str;

    /// Tables of the settings that it reads beside the common ones.
    fn settings(&self) -> &'static [&'static [Setting]];

    /// Names that `--aov` takes.
    fn aovs(&self) -> &'static [&'static str];

    /// Settings with values, each of which has shorter buffers, or none, where others have long ones: what is tried for advice
    /// where a device does not bind a buffer at once, or memory is spent.
    fn shorter(&self) -> &'static [(&'static str, &'static str)] {
        &[]
    }

    /// What these settings need of a device beyond Vulkan 1.3, met or not. `caps`: `auto` may depend on them. `has_blend`:
    /// the scene has BLEND surfaces. Settings that contradict each other need nothing: `prepare` refuses them.
    fn needs(&self, values: &Values, caps: &Caps, has_blend: bool) -> Vec<Need>;

    /// Limits of its settings on a device: a setting, and its greatest value in words.
    fn bounds(&self, caps: &Caps) -> Vec<(&'static str, String)>;

    /// The light transport that it claims to compute, as settings of `path_traced` (`--transport` and the like) by key: what
    /// `--reference auto` judges it against. Settings that both read are carried over without being named here, those that
    /// the reference does not read are passed over. None named: the whole integral.
    /// Instead of `--medium auto` the values have what it comes to.
    ///
    /// Errors: path tracing has no such transport (exit code 2).
    fn reference_settings(&self, _: &Values, _: &LightSet) -> Result<Vec<(&'static str, String)>> {
        Ok(Vec::new())
    }

    /// Raised whenever the same settings give another picture than before: references that are kept are of one version.
    fn estimator_version(&self) -> u32 {
        1
    }

    /// Methods whose memory its paper compares with.
    fn rivals(&self) -> Vec<Rival> {
        Vec::new()
    }

    /// What benchmarks can time of it, at least one stage.
    fn bench_stages(&self) -> &'static [BenchStage];

    /// The plain form that errors and overheads of benchmarks are measured against; None where it has none.
    fn plain(&self) -> Option<&'static PlainForm> {
        None
    }

    /// What a report says of its figures, a line an entry.
    fn notes(&self, _: &Figures<'_>) -> Vec<String> {
        Vec::new()
    }

    /// Settings that `tune` searches where none are named, each with the values that it tries.
    fn tuned(&self) -> Tuned {
        &[]
    }

    /// Patterns of samples that its settings choose.
    fn patterns(&self) -> &'static [NamedPattern] {
        &[]
    }

    /// Its choices for these inputs: made here once, then planned, then built. No device is needed.
    ///
    /// Errors: settings that contradict each other, the scene or the device (exit code 2).
    fn prepare(&self, inputs: &Inputs<'_>) -> Result<Box<dyn Prepared>>;
}

/// A technique whose choices are made. Its methods are given the inputs of `Technique::prepare` again.
pub trait Prepared {
    /// What a frame needs. Arithmetic, except for the tree of shadow rays, whose size is known only after building it.
    ///
    /// Errors: settings that contradict each other, the scene or the device (exit code 2).
    fn plan(&self, inputs: &Inputs<'_>) -> Result<Plan>;

    /// Stages (`Technique::aovs`) that these settings leave out, each with the reason, which names the setting.
    fn stages_left_out(&self, _: &Inputs<'_>) -> Vec<(&'static str, String)> {
        Vec::new()
    }

    /// Settings whose text does not say all: the values of `auto` and of percentages.
    fn resolved(&self) -> BTreeMap<&'static str, String>;

    /// What the host computes before a frame.
    ///
    /// Errors: as `plan`; the user has asked to stop (exit code 130).
    fn host_part(self: Box<Self>, inputs: &Inputs<'_>) -> Result<HostPart>;
}

/// A technique whose host part is done.
pub struct HostPart {
    /// Host passes with their time in nanoseconds; the same names as other passes have.
    pub passes: Vec<(String, u64)>,
    /// Numbers for the report's `counters` that the host knows before a frame.
    pub counters: BTreeMap<&'static str, f64>,
    /// Punctual and virtual point lights that shaders loop over, for the frame's block.
    pub light_counts: [u32; 2],
    pub build: Build,
}

/// Makes the pipelines and takes the planned resources out. The inputs are those of `Technique::prepare`.
pub type Build = Box<dyn FnOnce(&Arc<Gpu>, &Inputs<'_>, &SceneGpu, &mut Resources) -> Result<Box<dyn Frame>>>;

/// Samples that a technique sums up from run to run, one a pixel each run.
pub struct Sums<'a> {
    /// Four floats a pixel, row-major: red, green, blue, and the squared lengths of the three. A run adds to them, but the
    /// first (`sample_index` 0) begins anew. Touched last, and next, by a compute shader.
    pub buffer: &'a Buffer,
    /// The relative error (`metrics::noise`) at which runs end before `Frame::run_count`.
    pub until_error: Option<f64>,
}

/// What the host's part of a run may read.
pub struct Run<'a> {
    pub index: u32,
    /// As shaders read it in this run.
    pub frame: &'a FrameBlock,
    pub scene: &'a Scene,
    pub bvh: &'a LazyBvh,
    pub view: &'a View,
    pub lights: &'a LightSet,
    pub gpu: &'a Arc<Gpu>,
    pub scene_gpu: &'a SceneGpu,
}

/// A technique on the device.
pub trait Frame {
    /// Records one frame. `frame`: the block of glsl/frame.glsl.
    fn record(&self, cmd: &mut Commands, scene: &SceneGpu, frame: &Buffer) -> Result<()>;

    /// Passes that `HostPart::build` has run on the device, and whose results are kept: with their time in nanoseconds.
    fn once(&self) -> Vec<(String, u64)> {
        Vec::new()
    }

    /// How often what was recorded runs for a picture; the frame's block counts the runs (`sample_index`).
    fn run_count(&self) -> u32 {
        1
    }

    /// Whether there is a picture after fewer runs than `run_count`, if with fewer samples.
    fn has_early_pictures(&self) -> bool {
        true
    }

    /// Whether runs differ by the block's `sample_index` alone: then several may go at once.
    fn runs_alike(&self) -> bool {
        false
    }

    /// Whether runs have other commands: each is recorded by `record` when its turn comes, after its `begin_run`.
    fn records_each_run(&self) -> bool {
        false
    }

    /// The host's part of a run, before it is submitted: the run before has ended. Its passes, with their time in
    /// nanoseconds, which is part of the frame's; the same in each run.
    ///
    /// Errors: the user has asked to stop (exit code 130).
    fn begin_run(&self, _: &Run<'_>) -> Result<Vec<(String, u64)>> {
        Ok(Vec::new())
    }

    /// What shaders read as the frame's block in this run: `block`, which is of `view`, with the run's own camera.
    fn block_of(&self, _run: u32, block: FrameBlock, _view: &View) -> FrameBlock {
        block
    }

    /// Whether its runs are recorded one by one, each after its `begin_run` (parts.rs), and what ends them early. None: all runs
    /// are what `record` has recorded.
    fn in_parts(&self) -> Option<InParts> {
        None
    }

    /// Records a part of a frame that is made `in_parts`: its passes are some of those of `record`, in their order.
    fn record_part(&self, _: &mut Commands, _: &SceneGpu, _frame: &Buffer, part: Part) -> Result<()> {
        unreachable!("no frame of this technique has a part {part:?}")
    }

    /// Sums that it keeps from run to run; None where a picture is one run, or made in parts.
    fn sums(&self) -> Option<Sums<'_>> {
        None
    }

    /// What is drawn of the scene, for the report's `counters`.
    fn drawn(&self) -> BTreeMap<&'static str, f64>;

    /// The finished picture (RGBA32F) and how the frame touched it last.
    fn picture(&self) -> (&Image, Access);

    /// What a NaN in the picture may mean, and what would help; None: nothing particular to the technique.
    fn explained_nan(&self) -> Option<[String; 2]> {
        None
    }

    /// Numbers that a frame leaves, for the report's `counters`.
    ///
    /// Errors: memory for reading them back (exit code 4).
    fn counters(&self, gpu: &Arc<Gpu>) -> Result<BTreeMap<&'static str, f64>>;

    /// Bytes that the last frame touched, by full name: of the resources of which it counted them itself, and of no others.
    /// Names that the plan does not have are passed over.
    ///
    /// Errors: memory for reading the counts back (exit code 4).
    fn touched_bytes(&self, _: &Arc<Gpu>) -> Result<BTreeMap<String, u64>> {
        Ok(BTreeMap::new())
    }

    /// One intermediate result, read back after a frame; none that `Prepared::stages_left_out` names.
    ///
    /// Errors: memory for the copy (exit code 4).
    fn aov(&self, gpu: &Arc<Gpu>, name: &str) -> Result<Aov>;
}

/// The settings that `technique` reads, common ones included.
pub fn settings_of(technique: &dyn Technique) -> Vec<Setting> {
    COMMON.iter().chain(technique.settings().iter().copied().flatten()).copied().collect()
}

/// The settings that `technique` reads, at their defaults.
pub fn defaults(technique: &dyn Technique) -> Values {
    Values::defaults(&settings_of(technique))
}

/// Changes one of the settings of `technique`.
///
/// Errors: it does not read this one, or the value is impossible (exit code 2).
pub fn set(technique: &dyn Technique, values: &mut Values, key: &str, value: &str) -> Result<()> {
    let name = technique.name();
    match settings_of(technique).iter().find(|setting| setting.key == key) {
        Some(setting) => values.set(setting, value).map_err(|error| error.within(name)),
        None => Err(Error::request(format!("{name} does not read --{key}"))
            .note(format!("`quincunx render --technique {name} --help` lists what it reads"))),
    }
}

/// `values` of `technique` for frames that are timed: what `--instrument auto` would count is not.
pub fn timed(technique: &dyn Technique, values: &Values) -> Values {
    match values.get(INSTRUMENT.key) {
        Some("auto") => instrumented(technique, values, "off"),
        _ => values.clone(),
    }
}

/// `values` of `technique` for frames that are counted, and not timed.
pub fn counted(technique: &dyn Technique, values: &Values) -> Values {
    instrumented(technique, values, "on")
}

/// The same where the technique counts nothing.
fn instrumented(technique: &dyn Technique, values: &Values, choice: &str) -> Values {
    let mut changed = values.clone();
    if let Some(setting) = settings_of(technique).iter().find(|setting| setting.key == INSTRUMENT.key) {
        changed.set(setting, choice).expect("a choice of the setting");
    }
    changed
}

/// The transport of punctual lights that light surfaces straight, as `Technique::reference_settings` says it. `by_volumes`: as
/// for `light_visibility`.
///
/// Errors: as `light_visibility`.
fn straight_light(values: &Values, lights: &LightSet, by_volumes: usize) -> Result<Vec<(&'static str, String)>> {
    Ok(vec![
        ("transport", "direct".to_owned()),
        ("light-visibility", light_visibility(values, lights, by_volumes)?),
        ("emissive", "off".to_owned()),
        ("ambient-visibility", "off".to_owned()),
    ])
}

/// Whether path tracing must let the scene's own lights cast shadows to compute what `--direct-shadow` does, and
/// `by_volumes`: how many of them, directional ones first, cast in another way.
///
/// Errors: some of the lights would, and others not (exit code 2).
fn light_visibility(values: &Values, lights: &LightSet, by_volumes: usize) -> Result<String> {
    let all = lights.lights.len();
    let traced = match values.choice("direct-shadow") {
        DirectShadow::None => 0,
        DirectShadow::Sun => lights.sun_count(),
        DirectShadow::Ray | DirectShadow::Map => all,
    };
    match traced.max(by_volumes.min(all)) {
        0 => Ok("off".to_owned()),
        shadowed if shadowed == all => Ok("on".to_owned()),
        some => {
            let key = if traced == some { "--direct-shadow sun" } else { "--shadow-volumes" };
            let why = "path tracing lets all of them or none";
            Err(Error::request(format!("{key}: {some} of {all} lights cast shadows, and {why}"))
                .note("--direct-shadow ray and none have a reference"))
        }
    }
}
