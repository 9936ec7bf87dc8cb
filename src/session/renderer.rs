//! Renderer: one technique with its settings on a device, which makes frames, and what is read of them.

use super::part_recording::PartRecording;
use crate::bvh::LazyBvh;
use crate::caps::quirks::LoopEnd;
use crate::error::{Error, Result};
use crate::frame::View;
use crate::gpu::commands::RecordedPass;
use crate::gpu::recorded::{FrameTime, Recorded};
use crate::gpu::shader::structs::FrameBlock;
use crate::gpu::timing::Clock;
use crate::gpu::{Access, Buffer, Gpu, readback, upload};
use crate::interrupt;
use crate::lights::LightSet;
use crate::metrics::noise;
use crate::passes::next_run::NextRun;
use crate::picture::{Aov, Picture};
use crate::plan::{Plan, Sharing};
use crate::progress::Stage;
use crate::report::memory::MemoryTable;
use crate::report::memory::touched::TouchedReport;
use crate::resident::SceneGpu;
use crate::scene::Scene;
use crate::techniques::parts::InParts;
use crate::techniques::{Frame, Run, Sums};
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::sync::Arc;

/// One technique with its settings, ready to make frames.
pub struct Renderer {
    // Dropped in this order: commands, what they use, the scene.
    pub(super) recorded: Recorded,
    /// Several runs may go at once.
    pub(super) next_run: Option<NextRun>,
    pub(super) frame: Box<dyn Frame>,
    /// What `numbers` is in device memory, written between runs.
    pub(super) block: RefCell<Buffer>,
    pub(super) numbers: FrameBlock,
    pub(super) runs: Cell<u32>,
    /// What a picture begins with: sums, and how many samples a pixel they are of.
    pub(super) earlier: Option<(Vec<[f32; 4]>, u32)>,
    pub(super) part_recording: PartRecording,
    /// The last frame's, where it was made in parts and has been asked for.
    pub(super) error_of_halves: Cell<Option<f64>>,
    pub(super) scene_gpu: Arc<SceneGpu>,
    pub(super) gpu: Arc<Gpu>,
    pub(super) scene: Arc<Scene>,
    pub(super) bvh: Arc<LazyBvh>,
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
    pub(super) aovs: Vec<String>,
}

impl Renderer {
    /// Makes one frame and waits for it: a picture, in as many runs of what was recorded as the technique takes, or fewer
    /// where its error is small enough before. Ctrl-C ends it after a run, whose number is in `runs`.
    ///
    /// Errors: the device fails, memory for reading the sums back (exit code 4); Ctrl-C in the host's part of a run (130).
    pub fn frame(&self) -> Result<FrameTime> {
        self.gpu.marks.iter().for_each(|marks| marks.begin_frame());
        if let Some(InParts { until_error }) = self.frame.in_parts() {
            return self.frame_in_parts(until_error);
        }
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
        let host = self.begin_run(index)?;
        let time = if self.frame.records_each_run() {
            let mut time = FrameTime { host, ..FrameTime::none(self.passes().len()) };
            self.record_and_run(&mut time, |cmd| self.frame.record(cmd, &self.scene_gpu, &self.block.borrow()))?;
            time
        } else {
            FrameTime { host, ..self.recorded.run_times(times)? }
        };
        self.runs.set(index + times);
        Ok(time)
    }

    /// What comes before the run of this index: the frame's block, and the host's part, with its passes and their nanoseconds.
    pub(super) fn begin_run(&self, index: u32) -> Result<Vec<(String, u64)>> {
        let numbers = self.frame.block_of(index, self.numbers, &self.view);
        let numbers = FrameBlock { sample_index: index, ..numbers };
        // The run before has ended: the device reads the block no more.
        self.block.borrow_mut().mapped_mut().copy_from_slice(bytemuck::bytes_of(&numbers));
        self.frame.begin_run(&Run {
            index,
            frame: &numbers,
            scene: &self.scene,
            bvh: &self.bvh,
            view: &self.view,
            lights: &self.lights,
            gpu: &self.gpu,
            scene_gpu: &self.scene_gpu,
        })
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
        if self.is_in_parts() {
            return self.error_in_parts();
        }
        let count = self.runs.get();
        let sums = if count > 1 { self.sums()? } else { None };
        Ok(sums.map(|sums| noise::relative_error(&sums, count.into())))
    }

    /// Runs that the last frame's picture is made of, and those that it takes at most.
    pub fn runs(&self) -> (u32, u32) {
        (self.runs.get(), self.frame.run_count())
    }

    /// Whether frames are made in parts, each recorded when its turn comes.
    pub fn is_in_parts(&self) -> bool {
        self.frame.in_parts().is_some()
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
        assert!(!self.is_in_parts(), "a frame in parts has no first passes");
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
        let picture = self.picture_as_is()?;
        picture.check().map_err(|error| self.explained(error, &picture))?;
        Ok(picture)
    }

    /// The same, whatever its pixels hold.
    pub(super) fn picture_as_is(&self) -> Result<Picture> {
        let (image, last) = self.frame.picture();
        let bytes = readback::image(&self.gpu, image, last)?;
        let pixels = bytes
            .chunks_exact(16)
            .map(|texel| {
                let channel = |at: usize| f32::from_le_bytes([texel[at], texel[at + 1], texel[at + 2], texel[at + 3]]);
                [channel(0), channel(4), channel(8)]
            })
            .collect();
        Ok(Picture { extent: image.description.extent, pixels })
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
        if self.is_in_parts() {
            counters.insert("runs", self.runs.get().into());
        }
        if let Some(error) = self.estimated_error()? {
            counters.insert("estimated_error", error);
        }
        Ok(counters)
    }

    /// `table`, of this renderer, with what the last frame touched: all of it on a device that counts, elsewhere that of which the frame
    /// keeps count itself.
    ///
    /// Errors: memory for reading counts back (exit code 4).
    pub fn touched(&self, table: MemoryTable) -> Result<MemoryTable> {
        Ok(match &self.gpu.marks {
            Some(marks) => table.with_touched(TouchedReport::of(marks.granule_bytes(), &marks.touches())),
            None => table.touched_as(&self.frame.touched_bytes(&self.gpu)?),
        })
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
