//! A recorded frame, run again and again: whole, or from its start through a pass.
//!
//! A pass alone is not run again. Its barriers begin where the pass before it left off (image layouts, and bytes that
//! aliased resources share), which is only true inside a frame. A frame's start assumes nothing, so any beginning of a
//! frame can be repeated.

use super::bands::Estimates;
use super::commands::{Commands, RecordedPass, Submits};
use super::failure::failed;
use super::statistics::PassStatistics;
use super::timing::{Clock, PassTime};
use crate::error::{Error, Result};
use ash::vk;
use std::cell::RefCell;
use std::time::Instant;

/// A frame that can be run again and again.
pub struct Recorded {
    commands: Commands,
    fence: vk::Fence,
    /// None: its submits take what they take.
    estimates: Option<RefCell<Estimates>>,
}

/// What one run of a frame took, and what the device counted in it.
pub struct FrameTime {
    /// What the host did before the first submit, pass by pass: name and nanoseconds.
    pub host: Vec<(String, u64)>,
    /// First submit to last fence.
    pub wall_ns: u64,
    /// By the device's clock, where it has one that is read: from the first pass's beginning to the last one's end in
    /// one submit, else the sum of its passes.
    pub device_ns: Option<u64>,
    /// Times of the passes that ran, in the order of `Recorded::passes`.
    pub passes: Vec<PassTime>,
    /// Statistics of the same passes; empty where none were asked for.
    pub statistics: Vec<PassStatistics>,
}

impl FrameTime {
    /// The frame's time: what the host did before, and then the device by this clock; by the host's where the device has
    /// none.
    pub fn figure_ns(&self, clock: Clock) -> u64 {
        let host_ns: u64 = self.host.iter().map(|(_, ns)| ns).sum();
        host_ns
            + match clock {
                Clock::Wall => self.wall_ns,
                Clock::Timestamps => self.device_ns.unwrap_or(self.wall_ns),
            }
    }

    /// Another run of the same frame, which makes the same picture with it. Statistics become its own, as counters are
    /// those of the last run.
    pub fn add(&mut self, mut run: Self) {
        self.add_host(std::mem::take(&mut run.host));
        let all: Vec<usize> = (0..run.passes.len()).collect();
        self.add_part(run, &all);
    }

    /// Nothing yet of a frame of `pass_count` passes, to which its parts are added.
    pub fn none(pass_count: usize) -> Self {
        let passes = vec![PassTime::default(); pass_count];
        Self { host: Vec::new(), wall_ns: 0, device_ns: Some(0), passes, statistics: Vec::new() }
    }

    /// What the host did before a part of the frame.
    pub fn add_host(&mut self, passes: Vec<(String, u64)>) {
        for (name, ns) in passes {
            match self.host.iter_mut().find(|(known, _)| *known == name) {
                Some((_, total)) => *total += ns,
                None => self.host.push((name, ns)),
            }
        }
    }

    /// A part of the frame, whose passes are those of the frame at `places`. Statistics become its own, pass by pass.
    pub fn add_part(&mut self, part: Self, places: &[usize]) {
        let sum = |total: &mut Option<u64>, more: Option<u64>| {
            if let Some(more) = more {
                *total = Some(total.unwrap_or_default() + more);
            }
        };
        self.wall_ns += part.wall_ns;
        self.device_ns = self.device_ns.zip(part.device_ns).map(|(total, more)| total + more);
        for (place, time) in places.iter().zip(part.passes) {
            sum(&mut self.passes[*place].wall_ns, time.wall_ns);
            sum(&mut self.passes[*place].timestamp_ns, time.timestamp_ns);
        }
        if !part.statistics.is_empty() {
            self.statistics.resize(self.passes.len(), PassStatistics::default());
            places.iter().zip(part.statistics).for_each(|(place, counts)| self.statistics[*place] = counts);
        }
    }
}

impl Commands {
    /// Ends recording.
    pub fn finish(self) -> Result<Recorded> {
        self.end_buffer()?;
        // SAFETY: a live device.
        let fence = unsafe { self.gpu.device.create_fence(&vk::FenceCreateInfo::default(), None) }
            .map_err(|result| Error::device(format!("creating a fence: {result}")))?;
        self.gpu.name(fence, &self.name);
        Ok(Recorded::new(self, fence))
    }
}

impl Recorded {
    /// `commands` are ended; the fence is unsignalled and theirs alone.
    fn new(commands: Commands, fence: vk::Fence) -> Self {
        let estimates = commands.limit.map(|limit| RefCell::new(Estimates::new(limit, commands.pieces.len())));
        Self { commands, fence, estimates }
    }

    pub fn passes(&self) -> &[RecordedPass] {
        &self.commands.passes
    }

    /// The clock of the times of its runs.
    pub fn clock(&self) -> Clock {
        Clock::of(&self.commands.gpu.caps)
    }

    /// Submits the frame and waits for it.
    ///
    /// Errors: the device is lost or out of memory (exit code 4).
    pub fn run(&self) -> Result<FrameTime> {
        let commands = &self.commands;
        self.run_pieces(commands.pieces.len(), commands.passes.len())
    }

    /// The device's count at the beginning and the end of each pass of the last whole run, one after the other; None where it wrote
    /// none.
    ///
    /// Errors: they cannot be read (exit code 4).
    pub fn ticks(&self) -> Result<Option<Vec<u64>>> {
        let commands = &self.commands;
        commands.timestamps.as_ref().map(|timestamps| timestamps.ticks(commands.passes.len())).transpose()
    }

    /// How many runs of the frame fit into one submit, by what they took before.
    pub fn runs_of_submit(&self) -> u32 {
        self.estimates.as_ref().map_or(1, |estimates| estimates.borrow().runs_of_submit())
    }

    /// Submits the frame so many times at once, as `runs_of_submit` allows, and waits; what is recorded makes each run's end ready for
    /// the next one. Times are of all runs, those of the device by the last of them; statistics are of the last.
    ///
    /// Errors: as `run`.
    pub fn run_times(&self, times: u32) -> Result<FrameTime> {
        let commands = &self.commands;
        if times == 1 {
            return self.run();
        }
        assert!(commands.submits == Submits::One, "a frame with a submit a pass runs once at a time");
        let started = Instant::now();
        self.submit((0..times).flat_map(|_| 0..commands.pieces.len()))?;
        let took = started.elapsed();
        if let Some(estimates) = &self.estimates {
            estimates.borrow_mut().learn(0..commands.pieces.len(), took / times);
        }
        let mut time = self.times(Vec::new(), took.as_nanos() as u64, commands.passes.len())?;
        let all_of = |ns: &mut Option<u64>| *ns = ns.map(|ns| ns * u64::from(times));
        all_of(&mut time.device_ns);
        time.passes.iter_mut().for_each(|pass| all_of(&mut pass.timestamp_ns));
        Ok(time)
    }

    /// Runs the first `pass_count` passes, at least one, of a frame that was recorded with a submit a pass; what later
    /// passes write is then of an older frame, or of none.
    ///
    /// Errors: the device is lost or out of memory (exit code 4).
    pub fn run_first(&self, pass_count: usize) -> Result<FrameTime> {
        let commands = &self.commands;
        assert!(commands.submits == Submits::PerPass, "only a frame with a submit a pass can stop between passes");
        assert!((1..=commands.passes.len()).contains(&pass_count), "{pass_count} of {} passes", commands.passes.len());
        let end = commands.pieces.iter().position(|piece| piece.pass == pass_count);
        self.run_pieces(end.unwrap_or(commands.pieces.len()), pass_count)
    }

    fn run_pieces(&self, piece_count: usize, pass_count: usize) -> Result<FrameTime> {
        let commands = &self.commands;
        let started = Instant::now();
        let mut walls = vec![0; pass_count.max(1)];
        let mut first = 0;
        while first < piece_count {
            let end = self.end_of_submit(first, piece_count);
            let submitted = Instant::now();
            self.submit(first..end)?;
            let took = submitted.elapsed();
            self.collect(commands.pieces[first].pass);
            walls[commands.pieces[first].pass] += took.as_nanos() as u64;
            if let Some(estimates) = &self.estimates {
                estimates.borrow_mut().learn(first..end, took);
            }
            first = end;
        }
        self.times(walls, started.elapsed().as_nanos() as u64, pass_count)
    }

    /// What a pass touched that has just ended.
    fn collect(&self, pass: usize) {
        if let (Some(marks), Some(ended)) = (&self.commands.gpu.marks, self.commands.passes.get(pass)) {
            marks.collect(&ended.name);
            self.commands.notes.add_to(marks, pass, &ended.name);
        }
    }

    /// What a run took that has just ended. `walls`: of its passes, where each had submits of its own.
    fn times(&self, walls: Vec<u64>, wall_ns: u64, pass_count: usize) -> Result<FrameTime> {
        let commands = &self.commands;
        let timestamps = match &commands.timestamps {
            Some(timestamps) if pass_count > 0 => Some(timestamps.read_first(pass_count)?),
            _ => None,
        };
        let is_per_pass = commands.submits == Submits::PerPass;
        let passes = (0..pass_count)
            .map(|pass| PassTime {
                wall_ns: is_per_pass.then(|| walls[pass]),
                timestamp_ns: timestamps.as_ref().map(|times| times.passes[pass]),
            })
            .collect();
        // Between submits the device waits for the host.
        let device_ns = timestamps.map(|times| if is_per_pass { times.passes.iter().sum() } else { times.all_ns });
        let statistics = match &commands.statistics {
            Some(statistics) => statistics.read_first(pass_count)?,
            None => Vec::new(),
        };
        Ok(FrameTime { host: Vec::new(), wall_ns, device_ns, passes, statistics })
    }

    /// Where a submit ends that begins with the piece `first`.
    fn end_of_submit(&self, first: usize, end: usize) -> usize {
        let Commands { pieces, submits, .. } = &self.commands;
        let pass = pieces[first].pass;
        let end = match submits {
            Submits::One => end,
            Submits::PerPass => (first..end).find(|piece| pieces[*piece].pass != pass).unwrap_or(end),
        };
        self.estimates.as_ref().map_or(end, |estimates| estimates.borrow().end_of_submit(first, end))
    }

    fn submit(&self, pieces: impl Iterator<Item = usize>) -> Result<()> {
        let gpu = &self.commands.gpu;
        let fail = |result| match self.commands.passes.is_empty() {
            true => failed(&format!("running commands ({})", self.commands.name), result),
            false => failed(&format!("running a frame of {}", self.commands.name), result),
        };
        let buffers = pieces.map(|piece| self.commands.pieces[piece].buffer);
        let infos: Vec<_> =
            buffers.map(|buffer| vk::CommandBufferSubmitInfo::default().command_buffer(buffer)).collect();
        let submit = vk::SubmitInfo2::default().command_buffer_infos(&infos);
        let _one_at_a_time = gpu.submit_lock.lock().unwrap_or_else(|poisoned| poisoned.into_inner());
        // SAFETY: the buffers are recorded and not running; the queue is locked; the fence is unsignalled.
        unsafe {
            gpu.device.queue_submit2(gpu.queue, &[submit], self.fence).map_err(fail)?;
            gpu.device.wait_for_fences(&[self.fence], true, u64::MAX).map_err(|result| {
                // What the work uses is given back next: none of it may still run. A lost device runs nothing.
                let _ = gpu.device.device_wait_idle();
                fail(result)
            })?;
            gpu.device.reset_fences(&[self.fence]).map_err(fail)
        }
    }
}

impl Drop for Recorded {
    fn drop(&mut self) {
        // SAFETY: `submit` waited for it.
        unsafe { self.commands.gpu.device.destroy_fence(self.fence, None) };
    }
}
