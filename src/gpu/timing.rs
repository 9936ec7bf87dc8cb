//! Pass times by name: the wall clock of one submit a pass, and the device's timestamps beside it.
//!
//! Which of the two is the figure depends on the device (`Clock`); the other one is a second column, and a disagreement
//! is reported, not hidden.

use super::Gpu;
use super::failure::failed;
use crate::caps::{Caps, Limits};
use crate::error::{Error, Result};
use ash::vk;
use std::sync::Arc;

/// The clock of a time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Clock {
    /// The host's, from a submit to its fence. Lavapipe writes a dispatch's time into the draw before it when both stand in
    /// one command buffer, and a submit costs a processor little.
    Wall,
    /// The device's. A submit and its fence take a GPU tens of microseconds, as long as many a pass.
    Timestamps,
}

impl Clock {
    /// The clock of a device's figures.
    pub fn of(caps: &Caps) -> Self {
        let has_timestamps = caps.limits.timestamp_period_ns > 0.0;
        if has_timestamps && !caps.identity.is_software() { Self::Timestamps } else { Self::Wall }
    }

    /// Reports' word for it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Wall => "wall",
            Self::Timestamps => "timestamps",
        }
    }
}

/// Nanoseconds between two timestamps of a device with these limits. The counter may have gone around once.
pub fn elapsed_ns([begin, end]: [u64; 2], limits: &Limits) -> u64 {
    let bits = limits.timestamp_bits;
    let mask = if bits >= 64 { u64::MAX } else { (1 << bits) - 1 };
    ((end.wrapping_sub(begin) & mask) as f64 * f64::from(limits.timestamp_period_ns)) as u64
}

/// What one pass took in one frame.
#[derive(Clone, Copy, Debug, Default)]
pub struct PassTime {
    /// Submit to fence; None where several passes share a submit.
    pub wall_ns: Option<u64>,
    /// Between the device's timestamps around the pass; None where it writes none.
    pub timestamp_ns: Option<u64>,
}

impl PassTime {
    /// The pass's time by this clock; by the other one where this one did not run.
    pub fn figure_ns(&self, clock: Clock) -> Option<u64> {
        match clock {
            Clock::Wall => self.wall_ns,
            Clock::Timestamps => self.timestamp_ns.or(self.wall_ns),
        }
    }
}

/// Two timestamps a pass.
pub struct Timestamps {
    gpu: Arc<Gpu>,
    pool: vk::QueryPool,
    pass_count: u32,
}

impl Timestamps {
    /// None where the queue writes no timestamps.
    pub fn new(gpu: &Arc<Gpu>, pass_count: u32) -> Result<Option<Self>> {
        if gpu.caps.limits.timestamp_period_ns == 0.0 || pass_count == 0 {
            return Ok(None);
        }
        let info = vk::QueryPoolCreateInfo::default().query_type(vk::QueryType::TIMESTAMP).query_count(2 * pass_count);
        // SAFETY: a live device.
        let pool = unsafe { gpu.device.create_query_pool(&info, None) }
            .map_err(|result| Error::device(format!("creating {} timestamps: {result}", 2 * pass_count)))?;
        gpu.name(pool, "timestamps");
        Ok(Some(Self { gpu: gpu.clone(), pool, pass_count }))
    }

    /// Records the reset that must come before the first write of each frame.
    pub fn reset(&self, buffer: vk::CommandBuffer) {
        // SAFETY: the buffer is being recorded, outside rendering.
        unsafe { self.gpu.device.cmd_reset_query_pool(buffer, self.pool, 0, 2 * self.pass_count) };
    }

    /// Records the timestamp that opens (`end` false) or closes a pass.
    pub fn write(&self, buffer: vk::CommandBuffer, pass: u32, end: bool) {
        let query = 2 * pass + u32::from(end);
        let stage = vk::PipelineStageFlags2::ALL_COMMANDS;
        // SAFETY: the buffer is being recorded and the query lies in the pool.
        unsafe { self.gpu.device.cmd_write_timestamp2(buffer, stage, self.pool, query) };
    }

    /// The device's count at the beginning and the end of each of the first `pass_count` passes, one after the other,
    /// after the fence of the frame that wrote them.
    pub fn ticks(&self, pass_count: usize) -> Result<Vec<u64>> {
        let mut ticks = vec![0u64; 2 * pass_count];
        let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WAIT;
        // SAFETY: the queries were written by the submit whose fence the caller waited for.
        unsafe { self.gpu.device.get_query_pool_results(self.pool, 0, &mut ticks, flags) }
            .map_err(|result| failed("reading timestamps", result))?;
        Ok(ticks)
    }

    /// The times of the first `pass_count` passes, at least one, after the fence of the frame that wrote them.
    pub fn read_first(&self, pass_count: usize) -> Result<DeviceTimes> {
        let ticks = self.ticks(pass_count)?;
        let elapsed = |begin, end| elapsed_ns([begin, end], &self.gpu.caps.limits);
        let passes = ticks.chunks_exact(2).map(|pair| elapsed(pair[0], pair[1])).collect();
        Ok(DeviceTimes { passes, all_ns: elapsed(ticks[0], ticks[ticks.len() - 1]) })
    }
}

/// Times by the device's clock, nanoseconds.
pub struct DeviceTimes {
    pub passes: Vec<u64>,
    /// From the first pass's beginning to the last one's end.
    pub all_ns: u64,
}

impl Drop for Timestamps {
    fn drop(&mut self) {
        // SAFETY: the fence of the last frame that used it was waited for.
        unsafe { self.gpu.device.destroy_query_pool(self.pool, None) };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::caps::known;

    #[test]
    fn a_clock_that_goes_around_goes_on() {
        let mut limits = known::caps(known::DEFAULT).unwrap().limits;
        for (ticks, bits, period_ns, expected) in [
            ([100, 350], 64, 2.0, 500),
            // What stands above the bits that count is noise.
            ([0xabc0_0000_0000_0064, 0x0120_0000_0000_015e], 36, 1.0, 250),
            ([(1 << 36) - 10, 5], 36, 10.0, 150),
            ([u64::MAX - 9, 5], 64, 1.0, 15),
        ] {
            (limits.timestamp_bits, limits.timestamp_period_ns) = (bits, period_ns);
            assert_eq!(elapsed_ns(ticks, &limits), expected, "{ticks:x?} of {bits} bits");
        }
    }

    #[test]
    fn figures_of_a_gpu_are_its_timestamps_where_it_has_any() {
        let mut caps = known::caps(known::DEFAULT).unwrap();
        assert_eq!(Clock::of(&caps), Clock::Wall);
        caps.identity.device_type = "discrete-gpu".to_owned();
        assert_eq!(Clock::of(&caps), Clock::Timestamps);
        caps.limits.timestamp_period_ns = 0.0;
        assert_eq!(Clock::of(&caps), Clock::Wall);
        let time = PassTime { wall_ns: Some(90_000), timestamp_ns: Some(20_000) };
        assert_eq!([Clock::Wall, Clock::Timestamps].map(|clock| time.figure_ns(clock)), [Some(90_000), Some(20_000)]);
        let unstamped = PassTime { timestamp_ns: None, ..time };
        assert_eq!(unstamped.figure_ns(Clock::Timestamps), Some(90_000));
    }
}
