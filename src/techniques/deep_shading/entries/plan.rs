//! What entries need, and how passes touch it.

use super::super::resources::{COLORS, COUNTERS, ORDER, ORDER_BYTES, full};
use super::spans::SPANS;
use super::{sort, spans};
use crate::gpu::Access;
use crate::memory::kinds::Use;
use crate::plan::{Plan, Shape};
use ash::vk::BufferUsageFlags as Flags;

/// Plans the order of as many entries as `samples`, of so many `materials`.
pub fn plan(plan: &mut Plan, samples: u64, materials: usize) {
    plan.buffer("entry_order", full(ORDER), samples * ORDER_BYTES);
    let flags = Flags::STORAGE_BUFFER | Flags::INDIRECT_BUFFER | Flags::TRANSFER_DST;
    let shape = Shape::Buffer { bytes: materials as u64 * spans::BYTES, flags, usage: Use::Device };
    plan.push("entry_order", full(SPANS), shape);
}

/// Plans the sort.
pub fn plan_sort(plan: &mut Plan) {
    let touches = [
        (COLORS, Access::ComputeRead),
        (COUNTERS, Access::ComputeWrite),
        (SPANS, Access::TransferWrite),
        (SPANS, Access::ComputeWrite),
        (ORDER, Access::ComputeWrite),
    ];
    plan.pass(full(sort::PASS), touches.map(|(name, access)| (full(name), access)));
}

/// How a pass over it touches it.
pub fn read() -> [(String, Access); 3] {
    [(ORDER, Access::ComputeRead), (SPANS, Access::ComputeRead), (SPANS, Access::IndirectRead)]
        .map(|(name, access)| (full(name), access))
}
