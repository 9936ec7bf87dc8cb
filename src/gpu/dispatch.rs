//! Dispatches of compute shaders, one, in bands, or of as many workgroups as the device has written.

use super::bands;
use super::marks::shape::Part;
use super::pipeline::ComputePipeline;
use super::{Bound, Buffer, Commands};
use crate::error::{Error, Result};
use ash::vk;

/// What a dispatch reads that the device has written the workgroups of.
const GROUPS_BYTES: u64 = 12;

/// One of several dispatches that a pass is made of.
pub struct DispatchPart<'a> {
    pub params: &'a [u8],
    /// Set 1.
    pub foreign: vk::DescriptorSet,
    /// Bytes from the buffer's beginning to its workgroups' numbers.
    pub offset: u64,
}

impl Commands {
    /// Binds and dispatches `groups` workgroups.
    pub fn dispatch(
        &mut self,
        pipeline: &ComputePipeline,
        params: &[u8],
        bound: &[(&str, Bound<'_>)],
        groups: [u32; 3],
    ) -> Result<()> {
        let limit = self.gpu.caps.limits.max_workgroup_count;
        if (0..3).any(|axis| groups[axis] > limit[axis]) {
            let label = &pipeline.interface.label;
            return Err(Error::request(format!("{label}: {groups:?} workgroups: this device allows {limit:?}")));
        }
        let set = self.descriptors.set(&pipeline.interface, bound)?;
        if self.limit.is_none() || self.statistics.is_some() {
            self.bind_compute(pipeline, params, set);
            // SAFETY: pipeline, descriptors and params are bound; the caller stated the barriers.
            unsafe { self.gpu.device.cmd_dispatch(self.buffer(), groups[0], groups[1], groups[2]) };
            return Ok(());
        }
        for ([x, y, z], [width, height, depth]) in bands::bands(groups) {
            if [x, y, z] != [0; 3] {
                self.next_band()?;
            }
            self.bind_compute(pipeline, params, set);
            // SAFETY: as above; the band lies in the dispatch, whose pipeline was made for bases.
            unsafe { self.gpu.device.cmd_dispatch_base(self.buffer(), x, y, z, width, height, depth) };
        }
        Ok(())
    }

    /// Binds and dispatches as many workgroups as the device has written at the beginning of `groups`, whose last access
    /// was `IndirectRead`. It is one submit whatever `Recording::limit` says: only the device knows what it could be cut
    /// into.
    pub fn dispatch_indirect(
        &mut self,
        pipeline: &ComputePipeline,
        params: &[u8],
        bound: &[(&str, Bound<'_>)],
        groups: &Buffer,
    ) -> Result<()> {
        let set = self.descriptors.set(&pipeline.interface, bound)?;
        self.bind_compute(pipeline, params, set);
        // SAFETY: pipeline, descriptors and params are bound; the caller stated the barriers, and the buffer's shader keeps
        // the numbers within the limits that every device has.
        unsafe { self.gpu.device.cmd_dispatch_indirect(self.buffer(), groups.handle, 0) };
        self.note(&groups.marked, false, Part::Bytes(0..GROUPS_BYTES));
        Ok(())
    }

    /// Dispatches once for each of `parts`, as many workgroups as the device has written for it in `groups`, whose last access
    /// was `IndirectRead`. Each part is a piece of a frame that `Recording::limit` cuts.
    pub fn dispatch_parts<'a>(
        &mut self,
        pipeline: &ComputePipeline,
        bound: &[(&str, Bound<'_>)],
        groups: &Buffer,
        parts: impl IntoIterator<Item = DispatchPart<'a>>,
    ) -> Result<()> {
        let set = self.descriptors.set(&pipeline.interface, bound)?;
        let is_cut = self.limit.is_some() && self.statistics.is_none();
        for (index, DispatchPart { params, foreign, offset }) in parts.into_iter().enumerate() {
            if is_cut && index > 0 {
                self.next_band()?;
            }
            self.bind_compute(pipeline, params, set);
            self.note(&groups.marked, false, Part::Bytes(offset..offset + GROUPS_BYTES));
            let (device, layout) = (&self.gpu.device, pipeline.interface.layout);
            // SAFETY: pipeline, descriptors and params are bound, set 1 has the layout that the pipeline was made with; the caller
            // stated the barriers, and the buffer's shader keeps the numbers within the limits that every device has.
            unsafe {
                let point = vk::PipelineBindPoint::COMPUTE;
                device.cmd_bind_descriptor_sets(self.buffer(), point, layout, 1, &[foreign], &[]);
                device.cmd_dispatch_indirect(self.buffer(), groups.handle, offset);
            }
        }
        Ok(())
    }

    /// Binds what a dispatch needs: again in every command buffer.
    fn bind_compute(&mut self, pipeline: &ComputePipeline, params: &[u8], set: Option<vk::DescriptorSet>) {
        let point = vk::PipelineBindPoint::COMPUTE;
        // SAFETY: the buffer is being recorded and the pipeline outlives the recorded frame.
        unsafe { self.gpu.device.cmd_bind_pipeline(self.buffer(), point, pipeline.handle()) };
        self.bind_set(point, &pipeline.interface, set);
        self.push(&pipeline.interface, params);
    }
}
