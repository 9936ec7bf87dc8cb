//! Session: the device with the scene in its memory. It makes any number of renderers; A B A B timing holds two.

mod part_recording;
mod parts;
mod renderer;

pub use renderer::Renderer;

use part_recording::PartRecording;

use crate::bvh::LazyBvh;
use crate::caps::Caps;
use crate::error::{Error, ErrorKind, Result};
use crate::frame::View;
use crate::gpu::commands::{Recording, Submits};
use crate::gpu::shader::structs::FrameBlock;
use crate::gpu::{Commands, DeviceRequest, Gpu, statistics};
use crate::lights::LightSet;
use crate::memory::kinds::Kinds;
use crate::memory::ledger::Snapshot;
use crate::passes::next_run::NextRun;
use crate::plan::{Plan, Requirements, Resources, Sharing};
use crate::progress::Stage;
use crate::report::memory::MemoryTable;
use crate::resident::{self, SceneGpu, SceneStats, Textures};
use crate::scene::{AlphaMode, Scene};
use crate::settings::Values;
use crate::techniques::{Inputs, Prepared, Technique, bindable, fitness, stages};
use std::cell::{Cell, RefCell};
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
        let recording = match self.gpu.marks {
            // What a pass touched is taken when it has ended.
            Some(_) => Recording { submits: Submits::PerPass, limit: None, ..recording.into() },
            None => Recording { limit: submit_limit(values, &self.gpu.caps), ..recording.into() },
        };
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
        let heirs = resources.heirs(&sharing);
        cmd.set_heirs(heirs.clone());
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
            part_recording: PartRecording { name: technique.name(), recording, heirs },
            error_of_halves: Cell::new(None),
            scene_gpu: self.scene_gpu.clone(),
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
