//! Frames in parts (`techniques::parts`): each run recorded when its turn comes, and a picture at the end.

use super::part_recording::PartRecording;
use super::renderer::Renderer;
use crate::error::{Error, Result};
use crate::gpu::Commands;
use crate::gpu::commands::RecordedPass;
use crate::gpu::recorded::FrameTime;
use crate::interrupt;
use crate::metrics::noise;
use crate::progress::Stage;
use crate::techniques::parts::{Part, Runs, halves};
use std::time::Instant;

impl Renderer {
    /// `Renderer::frame` of a technique that makes frames in parts: runs until they are all, or until their picture's estimated error
    /// is at most `until_error`, and then the picture.
    pub(super) fn frame_in_parts(&self, until_error: Option<f64>) -> Result<FrameTime> {
        let (stage, all) = (Stage::counted("rendering", "runs"), self.frame.run_count());
        let mut total = FrameTime::none(self.passes().len());
        let mut expected = all;
        for run in 0..all {
            self.error_of_halves.set(None);
            total.add_host(self.begin_run(run)?);
            self.run_part(Part::Samples { run }, &mut total)?;
            let done = run + 1;
            self.runs.set(done);
            stage.reach(done.into(), expected.into());
            if let Some(most) = until_error.filter(|_| done < all && noise::is_checked_in_halves(done.into())) {
                let error = self.compare_halves(&mut total)?;
                // NaN and infinity stay: reading the picture says where.
                if error <= most || !error.is_finite() {
                    break;
                }
                expected = noise::samples_for(most, done.into(), error).min(all.into()) as u32;
            }
            if interrupt::check().is_err() {
                break;
            }
        }
        self.run_picture(Runs::All, &mut total)?;
        Ok(total)
    }

    /// The estimated error of the last frame's picture, which stays as it is; None where it is of one run.
    pub(super) fn error_in_parts(&self) -> Result<Option<f64>> {
        if self.runs.get() < 2 {
            return Ok(None);
        }
        if self.error_of_halves.get().is_none() {
            let mut untimed = FrameTime::none(self.passes().len());
            self.compare_halves(&mut untimed)?;
            self.run_picture(Runs::All, &mut untimed)?;
        }
        Ok(self.error_of_halves.get())
    }

    /// Makes the pictures of even and of odd runs, and says how far that of all is from what it tends to.
    fn compare_halves(&self, total: &mut FrameTime) -> Result<f64> {
        let mut read_ns = 0;
        let mut pixels = |of| {
            self.run_picture(of, total)?;
            let began = Instant::now();
            let pixels = self.picture_as_is()?.pixels;
            read_ns += began.elapsed().as_nanos() as u64;
            Ok::<_, Error>(pixels)
        };
        let [even, odd] = [pixels(Runs::Even)?, pixels(Runs::Odd)?];
        let began = Instant::now();
        let error = noise::error_of_halves([&even, &odd], halves(self.runs.get()));
        let compare_ns = read_ns + began.elapsed().as_nanos() as u64;
        total.add_host(vec![(format!("{}.compare", self.part_recording.name), compare_ns)]);
        self.error_of_halves.set(Some(error));
        Ok(error)
    }

    fn run_picture(&self, of: Runs, total: &mut FrameTime) -> Result<()> {
        self.run_part(Part::Picture { of, run_count: self.runs.get() }, total)
    }

    /// Records and runs a part, and adds what that took to `total`.
    fn run_part(&self, part: Part, total: &mut FrameTime) -> Result<()> {
        self.record_and_run(total, |cmd| self.frame.record_part(cmd, &self.scene_gpu, &self.block.borrow(), part))
    }

    /// Runs what is recorded now, some of a frame's passes, and adds what both took to `total`.
    pub(super) fn record_and_run(
        &self,
        total: &mut FrameTime,
        record: impl FnOnce(&mut Commands) -> Result<()>,
    ) -> Result<()> {
        let began = Instant::now();
        let PartRecording { name, recording, heirs } = &self.part_recording;
        let mut cmd = Commands::begin(&self.gpu, name, *recording)?;
        cmd.set_heirs(heirs.clone());
        record(&mut cmd)?;
        let recorded = cmd.finish()?;
        let record_ns = began.elapsed().as_nanos() as u64;
        let places = self.places(recorded.passes());
        let time = recorded.run()?;
        total.add_host(vec![(format!("{name}.record"), record_ns)]);
        total.add_part(time, &places);
        Ok(())
    }

    /// Where a part's passes stand among those of a frame: in their order.
    fn places(&self, passes: &[RecordedPass]) -> Vec<usize> {
        let place = |pass: &RecordedPass| self.passes().iter().position(|known| known.name == pass.name);
        passes.iter().map(|pass| place(pass).unwrap_or_else(|| panic!("{} is no pass of a frame", pass.name))).collect()
    }
}
