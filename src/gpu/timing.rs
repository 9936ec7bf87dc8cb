//! Pass times by name: the wall clock of one submit a pass, and the device's timestamps beside it.
//!
//! Lavapipe writes a dispatch's time into the draw before it when both stand in one command buffer, so the wall clock of
//! a submit with a fence is the figure and the timestamp a second column; a disagreement is reported, not hidden.

use super::Gpu;
use super::failure::failed;
use crate::error::{Error, Result};
use ash::vk;
use std::sync::Arc;

/// What one pass took in one frame.
#[derive(Clone, Copy, Debug, Default)]
pub struct PassTime {
    /// Submit to fence; None where several passes share a submit.
    pub wall_ns: Option<u64>,
    /// Between the device's timestamps around the pass; None where it writes none.
    pub timestamp_ns: Option<u64>,
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

    /// Nanoseconds of each of the first `pass_count` passes, after the fence of the frame that wrote them.
    pub fn read_first(&self, pass_count: usize) -> Result<Vec<u64>> {
        let mut ticks = vec![0u64; 2 * pass_count];
        let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WAIT;
        // SAFETY: the queries were written by the submit whose fence the caller waited for.
        unsafe { self.gpu.device.get_query_pool_results(self.pool, 0, &mut ticks, flags) }
            .map_err(|result| failed("reading timestamps", result))?;
        let period = f64::from(self.gpu.caps.limits.timestamp_period_ns);
        Ok(ticks.chunks_exact(2).map(|pair| (pair[1].saturating_sub(pair[0]) as f64 * period) as u64).collect())
    }
}

impl Drop for Timestamps {
    fn drop(&mut self) {
        // SAFETY: the fence of the last frame that used it was waited for.
        unsafe { self.gpu.device.destroy_query_pool(self.pool, None) };
    }
}
