//! Session: the device with the scene in its memory. It makes any number of renderers; A B A B timing holds two.

use crate::bvh::LazyBvh;
use crate::caps::Caps;
use crate::caps::quirks::LoopEnd;
use crate::error::{Error, ErrorKind, Result};
use crate::frame::View;
use crate::gpu::commands::{RecordedPass, Recording, Submits};
use crate::gpu::recorded::{FrameTime, Recorded};
use crate::gpu::shader::structs::FrameBlock;
use crate::gpu::timing::Clock;
use crate::gpu::{Access, Buffer, Commands, DeviceRequest, Gpu, readback, statistics, upload};
use crate::interrupt;
use crate::lights::LightSet;
use crate::memory::kinds::Kinds;
use crate::memory::ledger::Snapshot;
use crate::metrics::noise;
use crate::passes::next_run::NextRun;
use crate::picture::{Aov, Picture};
use crate::plan::{Plan, Requirements, Resources, Sharing};
use crate::progress::Stage;
use crate::report::memory::MemoryTable;
use crate::resident::{self, SceneGpu, SceneStats, Textures};
use crate::scene::{AlphaMode, Scene};
use crate::settings::Values;
use crate::techniques::{Frame, Inputs, Prepared, Run, Sums, Technique, bindable, fitness, stages};
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;

/// Longest submit on a GPU with `--submit-ms auto`: a twentieth of what Windows allows, and a thousand times
/// the cost of a submit itself.
const GPU_SUBMIT_MS: f64 = 100.0;

/// A device and a scene.
pub struct Session {
    pub gpu: Arc<Gpu>,
    pub scene: Arc<Scene>,
    pub stats: SceneStats,
    scene_gpu: Arc<SceneGpu>,
    bvh: Arc<LazyBvh>,
}

/// One technique with its settings, ready to make frames.
pub struct Renderer {
    // Dropped in this order: commands, what they use, the scene.
    recorded: Recorded,
    /// Several runs may go at once.
    next_run: Option<NextRun>,
    frame: Box<dyn Frame>,
    /// What `numbers` is in device memory, written between runs.
    block: RefCell<Buffer>,
    numbers: FrameBlock,
    runs: Cell<u32>,
    /// What a picture begins with: sums, and how many samples a pixel they are of.
    earlier: Option<(Vec<[f32; 4]>, u32)>,
    _scene_gpu: Arc<SceneGpu>,
    gpu: Arc<Gpu>,
    scene: Arc<Scene>,
    bvh: Arc<LazyBvh>,
    pub view: View,
    pub lights: LightSet,
    pub host_passes: Vec<(String, u64)>,
    /// Passes that the device ran once before the first frame, with their times in nanoseconds.
    pub once_passes: Vec<(String, u64)>,
    pub counters: BTreeMap<&'static str, f64>,
    pub resolved: BTreeMap<&'static str, String>,
    /// Plan of the frame; the scene's own plan is `SceneStats::plan`.
    pub plan: Plan,
    /// Which of its resources lie in the same bytes.
    pub sharing: Sharing,
    aovs: Vec<String>,
}

impl Session {
    /// Opens the device and uploads the scene.
    ///
    /// Errors: no fitting device (exit code 3); memory (4); a scene without a triangle (2).
    pub fn open(request: &DeviceRequest, scene: Scene) -> Result<Self> {
        require_triangle(&scene, &scene.name)?;
        Self::on(Gpu::open(request)?, scene)
    }

    /// The same device with another scene. One of the same hash and texture limit is there already; of one that shows the
    /// same pictures, as other moments of a model do, the textures are.
    ///
    /// Errors: as `open`, except for the device.
    pub fn showing(self, scene: Scene) -> Result<Self> {
        self.at_moment(scene, 0.0)
    }

    /// The same, with the trees that rays walk refitted where `scene` has the same triangles elsewhere, as long as their
    /// cost has not grown by more than the share `tree_growth` since they were built (`--tree-growth`).
    ///
    /// Errors: as `showing`.
    pub fn at_moment(self, scene: Scene, tree_growth: f64) -> Result<Self> {
        if scene.hash == self.scene.hash && scene.texturing == self.scene.texturing {
            return Ok(self);
        }
        require_triangle(&scene, &scene.name)?;
        let Self { gpu, scene: before, scene_gpu, bvh, .. } = self;
        let textures = scene_gpu.textures();
        // A renderer of before that is still there keeps its trees to itself.
        let earlier = Arc::into_inner(bvh);
        let bvh = earlier.map_or_else(LazyBvh::default, |bvh| LazyBvh::after(bvh, [&before, &scene], tree_growth));
        // The old scene goes first: the device need not have room for both.
        drop((scene_gpu, before));
        Self::with_kept(gpu, scene, Some(textures), bvh)
    }

    /// Uploads the scene.
    ///
    /// Errors: memory (exit code 4).
    pub(crate) fn on(gpu: Arc<Gpu>, scene: Scene) -> Result<Self> {
        Self::with_kept(gpu, scene, None, LazyBvh::default())
    }

    fn with_kept(gpu: Arc<Gpu>, scene: Scene, kept: Option<Arc<Textures>>, bvh: LazyBvh) -> Result<Self> {
        let _stage = Stage::begin("uploading the scene");
        let stats = SceneStats::of(&scene);
        let uploaded = SceneGpu::new(&gpu, &scene, kept).map_err(|error| resident::advise(error, &gpu, &scene));
        let scene_gpu = Arc::new(uploaded?);
        Ok(Self { gpu, scene: Arc::new(scene), stats, scene_gpu, bvh: Arc::new(bvh) })
    }

    /// Makes a technique real for these settings, and records its frame. `aovs`: the stages that will be read back.
    ///
    /// Errors: impossible settings (exit code 2); the device lacks what they or `recording` need (3); memory (4).
    pub fn renderer(
        &self,
        technique: &dyn Technique,
        values: &Values,
        aovs: &[String],
        recording: impl Into<Recording>,
    ) -> Result<Renderer> {
        let recording = Recording { limit: submit_limit(values, &self.gpu.caps), ..recording.into() };
        if recording.has_statistics {
            statistics::require(&self.gpu.caps)?;
        }
        self.bvh.begin_use();
        let view = View::new(&self.scene, values.text("camera"), values.extent("size"))?;
        let lights = LightSet::new(&self.scene, &view, values)?;
        // It says itself what would fit.
        let planned = Planned::new(technique, &self.inputs(&view, &lights, values), aovs)?;
        self.make(technique, values, (view, lights, planned), aovs, recording).map_err(|error| {
            if error.kind() != ErrorKind::Memory {
                return error;
            }
            let plan = format!("`memory --technique {}` prints the plan", technique.name());
            match self.lessen(technique, values) {
                Ok(less) => resident::advise(error, &self.gpu, &self.scene).note(format!("{less}; {plan}")),
                // Such as Ctrl-C in the meantime.
                Err(other) => other,
            }
        })
    }

    /// What would need less memory, in words.
    ///
    /// Errors: as `renderer`, before anything is made.
    fn lessen(&self, technique: &dyn Technique, values: &Values) -> Result<String> {
        let view = View::new(&self.scene, values.text("camera"), values.extent("size"))?;
        let lights = LightSet::new(&self.scene, &view, values)?;
        Ok(bindable::lessen(technique, &self.inputs(&view, &lights, values)))
    }

    /// The memory of the scene and of `renderer`. `snapshot`: where their resources lie, while no other renderer has any.
    ///
    /// Errors: no memory type fits a resource (exit code 4).
    pub fn memory_table(&self, renderer: &Renderer, snapshot: Option<&Snapshot>) -> Result<MemoryTable> {
        let (requirements, kinds) = (Requirements::Device(&self.gpu), Kinds::new(&self.gpu.caps));
        let sharing = renderer.sharing.clone();
        MemoryTable::new(&self.stats.plan(), &renderer.plan, sharing, requirements, &kinds, snapshot)
    }

    fn inputs<'a>(&'a self, view: &'a View, lights: &'a LightSet, values: &'a Values) -> Inputs<'a> {
        Inputs {
            caps: &self.gpu.caps,
            requirements: Requirements::Device(&self.gpu),
            scene: &self.scene,
            stats: &self.stats,
            bvh: &self.bvh,
            view,
            lights,
            values,
        }
    }

    fn make(
        &self,
        technique: &dyn Technique,
        values: &Values,
        (view, lights, planned): (View, LightSet, Planned),
        aovs: &[String],
        recording: Recording,
    ) -> Result<Renderer> {
        let inputs = self.inputs(&view, &lights, values);
        let Planned { prepared, plan } = planned;
        let resolved = prepared.resolved();
        let host = prepared.host_part(&inputs)?;
        let sharing = Sharing::of(&plan, inputs.requirements, &self.gpu.caps, values);
        let mut resources = Resources::make(&self.gpu, technique.name(), &plan, &sharing)?;
        let [light_count, vpl_count] = host.light_counts;
        let background = values.color("background");
        let numbers = view.block(&self.scene.bounds(), background, lights.ambient, light_count, vpl_count);
        let mut block = resources.buffer(&block_name(technique));
        block.mapped_mut().copy_from_slice(bytemuck::bytes_of(&numbers));
        let (mut host_passes, mut counters) = (host.passes, host.counters);
        let blended = self.scene_gpu.calls.iter().filter(|call| call.alpha == AlphaMode::Blend);
        counters.insert("blended_draws", blended.count() as f64);
        let _stage = Stage::begin("compiling pipelines");
        let frame = (host.build)(&self.gpu, &inputs, &self.scene_gpu, &mut resources)?;
        counters.extend(frame.drawn());
        if let Some(used) = self.bvh.used() {
            counters.extend([("tree_refits", used.refits.into()), ("tree_cost", used.cost)]);
            if used.made_ns > 0 {
                host_passes.insert(0, (format!("{}.bvh", technique.name()), used.made_ns));
            }
        }
        let once_passes = frame.once();
        let mut cmd = Commands::begin(&self.gpu, technique.name(), recording)?;
        cmd.set_heirs(resources.heirs(&sharing));
        frame.record(&mut cmd, &self.scene_gpu, &block)?;
        let may_batch = recording.limit.is_some() && recording.submits == Submits::One;
        let mut next_run = None;
        if may_batch && frame.runs_alike() && frame.run_count() > 1 {
            let between = NextRun::new(&self.gpu)?;
            between.record(&mut cmd, &block)?;
            next_run = Some(between);
        }
        if cfg!(debug_assertions) {
            let names: Vec<&str> = cmd.passes().iter().map(|pass| pass.name.as_str()).collect();
            resources.assert_recorded(&plan, &names, cmd.touched());
        }
        Ok(Renderer {
            recorded: cmd.finish()?,
            next_run,
            frame,
            block: RefCell::new(block),
            numbers,
            runs: Cell::new(0),
            earlier: None,
            _scene_gpu: self.scene_gpu.clone(),
            gpu: self.gpu.clone(),
            scene: self.scene.clone(),
            bvh: self.bvh.clone(),
            view,
            lights,
            host_passes,
            once_passes,
            counters,
            resolved,
            plan,
            sharing,
            aovs: aovs.to_vec(),
        })
    }
}

/// Errors: nothing of the scene, which messages call `name`, is drawn (exit code 2).
pub(crate) fn require_triangle(scene: &Scene, name: &str) -> Result<()> {
    match scene.draws.is_empty() {
        true => Err(Error::request(format!("{name}: there is no triangle to draw"))),
        false => Ok(()),
    }
}

/// A technique whose choices are made, and the whole plan of its frame.
pub struct Planned {
    pub prepared: Box<dyn Prepared>,
    /// The technique's, with the block of numbers that every technique has, and the stages that are read back kept until
    /// then.
    pub plan: Plan,
}

impl Planned {
    /// `aovs`: the stages that are read back.
    ///
    /// Errors: as `Technique::prepare`; there is no such stage, or the settings leave it out (exit code 2); the device lacks
    /// what the settings need (3), or binds no buffer of a size that they need (4), or no image (2).
    pub fn new(technique: &dyn Technique, inputs: &Inputs<'_>, aovs: &[String]) -> Result<Self> {
        fitness::require(technique, inputs.values, inputs.caps, inputs.stats.has_blend)?;
        let prepared = technique.prepare(inputs)?;
        stages::require_made(technique, &*prepared, inputs, aovs)?;
        let mut plan = prepared.plan(inputs)?;
        plan.host_buffer("frame", block_name(technique), size_of::<FrameBlock>() as u64);
        for aov in aovs {
            // A resource, or a part of one such as `light.l_buffer.irradiance`.
            let name = format!("{}.{aov}", technique.name());
            let whole = name.rsplit_once('.').map_or("", |(whole, _)| whole);
            assert!(plan.read_back(&name) || plan.read_back(whole), "{name} is neither planned nor left out");
        }
        plan.check(&inputs.caps.limits).map_err(|error| bindable::advise(error, technique, inputs))?;
        Ok(Self { prepared, plan })
    }
}

/// `--submit-ms`, `auto` resolved.
fn submit_limit(values: &Values, caps: &Caps) -> Option<Duration> {
    let of_kind = if caps.identity.is_software() { 0.0 } else { GPU_SUBMIT_MS };
    let milliseconds = values.unless_auto("submit-ms", Values::number).unwrap_or(of_kind);
    (milliseconds > 0.0).then(|| Duration::from_secs_f64(milliseconds / 1e3))
}

fn block_name(technique: &dyn Technique) -> String {
    format!("{}.frame", technique.name())
}

impl Renderer {
    /// Makes one frame and waits for it: a picture, in as many runs of what was recorded as the technique takes, or fewer
    /// where its error is small enough before. Ctrl-C ends it after a run, whose number is in `runs`.
    ///
    /// Errors: the device fails, memory for reading the sums back (exit code 4); Ctrl-C in the host's part of a run (130).
    pub fn frame(&self) -> Result<FrameTime> {
        let (stage, all) = (Stage::counted("rendering", "samples"), self.frame.run_count());
        let until_error = self.frame.sums().and_then(|sums| sums.until_error);
        let mut expected = all;
        let mut total = self.run(self.begin()?, 1)?;
        while self.runs.get() < all && interrupt::check().is_ok() {
            let count = self.runs.get();
            if let Some(most) = until_error.filter(|_| noise::is_checked(count.into())) {
                let error = self.estimated_error()?.unwrap_or_default();
                // NaN and infinity stay: reading the picture says where.
                if error <= most || !error.is_finite() {
                    break;
                }
                expected = noise::samples_for(most, count.into(), error).min(all.into()) as u32;
            }
            stage.reach(count.into(), expected.into());
            total.add(self.run(count, self.runs_at_once(count, until_error.is_some()))?);
        }
        if all > 1 {
            stage.reach(self.runs.get().into(), expected.into());
        }
        Ok(total)
    }

    /// Lets frames begin with these sums (`Sums`, row-major) of `count` samples a pixel, instead of none.
    ///
    /// Errors: the technique sums nothing up, or its picture has no more samples than that (exit code 2).
    pub fn begin_with(&mut self, sums: Vec<[f32; 4]>, count: u32) -> Result<()> {
        assert_eq!(sums.len() as u64, self.view.extent.pixel_count(), "the sums are of another picture");
        let all = self.frame.run_count();
        if self.frame.sums().is_none() {
            return Err(Error::request("the technique does not sum up samples: there is nothing to continue"));
        }
        if count >= all {
            let why = format!("there are {count} samples a pixel already, and --spp asks for {all} in all");
            return Err(Error::request(why));
        }
        self.earlier = Some((sums, count));
        Ok(())
    }

    /// Puts what a picture begins with in place: the index of the first run.
    fn begin(&self) -> Result<u32> {
        let Some(((sums, count), target)) = self.earlier.as_ref().zip(self.frame.sums()) else { return Ok(0) };
        upload::buffer(&self.gpu, target.buffer, bytemuck::cast_slice(sums), Access::ComputeRead)?;
        Ok(*count)
    }

    /// Runs that may go in one submit after `count` of them: up to the next look at their error.
    fn runs_at_once(&self, count: u32, is_checked: bool) -> u32 {
        let all = self.frame.run_count();
        let fitting = if self.next_run.is_some() { self.recorded.runs_of_submit() } else { 1 };
        let end = (count + 1..all).find(|end| is_checked && noise::is_checked((*end).into())).unwrap_or(all);
        fitting.min(end - count)
    }

    /// `times` runs from `index` on.
    fn run(&self, index: u32, times: u32) -> Result<FrameTime> {
        let numbers = self.frame.block_of(index, self.numbers, &self.view);
        let numbers = FrameBlock { sample_index: index, ..numbers };
        // The run before has ended: the device reads the block no more.
        self.block.borrow_mut().mapped_mut().copy_from_slice(bytemuck::bytes_of(&numbers));
        let host = self.frame.begin_run(&Run { index, frame: &numbers, scene: &self.scene, bvh: &self.bvh })?;
        let time = self.recorded.run_times(times)?;
        self.runs.set(index + times);
        Ok(FrameTime { host, ..time })
    }

    /// What was summed up so far (`Sums`), row-major; None where the technique sums nothing up.
    ///
    /// Errors: memory for the copy (exit code 4).
    pub fn sums(&self) -> Result<Option<Vec<[f32; 4]>>> {
        let Some(Sums { buffer, .. }) = self.frame.sums() else { return Ok(None) };
        let bytes = self.view.extent.pixel_count() * size_of::<[f32; 4]>() as u64;
        let bytes = readback::buffer(&self.gpu, buffer, bytes, Access::ComputeWrite)?;
        Ok(Some(bytemuck::pod_collect_to_vec(&bytes)))
    }

    /// The relative error (`metrics::noise`) of the last frame's picture; None where it is no sum of two samples or more.
    ///
    /// Errors: memory for the copy (exit code 4).
    pub fn estimated_error(&self) -> Result<Option<f64>> {
        let count = self.runs.get();
        let sums = if count > 1 { self.sums()? } else { None };
        Ok(sums.map(|sums| noise::relative_error(&sums, count.into())))
    }

    /// Runs that the last frame's picture is made of, and those that it takes at most.
    pub fn runs(&self) -> (u32, u32) {
        (self.runs.get(), self.frame.run_count())
    }

    /// Whether the last frame left a picture where it was ended before its last run.
    pub fn has_early_pictures(&self) -> bool {
        self.frame.has_early_pictures()
    }

    /// Makes the first `pass_count` passes of a frame that was recorded with a submit a pass. It makes no picture: that
    /// is read after a whole frame.
    ///
    /// Errors: the device fails (exit code 4).
    pub fn frame_first(&self, pass_count: usize) -> Result<FrameTime> {
        self.recorded.run_first(pass_count)
    }

    /// The clock of the times of its frames.
    pub fn clock(&self) -> Clock {
        self.recorded.clock()
    }

    /// The passes of a frame, in order.
    pub fn passes(&self) -> &[RecordedPass] {
        self.recorded.passes()
    }

    /// The last frame's picture.
    ///
    /// Errors: memory for the copy (exit code 4); a pixel is NaN or infinite (1).
    pub fn picture(&self) -> Result<Picture> {
        let (image, last) = self.frame.picture();
        let bytes = readback::image(&self.gpu, image, last)?;
        let pixels = bytes
            .chunks_exact(16)
            .map(|texel| {
                let channel = |at: usize| f32::from_le_bytes([texel[at], texel[at + 1], texel[at + 2], texel[at + 3]]);
                [channel(0), channel(4), channel(8)]
            })
            .collect();
        let picture = Picture { extent: image.description.extent, pixels };
        picture.check().map_err(|error| self.explained(error, &picture))?;
        Ok(picture)
    }

    /// Shaders write NaN where a driver has ended their loops (glsl/loops.glsl).
    fn explained(&self, error: Error, picture: &Picture) -> Error {
        let is_nan = picture.pixels.iter().flatten().any(|channel| channel.is_nan());
        let own = self.frame.explained_nan().filter(|_| is_nan);
        let error = own.into_iter().flatten().fold(error, Error::note);
        match self.gpu.caps.identity.loop_end() {
            Some(LoopEnd { iterations, gone_in }) if is_nan => error
                .note(format!(
                    "this driver ends a thread's loops after {iterations} iterations, which may be lights times steps of \
                     shadow rays, or all steps of a path's rays"
                ))
                .note(format!(
                    "fewer lights, --vpls or --bounces, a larger --pattern, --direct-shadow none or sun, --cull tiled, \
                     --vpl-shadow none, or a newer driver ({gone_in}) would help"
                )),
            _ => error,
        }
    }

    /// What the last frame's counters are, those of the settings and those that it left.
    ///
    /// Errors: memory for reading them back (exit code 4).
    pub fn measured_counters(&self) -> Result<BTreeMap<&'static str, f64>> {
        let mut counters = self.counters.clone();
        counters.extend(self.frame.counters(&self.gpu)?);
        if self.frame.sums().is_some() {
            counters.insert("samples", self.runs.get().into());
        }
        if let Some(error) = self.estimated_error()? {
            counters.insert("estimated_error", error);
        }
        Ok(counters)
    }

    /// Bytes that the last frame touched, by full name, of the resources of which it counts them.
    ///
    /// Errors: memory for reading counts back (exit code 4).
    pub fn touched_bytes(&self) -> Result<BTreeMap<String, u64>> {
        self.frame.touched_bytes(&self.gpu)
    }

    /// One of the last frame's intermediate results, which `Session::renderer` was asked for: others share their bytes
    /// with what came after them.
    ///
    /// Errors: memory for the copy (exit code 4).
    pub fn aov(&self, name: &str) -> Result<Aov> {
        assert!(self.aovs.iter().any(|asked| asked == name), "the renderer was not asked for {name}");
        self.frame.aov(&self.gpu, name)
    }
}
