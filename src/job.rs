//! Job: a checked request for one picture; `Job::run` is the whole path from arguments to report on one screen.

use crate::caps::Caps;
use crate::continuation::{self, Continuation};
use crate::error::{Error, Result};
use crate::gpu::commands::{Recording, Submits};
use crate::gpu::recorded::FrameTime;
use crate::gpu::validation::Log;
use crate::gpu::{DeviceRequest, Gpu};
use crate::interrupt;
use crate::memory::{ledger::Snapshot, trace::Recorder};
use crate::picture::image_file::{ExrPrecision, WriteOptions, write};
use crate::picture::tonemap::exposure_for;
use crate::picture::visible::visible;
use crate::picture::{Aov, Picture};
use crate::reference::ReferenceRequest;
use crate::report::notes;
use crate::report::roofline::Roofline;
use crate::report::run::{AovRow, DeviceRow, ImageRow, Passes, Program, RunReport, SCHEMA, SceneRow, Times};
use crate::resident::SceneStats;
use crate::scene::{self, AnimationChoice, Model, Scene, Texturing};
use crate::session::{Renderer, Session, require_triangle};
use crate::settings::written::{SettingValue, WrittenSettings, written};
use crate::settings::{Gutters, Values, earlier_s, exposure_s, raw_volume_size, readers, volume_name};
use crate::techniques::{self, Technique, settings_of, stages, timed};
use crate::volume::{self, Volume, VolumeRequest};
use crate::whole_file::{require_folder, write_whole};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A request for one picture, every part of it checked.
pub struct Job {
    /// A built-in name with parameters, or a path.
    pub scene: String,
    pub technique: &'static dyn Technique,
    /// Common settings and the technique's own.
    pub values: Values,
    pub aovs: Vec<String>,
    /// None: into `SCENE-TECHNIQUE.png` in the current folder.
    pub output: Option<PathBuf>,
    pub report: Option<PathBuf>,
    /// A picture to continue, instead of starting anew.
    pub continuation: Option<Continuation>,
    /// What the picture is judged against.
    pub reference: Option<ReferenceRequest>,
    /// An index or a part of a name, as `devices` lists them.
    pub device: Option<String>,
    /// One submit for each pass: pass times.
    pub profile: bool,
    /// What its device can do, for the least time of each pass; with `profile` alone.
    pub roofline: Option<Roofline>,
    /// What the device counts in each pass.
    pub statistics: bool,
    /// Validation messages are fatal.
    pub validate: bool,
    /// The argv that repeats it.
    pub command: Vec<String>,
    /// Files of presets that some of the values are from, for the report.
    pub presets: Vec<String>,
    /// Keeps what its device's memory is asked for.
    pub recorder: Option<Arc<Recorder>>,
}

/// What a run leaves in memory.
pub struct Outcome {
    pub report: RunReport,
    pub picture: Picture,
    pub path: PathBuf,
    /// What `--exposure auto` came to for this picture, stops; None where it is set, or nothing shines.
    pub auto_exposure_ev: Option<f64>,
    /// What a person should know of the picture.
    pub notes: Vec<String>,
    /// Ctrl-C ended it: samples a pixel, or runs, that it has, and that it was to have.
    pub ended_after: Option<(u32, u32)>,
    /// Whether the gates of `Job::reference` hold; a caller prints first and fails then.
    pub gates: Result<()>,
}

/// What a renderer leaves of a picture.
struct Rendered {
    /// As they were used.
    settings: WrittenSettings,
    /// The ledger before its first frame.
    memory: Snapshot,
    /// At least one.
    times: Vec<FrameTime>,
    picture: Picture,
    /// As `Renderer::sums` has them.
    sums: Option<Vec<[f32; 4]>>,
    /// Those of `Job::aovs`.
    aovs: Vec<Aov>,
    /// Stops at which a PNG shows the picture.
    exposure_ev: f64,
    /// Stops at which PNGs show the stages.
    stages_ev: f64,
    /// As `Outcome` has it.
    auto_exposure_ev: Option<f64>,
    /// As `Outcome` has it.
    ended_after: Option<(u32, u32)>,
}

/// What becomes of a picture that Ctrl-C has ended between two of its samples.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Unfinished {
    Kept,
    Dropped,
}

/// Frames measured with `--profile`, after one that warms the pipelines up.
const PROFILE_FRAMES: usize = 3;

impl Job {
    /// A request with every setting at its default.
    pub fn new(scene: &str, technique: &'static dyn Technique) -> Self {
        Self {
            scene: scene.to_owned(),
            technique,
            values: techniques::defaults(technique),
            aovs: Vec::new(),
            output: None,
            report: None,
            continuation: None,
            reference: None,
            device: None,
            profile: false,
            roofline: None,
            statistics: false,
            validate: false,
            command: Vec::new(),
            presets: Vec::new(),
            recorder: None,
        }
    }

    /// The same scene and technique with other settings, and no wish beyond.
    pub fn at(&self, values: &Values) -> Self {
        Self { values: values.clone(), ..Self::new(&self.scene, self.technique) }
    }

    /// Changes a setting.
    ///
    /// Errors: the technique does not read it, or the value is impossible (exit code 2).
    pub fn set(&mut self, key: &str, value: &str) -> Result<()> {
        techniques::set(self.technique, &mut self.values, key, value)
    }

    /// Args to picture: scene, plan, device, frames, readback, report.
    ///
    /// Errors: see `ErrorKind`; nothing half-written stays.
    pub fn run(&self) -> Result<Outcome> {
        self.run_on(&self.device_request())
    }

    /// The same on a device that is asked for in another way.
    ///
    /// Errors: as `run`.
    pub fn run_on(&self, request: &DeviceRequest) -> Result<Outcome> {
        self.check()?;
        let scene = self.load_scene()?;
        self.continuation
            .as_ref()
            .map_or(Ok(()), |continuation| continuation.require(self.technique, &self.values, &scene))?;
        let path = self.output_path(&scene);
        let session = self.open_session(request, scene)?;
        let outcome = self.picture(&session, &self.values, &path, Unfinished::Kept)?;
        if let Some(file) = &self.report {
            write_whole(file, |out| writeln!(out, "{:#}", outcome.report.json()))?;
        }
        let log = session.gpu.validation_log();
        // Closing says what was leaked: only then is the log whole.
        drop(session);
        fail_on_validation(log.as_deref())?;
        match outcome.ended_after {
            None => Ok(outcome),
            Some((runs, all)) => {
                let unit = if outcome.report.counters.contains_key("runs") { "runs" } else { "samples a pixel" };
                let path = outcome.path.display();
                Err(Error::interrupted(format!(
                    "interrupted after {runs} of {all} {unit}; {path} is the picture so far"
                )))
            }
        }
    }

    /// Makes and writes the picture of what `session` shows, and reports on it.
    ///
    /// Errors: as `run`; the user has asked to stop, and nothing is to be kept (exit code 130).
    pub(crate) fn picture(
        &self,
        session: &Session,
        values: &Values,
        path: &Path,
        unfinished: Unfinished,
    ) -> Result<Outcome> {
        let submits = if self.profile { Submits::PerPass } else { Submits::One };
        let timed = self.profile.then(|| timed(self.technique, values));
        let values = timed.as_ref().unwrap_or(values);
        let recording = Recording { has_statistics: self.statistics, ..submits.into() };
        let mut renderer = session.renderer(self.technique, values, &self.aovs, recording)?;
        let settings = settings(session, &renderer, values);
        if let Some(continuation) = &self.continuation {
            continuation.begin(&mut renderer, self.technique, &settings)?;
        }
        let asked_ev = values.unless_auto("exposure", Values::number);
        let rendered = self.rendered(session, &renderer, settings, asked_ev, unfinished)?;
        let report = self.report(session, &renderer, &rendered, path)?;
        self.write(path, &rendered, &report)?;
        // A reference that is made needs the memory.
        drop(renderer);
        let Rendered { picture, ended_after, auto_exposure_ev, .. } = rendered;
        let mut outcome = Outcome {
            notes: report.notes.clone(),
            report,
            picture,
            path: path.to_owned(),
            auto_exposure_ev,
            ended_after,
            gates: Ok(()),
        };
        if let Some(asked) = self.reference.as_ref().filter(|_| ended_after.is_none()) {
            let judged = asked.judge(&outcome.picture, self.technique, values, session)?;
            outcome.report.errors = Some(judged.errors);
            outcome.gates = judged.gates.map_err(|error| error.within(path.display()));
        }
        Ok(outcome)
    }

    /// Renders, and reads back what was asked for. `settings`: those that were used; `asked_ev`: the exposure, stops; None:
    /// `auto`.
    ///
    /// Errors: as `picture`.
    fn rendered(
        &self,
        session: &Session,
        renderer: &Renderer,
        mut settings: WrittenSettings,
        asked_ev: Option<f64>,
        unfinished: Unfinished,
    ) -> Result<Rendered> {
        let memory = session.gpu.memory.snapshot();
        interrupt::check()?;
        let times = self.frames(renderer)?;
        let (runs, all) = renderer.runs();
        // Fewer than all may also be enough, by --until-error.
        let asked_to_stop = interrupt::check();
        let has_picture = all > 1 && renderer.has_early_pictures();
        let is_kept = has_picture && unfinished == Unfinished::Kept && asked_to_stop.is_err();
        let ended_after = is_kept.then_some((runs, all));
        if ended_after.is_none() {
            asked_to_stop?;
        }
        let picture = renderer.picture()?;
        let sums = renderer.sums()?;
        let aovs = self.aovs.iter().map(|name| renderer.aov(name)).collect::<Result<Vec<_>>>()?;
        let auto_exposure_ev = if asked_ev.is_none() { exposure_for(&picture) } else { None };
        let exposure_ev = asked_ev.or(auto_exposure_ev).unwrap_or_default();
        if asked_ev.is_none() {
            settings.insert("exposure".to_owned(), SettingValue::of_number(exposure_ev));
        }
        // Stages are not light: what was made for the picture's is none of theirs.
        let stages_ev = asked_ev.unwrap_or_default();
        Ok(Rendered {
            settings,
            memory,
            times,
            picture,
            sums,
            aovs,
            exposure_ev,
            stages_ev,
            auto_exposure_ev,
            ended_after,
        })
    }

    /// Where the picture of `scene` goes.
    pub(crate) fn output_path(&self, scene: &Scene) -> PathBuf {
        self.output.clone().unwrap_or_else(|| default_path(scene, self.technique))
    }

    /// Errors: a setting is changed that the others leave unread (exit code 2).
    pub(crate) fn require_read(&self) -> Result<()> {
        readers::require_read(&settings_of(self.technique), &self.values)
            .map_err(|error| error.within(self.technique.name()))
    }

    /// What can be refused before anything is loaded.
    pub(crate) fn check(&self) -> Result<()> {
        self.require_read()?;
        if self.roofline.is_some() && !self.profile {
            return Err(Error::request("--device-rows: passes have times, to be a share of, with --profile alone"));
        }
        if let Some(path) = &self.output {
            let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
            if !["png", "exr"].contains(&extension.to_lowercase().as_str()) {
                return Err(Error::request(format!("-o {}: pictures are written as .png or .exr", path.display())));
            }
            require_folder(path)?;
        }
        if let Some(path) = &self.report {
            require_folder(path)?;
        }
        if let Some(asked) = &self.reference {
            asked.check(self.values.extent("size"))?;
        }
        stages::require_known(self.technique, &self.aovs)
    }

    /// What the request's scene is at any time.
    ///
    /// Errors: no such scene, animation or volume, or a broken file (exit code 2).
    pub fn open_model(&self) -> Result<Model> {
        let choice = AnimationChoice::parse(self.values.text("animation"));
        let model = scene::open(&self.scene, self.values.integer("seed"), &choice)?;
        Ok(match open_volume(&self.values)? {
            None => model,
            Some(volume) => Model::Holding(Box::new(model), Arc::new(volume)),
        })
    }

    /// The scene that the request names, at its time, or while its shutter is open.
    ///
    /// Errors: no such scene or animation, a broken file, or a shutter that closes before it opens (exit code 2).
    pub fn load_scene(&self) -> Result<Scene> {
        let [open_s, close_s] = exposure_s(&self.values)?;
        let model = self.open_model()?;
        let is_one_moment = open_s == close_s && earlier_s(&self.values).is_none();
        if is_one_moment { model.into_pose(open_s) } else { scene_of(&model, &self.values) }
    }

    /// `scene` with its textures as the request asks for them on a device of `caps`.
    pub fn with_texturing(&self, mut scene: Scene, caps: &Caps) -> Scene {
        let budget_bytes = self.values.bytes("memory-budget");
        let limit_px = match self.values.unless_auto("texture-limit", Values::integer) {
            Some(limit_px) => limit_px as u32,
            None => SceneStats::fitting_limit_px(&scene, caps, budget_bytes),
        };
        let fills_gutters = self.values.is("texture-gutters", Gutters::Fill);
        scene.texturing = Texturing { limit_px, fills_gutters, anisotropy: self.values.integer("anisotropy") as u32 };
        scene
    }

    /// Opens a device with `scene` as the request asks for it.
    ///
    /// Errors: nothing of it is drawn (exit code 2), no fitting device (3), memory (4).
    pub fn open_session(&self, request: &DeviceRequest, scene: Scene) -> Result<Session> {
        // Named as the request names it.
        require_triangle(&scene, &self.scene)?;
        let gpu = Gpu::open(request)?;
        let is_of = |roofline: &Roofline| roofline.require(&gpu.caps.identity, "--device-rows: this device");
        self.roofline.as_ref().map_or(Ok(()), is_of)?;
        let scene = self.with_texturing(scene, &gpu.caps);
        Session::on(gpu, scene)
    }

    /// The device that the request names.
    pub fn device_request(&self) -> DeviceRequest {
        DeviceRequest {
            selector: self.device.clone(),
            validate: self.validate,
            touched: self.values.choice("touched"),
            strategy: self.values.choice("allocation"),
            image_tiling: self.values.choice("image-tiling"),
            budget_bytes: self.values.bytes("memory-budget"),
            block_bytes: self.values.unless_auto("memory-block", Values::power_of_bytes),
            recorder: self.recorder.clone(),
            // The layer's checks of what shaders read see nothing where the device mends it; and it may cost time.
            robust: !self.validate && !self.profile,
            ..DeviceRequest::default()
        }
    }

    fn frames(&self, renderer: &Renderer) -> Result<Vec<FrameTime>> {
        if !self.profile {
            return Ok(vec![renderer.frame()?]);
        }
        renderer.frame()?;
        (0..PROFILE_FRAMES)
            .map(|_| {
                interrupt::check()?;
                renderer.frame()
            })
            .collect()
    }

    /// Errors: the picture holds NaN or infinity (exit code 1); memory for reading counters back (4).
    fn report(&self, session: &Session, renderer: &Renderer, rendered: &Rendered, path: &Path) -> Result<RunReport> {
        let Rendered { picture, exposure_ev, .. } = rendered;
        let (scene, view, lights) = (&session.scene, &renderer.view, &renderer.lights);
        let passes = Passes {
            host: &renderer.host_passes,
            once: &renderer.once_passes,
            each_frame: renderer.passes(),
            clock: renderer.clock(),
        };
        let memory = renderer.touched(session.memory_table(renderer, Some(&rendered.memory))?)?.report();
        let times = Times::of(&passes, &rendered.times, self.profile).counted(memory.touched.as_ref());
        let counters = renderer.measured_counters()?;
        Ok(RunReport {
            schema: SCHEMA,
            quincunx: Program::this(),
            command: self.command.clone(),
            presets: self.presets.clone(),
            device: DeviceRow::of(&session.gpu),
            technique: self.technique.name().to_owned(),
            estimator: self.technique.estimator_version(),
            scene: SceneRow::of(scene, view, lights),
            settings: rendered.settings.clone(),
            aovs: rendered.aovs.iter().map(|aov| AovRow::of(aov, picture.extent)).collect(),
            times: times.under(self.roofline.as_ref()),
            memory,
            counters: counters.into_iter().map(|(key, count)| (key.to_owned(), count)).collect(),
            image: ImageRow::of(picture, path, (!is_exr(path)).then_some(*exposure_ev))?,
            notes: Vec::from_iter(notes::of_nothing_seen(picture, *exposure_ev, scene, view, lights.has_rig)),
            errors: None,
            frame: None,
            time_s: None,
        })
    }

    /// Picture and stages. Sums are kept in an EXR of 32-bit floats, so that `--continue` can continue it.
    fn write(&self, path: &Path, rendered: &Rendered, report: &RunReport) -> Result<()> {
        let Rendered { picture, aovs, exposure_ev, stages_ev, .. } = rendered;
        let is_exr = is_exr(path);
        let mut options = WriteOptions {
            exposure_ev: *exposure_ev,
            tone_map: self.values.choice("tonemap"),
            exr_precision: self.values.choice("exr"),
            aovs: &[],
            attributes: report.attributes(),
        };
        let mut layers = aovs.clone();
        if options.exr_precision == ExrPrecision::Float {
            layers.extend(rendered.sums.iter().flat_map(|sums| continuation::layers(sums)));
        }
        if is_exr {
            options.aovs = &layers;
        }
        write(path, picture, &options)?;
        if !is_exr {
            // A PNG has no layers: each stage becomes a picture beside it.
            for aov in aovs {
                let file = path.with_extension(format!("{}.png", aov.name));
                let options = WriteOptions { aovs: &[], exposure_ev: *stages_ev, ..options.clone() };
                write(&file, &visible(aov, picture.extent), &options)?;
            }
        }
        Ok(())
    }
}

fn is_exr(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("exr"))
}

/// `model` at the time of `values`, or while their shutter is open, with the moment before where motion vectors are asked for.
///
/// Errors: as `Job::load_scene`.
pub(crate) fn scene_of(model: &Model, values: &Values) -> Result<Scene> {
    let scene = model.exposed(exposure_s(values)?)?;
    match earlier_s(values) {
        Some(earlier_s) => scene.moved_from(model.pose(earlier_s)?),
        None => Ok(scene),
    }
}

/// The volume of the settings; None: they ask for none, or the technique draws none.
///
/// Errors: there is no such volume, or its file is broken (exit code 2); memory (4).
fn open_volume(values: &Values) -> Result<Option<Volume>> {
    let Some(spec) = volume_name(values) else { return Ok(None) };
    let request = VolumeRequest { spec, raw_size: raw_volume_size(values)?, seed: values.integer("seed") };
    volume::open(&request).map(Some)
}

/// As reports and rows have them: with what `auto` and percentages came to.
pub(crate) fn settings(session: &Session, renderer: &Renderer, values: &Values) -> WrittenSettings {
    let mut resolved = renderer.resolved.clone();
    resolved.insert("texture-limit", session.scene.texturing.limit_px.to_string());
    written(values, &resolved)
}

/// Errors: the validation layer has said something (exit code 1).
pub fn fail_on_validation(log: Option<&Log>) -> Result<()> {
    let messages = log.map(Log::take).unwrap_or_default();
    match messages.first() {
        None => Ok(()),
        Some(first) => {
            let count = messages.len();
            Err(Error::gate(format!("--validate: {count} messages, the first is {}", first.id)).note(&first.text))
        }
    }
}

fn default_path(scene: &Scene, technique: &dyn Technique) -> PathBuf {
    let stem: String =
        scene.name.split(':').next().unwrap_or("scene").chars().map(|c| if c == '/' { '-' } else { c }).collect();
    PathBuf::from(format!("{stem}-{}.png", technique.name()))
}
