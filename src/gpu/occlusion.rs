//! How many samples draws leave after the tests of depth and stencil, exactly: occlusion queries inside rendering.

use super::Gpu;
use super::failure::failed;
use crate::error::{Error, Result};
use ash::vk;
use std::sync::Arc;

/// A query for each of some draws.
pub struct Occlusion {
    gpu: Arc<Gpu>,
    pool: vk::QueryPool,
    draw_count: u32,
}

impl Occlusion {
    /// Queries for `draw_count` draws, at least one, on a device that has `Ability::PreciseOcclusion`.
    ///
    /// Errors: the driver refuses (exit code 4).
    pub fn new(gpu: &Arc<Gpu>, draw_count: u32) -> Result<Self> {
        assert!(gpu.caps.features.occlusion_query_precise, "a device without precise counts is asked for none");
        let info = vk::QueryPoolCreateInfo::default().query_type(vk::QueryType::OCCLUSION).query_count(draw_count);
        // SAFETY: a live device.
        let pool = unsafe { gpu.device.create_query_pool(&info, None) }
            .map_err(|result| Error::device(format!("creating {draw_count} occlusion queries: {result}")))?;
        gpu.name(pool, "occlusion");
        Ok(Self { gpu: gpu.clone(), pool, draw_count })
    }

    /// Records the reset that must come before the first draw of each frame.
    pub fn reset(&self, buffer: vk::CommandBuffer) {
        // SAFETY: the buffer is being recorded, outside rendering.
        unsafe { self.gpu.device.cmd_reset_query_pool(buffer, self.pool, 0, self.draw_count) };
    }

    /// Counts what `record` records, inside rendering, as draw number `draw`.
    pub fn count(&self, buffer: vk::CommandBuffer, draw: u32, record: impl FnOnce()) {
        let precise = vk::QueryControlFlags::PRECISE;
        // SAFETY: the buffer is being recorded; the query lies in the pool, was reset, and no other of its kind is open.
        unsafe { self.gpu.device.cmd_begin_query(buffer, self.pool, draw, precise) };
        record();
        // SAFETY: begun above, in the same rendering.
        unsafe { self.gpu.device.cmd_end_query(buffer, self.pool, draw) };
    }

    /// Samples of all draws, after the fence of the frame that drew them.
    ///
    /// Errors: the device is lost (exit code 4).
    pub fn sum(&self) -> Result<u64> {
        let mut samples = vec![0u64; self.draw_count as usize];
        let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WAIT;
        // SAFETY: the queries were made by the submit whose fence the caller waited for.
        unsafe { self.gpu.device.get_query_pool_results(self.pool, 0, &mut samples, flags) }
            .map_err(|result| failed("reading occlusion queries", result))?;
        Ok(samples.iter().sum())
    }
}

impl Drop for Occlusion {
    fn drop(&mut self) {
        // SAFETY: the fence of the last frame that used it was waited for.
        unsafe { self.gpu.device.destroy_query_pool(self.pool, None) };
    }
}
