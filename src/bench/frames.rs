//! Sequences: every frame of `--frames` posed, uploaded, prepared and drawn, and the mean of what a frame takes (Dubla et
//! al. 2009, section 5, average 100).
//!
//! A variant's frames share one device and one scene, which goes from moment to moment as in `render --frames`; variants take
//! turns by whole sequences. A frame's passes are recorded anew, and its shaders compiled, for every frame, which a program
//! that draws moving scenes would not do: that is told beside the time (`setup_ms`) and is no part of it. So is the copy of
//! the tree into buffers of the technique's own. A frame is drawn twice and timed the second time, because software drivers
//! compile shaders at the first.

use super::rounds::Samples;
use super::row::{BenchRow, FrameParts};
use super::stats::median;
use crate::error::{Error, ErrorKind, Result};
use crate::gpu::Gpu;
use crate::gpu::commands::Submits;
use crate::interrupt;
use crate::job::{Job, scene_of};
use crate::metrics::{ErrorFlickerMeter, FlickerMeter};
use crate::picture::Picture;
use crate::reference::ReferenceRequest;
use crate::scene::Model;
use crate::sequence::Frames;
use crate::session::Session;
use crate::settings::Values;
use std::cell::{Cell, RefCell};
use std::rc::Rc;
use std::sync::Arc;
use std::time::Instant;

/// Frames below which nothing can be said of flicker.
const LEAST_OF_FLICKER: usize = 3;

/// What all variants' sequences share.
pub struct Sequence {
    frames: Frames,
    model: Model,
    gpu: Arc<Gpu>,
    /// At the moment that was shown last; None before the first, and after an error.
    session: RefCell<Option<Session>>,
}

/// The sequence of one variant.
pub struct VariantSequence {
    sequence: Rc<Sequence>,
    /// Its technique and settings.
    job: Job,
    /// Milliseconds a frame of what is not timed, of each run.
    setup_ms: RefCell<Vec<f64>>,
    /// Frames of the last run whose tree was built, and refitted.
    trees: Cell<[u32; 2]>,
}

/// What `VariantSequence::flicker` finds.
#[derive(Default)]
pub struct Flicker {
    pub flicker: Option<f64>,
    pub flicker_error: Option<f64>,
}

/// Whoever wants to see each frame, with the session that shows its moment and the frame's settings.
type Viewer<'a> = &'a mut dyn FnMut(Picture, &Session, &Values) -> Result<()>;

impl Sequence {
    /// Frames of the scene of `job`, on `gpu`.
    ///
    /// Errors: as `Job::open_model`; a frame is later than `--time` can be (exit code 2).
    pub fn new(job: &Job, frames: &Frames, gpu: &Arc<Gpu>) -> Result<Self> {
        frames.values(job, frames.last(), None)?;
        let (model, session) = (job.open_model()?, RefCell::default());
        Ok(Self { frames: frames.clone(), model, gpu: gpu.clone(), session })
    }
}

impl VariantSequence {
    /// `job`: the variant's technique and settings.
    pub fn new(sequence: &Rc<Sequence>, job: Job) -> Self {
        let (setup_ms, trees) = (RefCell::default(), Cell::default());
        Self { sequence: sequence.clone(), job, setup_ms, trees }
    }

    /// Makes every frame, once for `viewer` or, without one, twice: milliseconds a frame of the parts of
    /// `FrameParts`, in their order.
    ///
    /// Errors: the device fails, memory (exit code 4); a frame's scene cannot be (2); interrupted (130).
    fn run(&self, mut viewer: Option<Viewer<'_>>) -> Result<[f64; 5]> {
        let Sequence { frames, model, gpu, session } = &*self.sequence;
        let tree = format!("{}.bvh", self.job.technique.name());
        let mut kept = session.borrow_mut().take();
        let (mut parts_ns, mut setup_ns, mut trees) = ([0; 5], 0, [0; 2]);
        for frame in frames.numbers() {
            interrupt::check()?;
            let within = |error: Error| error.within(format!("frame {frame}"));
            let values = frames.values(&self.job, frame, None)?;
            let started = Instant::now();
            let scene = self.job.with_texturing(scene_of(model, &values).map_err(within)?, &gpu.caps);
            let posed = Instant::now();
            let shown = match kept.take() {
                // A sequence begins with a tree of its own, whatever was shown before.
                Some(before) if frame == frames.first() => before.at_moment(scene, 0.0),
                Some(before) => before.at_moment(scene, values.number("tree-growth")),
                None => Session::on(gpu.clone(), scene),
            };
            let (shown, uploaded) = (shown.map_err(within)?, Instant::now());
            let renderer = shown.renderer(self.job.technique, &values, &[], Submits::One).map_err(within)?;
            let made_ns = uploaded.elapsed().as_nanos() as u64;
            let mut drawn = renderer.frame()?;
            if viewer.is_none() {
                drawn = renderer.frame()?;
            }
            let sum = |passes: &[(String, u64)], is_tree: bool| -> u64 {
                passes.iter().filter(|(name, _)| (*name == tree) == is_tree).map(|(_, ns)| ns).sum()
            };
            let [tree_ns, host_ns] = [true, false].map(|is_tree| sum(&renderer.host_passes, is_tree));
            let once_ns = sum(&renderer.once_passes, false);
            let frame_ns = [
                (posed - started).as_nanos() as u64,
                (uploaded - posed).as_nanos() as u64,
                tree_ns,
                host_ns,
                once_ns + drawn.figure_ns(renderer.clock()),
            ];
            parts_ns.iter_mut().zip(frame_ns).for_each(|(sum, ns)| *sum += ns);
            setup_ns += made_ns.saturating_sub(tree_ns + host_ns + once_ns);
            if tree_ns > 0 {
                trees[usize::from(renderer.counters.get("tree_refits").is_some_and(|refits| *refits > 0.0))] += 1;
            }
            if let Some(view) = &mut viewer {
                let picture = renderer.picture().map_err(within)?;
                // A reference that is made needs the memory.
                drop(renderer);
                view(picture, &shown, &values).map_err(within)?;
            }
            kept = Some(shown);
        }
        *session.borrow_mut() = kept;
        self.trees.set(trees);
        let a_frame_ms = |ns: u64| ns as f64 / 1e6 / frames.count() as f64;
        if viewer.is_none() {
            self.setup_ms.borrow_mut().push(a_frame_ms(setup_ns));
        }
        Ok(parts_ns.map(a_frame_ms))
    }

    /// One run of the sequence: as `Probe::measure`.
    pub fn measure(&self) -> Result<Vec<f64>> {
        Ok(self.run(None)?.to_vec())
    }

    /// How much its frames flicker, and where there is a reference for each, how much their errors do.
    ///
    /// Errors: as `run`; a picture holds NaN or infinity (exit code 1).
    pub fn flicker(&self, asked: Option<&ReferenceRequest>) -> Result<Flicker> {
        if self.sequence.frames.count() < LEAST_OF_FLICKER {
            return Ok(Flicker::default());
        }
        let (mut meter, mut error_meter, mut asked) = (FlickerMeter::default(), ErrorFlickerMeter::default(), asked);
        self.run(Some(&mut |picture, session, values| {
            meter.add(&picture);
            let Some(request) = asked else { return Ok(()) };
            match request.of_frame(self.job.technique, values, session) {
                Ok(reference) => error_meter.add(&picture, &reference),
                // The row says why (`errors_skipped`).
                Err(error) if matches!(error.kind(), ErrorKind::Request | ErrorKind::Memory) => asked = None,
                Err(error) => return Err(error),
            }
            Ok(())
        }))?;
        let flicker_error = asked.and(error_meter.value());
        Ok(Flicker { flicker: meter.value(), flicker_error })
    }

    /// What a row has of a sequence. `samples`: of its rounds.
    pub fn fill(&self, row: &mut BenchRow, samples: &Samples, flicker: &Flicker) {
        let [pose, upload, tree, host, device] = samples.part_medians_ms()[..] else {
            unreachable!("a sequence has five parts")
        };
        row.frame_parts_ms = Some(FrameParts { pose, upload, tree, host, device });
        row.setup_ms = Some(median(&self.setup_ms.borrow()));
        let [built, refitted] = self.trees.get();
        (row.trees_built, row.trees_refitted) = (Some(built), Some(refitted));
        (row.flicker, row.flicker_error) = (flicker.flicker, flicker.flicker_error);
    }
}
