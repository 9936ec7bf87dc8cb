//! Recording the build of an acceleration structure.

use super::structure::SCRATCH_ALIGNMENT_BYTES;
use super::{Buffer, Commands, Structure};
use ash::vk;

impl Commands {
    /// Builds `target` from what lies in `input` from byte `offset` on, with notes in `scratch`, as long as `Over::sizes` says.
    pub fn build_structure(&mut self, target: &Structure, (input, offset): (&Buffer, u64), scratch: &Buffer) {
        let gpu = self.gpu().clone();
        let geometries = [target.over.geometry(input.address() + offset)];
        let notes = scratch.address().next_multiple_of(SCRATCH_ALIGNMENT_BYTES);
        let info = target
            .over
            .build_info(&geometries)
            .dst_acceleration_structure(target.handle)
            .scratch_data(vk::DeviceOrHostAddressKHR { device_address: notes });
        let ranges = [vk::AccelerationStructureBuildRangeInfoKHR::default().primitive_count(target.over.count())];
        // SAFETY: the buffer is being recorded, outside rendering; addresses are of live buffers, made for this use and long
        // enough; the caller stated the barriers.
        unsafe {
            gpu.structures().cmd_build_acceleration_structures(self.buffer(), &[info], &[&ranges]);
        }
    }
}
