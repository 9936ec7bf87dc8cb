//! A pass of the library's user after a technique's own: it reads the finished picture and makes another one.
//!
//! `WithPass` is a technique like the one that it has in it, so that sessions, plans and timings need not know: the
//! pass's resources are planned with the technique's, its barriers are checked like theirs, its time stands beside
//! theirs. examples/own_pass.rs is a pass whole.

use super::bench_stage::{BenchStage, PlainForm};
use super::notes::Figures;
use super::parts::{InParts, Part};
use super::{Frame, HostPart, Inputs, NamedPattern, Need, Prepared, Rival, Run, Sums, Technique, Tuned};
use crate::caps::Caps;
use crate::error::Result;
use crate::frame::View;
use crate::gpu::shader::structs::FrameBlock;
use crate::gpu::{Access, Buffer, Commands, Edge, Gpu, Image};
use crate::lights::LightSet;
use crate::picture::Aov;
use crate::plan::{Plan, Resources};
use crate::resident::SceneGpu;
use crate::settings::{Setting, Values};
use crate::units::Extent;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A pass, or several, after those of a technique.
pub trait OwnPass: Send + Sync {
    /// Adds its resources, and its passes with what they touch, to the technique's. `picture`: the full name of the
    /// technique's picture, an image of `extent` pixels, RGBA32F, which shaders can load (`Access::ComputeRead`) and
    /// copies can read.
    fn plan(&self, plan: &mut Plan, picture: &str, extent: Extent);

    /// Makes its pipelines, and takes its planned resources out.
    ///
    /// Errors: the driver refuses (exit code 4).
    fn build(&self, gpu: &Arc<Gpu>, resources: &mut Resources) -> Result<Box<dyn OwnFrame>>;
}

/// A pass on the device.
pub trait OwnFrame {
    /// Records it, in as many passes as it has planned. `picture`: the technique's, and how that touched it last.
    ///
    /// Errors: more workgroups than the device allows (exit code 2), no memory for descriptors (4).
    fn record(&self, cmd: &mut Commands, picture: Edge<'_, Image>) -> Result<()>;

    /// Its picture (RGBA32F) and how `record` touched it last.
    fn picture(&self) -> (&Image, Access);
}

/// A technique with a pass after it.
pub struct WithPass {
    pub technique: &'static dyn Technique,
    pub pass: Arc<dyn OwnPass>,
}

impl Technique for WithPass {
    fn name(&self) -> &'static str {
        self.technique.name()
    }

    fn summary(&self) -> &'static str {
        self.technique.summary()
    }

    fn scene(&self) -> &'static str {
        self.technique.scene()
    }

    fn settings(&self) -> &'static [&'static [Setting]] {
        self.technique.settings()
    }

    fn aovs(&self) -> &'static [&'static str] {
        self.technique.aovs()
    }

    fn shorter(&self) -> &'static [(&'static str, &'static str)] {
        self.technique.shorter()
    }

    fn needs(&self, values: &Values, caps: &Caps, has_blend: bool) -> Vec<Need> {
        self.technique.needs(values, caps, has_blend)
    }

    fn bounds(&self, caps: &Caps) -> Vec<(&'static str, String)> {
        self.technique.bounds(caps)
    }

    fn reference_settings(&self, values: &Values, lights: &LightSet) -> Result<Vec<(&'static str, String)>> {
        self.technique.reference_settings(values, lights)
    }

    fn estimator_version(&self) -> u32 {
        self.technique.estimator_version()
    }

    fn rivals(&self) -> Vec<Rival> {
        self.technique.rivals()
    }

    fn notes(&self, figures: &Figures<'_>) -> Vec<String> {
        self.technique.notes(figures)
    }

    fn bench_stages(&self) -> &'static [BenchStage] {
        self.technique.bench_stages()
    }

    fn plain(&self) -> Option<&'static PlainForm> {
        self.technique.plain()
    }

    fn tuned(&self) -> Tuned {
        self.technique.tuned()
    }

    fn patterns(&self) -> &'static [NamedPattern] {
        self.technique.patterns()
    }

    fn prepare(&self, inputs: &Inputs<'_>) -> Result<Box<dyn Prepared>> {
        Ok(Box::new(PreparedWithPass { prepared: self.technique.prepare(inputs)?, pass: self.pass.clone() }))
    }
}

struct PreparedWithPass {
    prepared: Box<dyn Prepared>,
    pass: Arc<dyn OwnPass>,
}

impl Prepared for PreparedWithPass {
    fn plan(&self, inputs: &Inputs<'_>) -> Result<Plan> {
        let mut plan = self.prepared.plan(inputs)?;
        // The first that `Plan::picture` has planned: of two eyes' the left one's.
        let is_picture = |name: &str| plan.resources.iter().any(|planned| planned.name == name && planned.read_back);
        let of_group = plan.resources.iter().filter(|planned| planned.group == "picture");
        let picture = of_group.map(|planned| planned.name.clone()).find(|name| is_picture(name));
        let picture = picture.expect("every technique plans its picture");
        self.pass.plan(&mut plan, &picture, inputs.view.extent);
        Ok(plan)
    }

    fn stages_left_out(&self, inputs: &Inputs<'_>) -> Vec<(&'static str, String)> {
        self.prepared.stages_left_out(inputs)
    }

    fn resolved(&self) -> BTreeMap<&'static str, String> {
        self.prepared.resolved()
    }

    fn host_part(self: Box<Self>, inputs: &Inputs<'_>) -> Result<HostPart> {
        let Self { prepared, pass } = *self;
        let HostPart { passes, counters, light_counts, build } = prepared.host_part(inputs)?;
        let build =
            Box::new(move |gpu: &Arc<Gpu>, inputs: &Inputs<'_>, scene: &SceneGpu, resources: &mut Resources| {
                let frame = build(gpu, inputs, scene, resources)?;
                let own = pass.build(gpu, resources)?;
                Ok(Box::new(FrameWithPass { frame, own }) as Box<dyn Frame>)
            });
        Ok(HostPart { passes, counters, light_counts, build })
    }
}

struct FrameWithPass {
    frame: Box<dyn Frame>,
    own: Box<dyn OwnFrame>,
}

impl Frame for FrameWithPass {
    fn record(&self, cmd: &mut Commands, scene: &SceneGpu, frame: &Buffer) -> Result<()> {
        self.frame.record(cmd, scene, frame)?;
        let (picture, last) = self.frame.picture();
        self.own.record(cmd, picture.from(last))
    }

    fn once(&self) -> Vec<(String, u64)> {
        self.frame.once()
    }

    fn run_count(&self) -> u32 {
        self.frame.run_count()
    }

    fn has_early_pictures(&self) -> bool {
        self.frame.has_early_pictures()
    }

    fn runs_alike(&self) -> bool {
        self.frame.runs_alike()
    }

    fn records_each_run(&self) -> bool {
        self.frame.records_each_run()
    }

    fn begin_run(&self, run: &Run<'_>) -> Result<Vec<(String, u64)>> {
        self.frame.begin_run(run)
    }

    fn block_of(&self, run: u32, block: FrameBlock, view: &View) -> FrameBlock {
        self.frame.block_of(run, block, view)
    }

    fn in_parts(&self) -> Option<InParts> {
        self.frame.in_parts()
    }

    /// Its own pass goes over each picture.
    fn record_part(&self, cmd: &mut Commands, scene: &SceneGpu, frame: &Buffer, part: Part) -> Result<()> {
        self.frame.record_part(cmd, scene, frame, part)?;
        if let Part::Samples { .. } = part {
            return Ok(());
        }
        let (picture, last) = self.frame.picture();
        self.own.record(cmd, picture.from(last))
    }

    fn sums(&self) -> Option<Sums<'_>> {
        self.frame.sums()
    }

    fn drawn(&self) -> BTreeMap<&'static str, f64> {
        self.frame.drawn()
    }

    fn picture(&self) -> (&Image, Access) {
        self.own.picture()
    }

    fn explained_nan(&self) -> Option<[String; 2]> {
        self.frame.explained_nan()
    }

    fn counters(&self, gpu: &Arc<Gpu>) -> Result<BTreeMap<&'static str, f64>> {
        self.frame.counters(gpu)
    }

    fn touched_bytes(&self, gpu: &Arc<Gpu>) -> Result<BTreeMap<String, u64>> {
        self.frame.touched_bytes(gpu)
    }

    fn aov(&self, gpu: &Arc<Gpu>, name: &str) -> Result<Aov> {
        self.frame.aov(gpu, name)
    }
}
