//! Allocators of others as players (`--features rivals`): gpu-allocator and VulkanMemoryAllocator with a device's memory
//! behind them, and without a device the latter's ranges in memory blocks of ours.
//!
//! Each is measured as it comes, and with memory blocks as large as ours become. What has a memory block of its own here
//! (`alone`) has one of VulkanMemoryAllocator too; gpu-allocator gives one to named buffers and images alone, and places it
//! with the others.

use super::contender::{Contender, Place};
use super::ours::Numbers;
use super::play::{Accounted, Player, State};
use crate::caps::Caps;
use crate::error::{Error, Result};
use crate::gpu::Gpu;
use crate::gpu::device::API;
use crate::memory::pool::{Ask, Rules, SHARED_BLOCK_BYTES};
use crate::memory::suballocate::Suballocate;
use crate::memory::{Strategy, Tiling};
use crate::units::Bytes;
use ash::vk;
use gpu_allocator::vulkan::{
    self as gpu_allocator_vulkan, AllocationCreateDesc, AllocationScheme, AllocatorCreateDesc,
};
use gpu_allocator::{AllocationSizes, AllocatorDebugSettings, MemoryLocation};
use std::collections::BTreeMap;
use vk_mem::Alloc;

/// All rivals that the place allows.
///
/// Errors: one cannot be made (exit code 4).
pub fn contenders(place: &Place<'_>, caps: &Caps, slots: usize) -> Result<Vec<Contender>> {
    let Place::Device(gpu) = place else {
        let rules = || Rules::new(caps, Strategy::Tlsf, None, None).cut_by(|bytes| Box::new(Virtual::new(bytes)));
        return Ok(vec![Contender {
            allocator: "vma",
            variant: "ranges in blocks of ours".to_owned(),
            accounted: Box::new(Numbers::new(rules(), slots)),
            timed: Box::new(Numbers::new(rules(), slots)),
        }]);
    };
    let mut all = Vec::new();
    for block_bytes in [None, Some(SHARED_BLOCK_BYTES)] {
        let variant =
            block_bytes.map_or_else(|| "as it comes".to_owned(), |bytes| format!("blocks of {}", Bytes(bytes)));
        all.push(Contender {
            allocator: "gpu-allocator",
            variant: variant.clone(),
            accounted: Box::new(GpuAllocator::new(gpu, block_bytes, slots)?),
            timed: Box::new(GpuAllocator::new(gpu, block_bytes, slots)?),
        });
        all.push(Contender {
            allocator: "vma",
            variant,
            accounted: Box::new(Vma::new(gpu, block_bytes, slots)?),
            timed: Box::new(Vma::new(gpu, block_bytes, slots)?),
        });
    }
    Ok(all)
}

/// The longest gap between ranges, offset and bytes in the order of their offsets, of a block.
fn largest_gap(block_bytes: u64, ranges: impl Iterator<Item = (u64, u64)>) -> u64 {
    let (end, largest) =
        ranges.fold((0, 0), |(end, largest): (u64, u64), (offset, bytes)| (offset + bytes, largest.max(offset - end)));
    largest.max(block_bytes - end)
}

struct GpuAllocator {
    live: Vec<Option<gpu_allocator_vulkan::Allocation>>,
    allocator: gpu_allocator_vulkan::Allocator,
}

impl GpuAllocator {
    fn new(gpu: &Gpu, block_bytes: Option<u64>, slots: usize) -> Result<Self> {
        let (instance, physical_device) = gpu.chosen();
        let allocator = gpu_allocator_vulkan::Allocator::new(&AllocatorCreateDesc {
            instance: instance.clone(),
            device: gpu.device.clone(),
            physical_device,
            debug_settings: AllocatorDebugSettings::default(),
            buffer_device_address: true,
            allocation_sizes: block_bytes
                .map_or_else(AllocationSizes::default, |bytes| AllocationSizes::new(bytes, bytes)),
        });
        let allocator = allocator.map_err(|error| Error::device(format!("gpu-allocator: {error}")))?;
        Ok(Self { live: (0..slots).map(|_| None).collect(), allocator })
    }
}

impl Player for GpuAllocator {
    fn take(&mut self, slot: usize, ask: &Ask) -> std::result::Result<(), String> {
        let requirements =
            vk::MemoryRequirements { size: ask.bytes, alignment: ask.alignment, memory_type_bits: 1 << ask.type_index };
        let allocated = self.allocator.allocate(&AllocationCreateDesc {
            name: "bench.allocate",
            requirements,
            // The memory type is the trace's.
            location: MemoryLocation::Unknown,
            linear: ask.tiling == Tiling::Linear,
            allocation_scheme: AllocationScheme::GpuAllocatorManaged,
        });
        self.live[slot] = Some(allocated.map_err(|error| error.to_string())?);
        Ok(())
    }

    fn give(&mut self, slot: usize) {
        let allocation = self.live[slot].take().expect("a script gives what it took");
        self.allocator.free(allocation).expect("it was allocated there");
    }
}

impl Accounted for GpuAllocator {
    fn held_bytes(&self) -> u64 {
        self.allocator.capacity()
    }

    fn state(&self, live_bytes: u64) -> State {
        let report = self.allocator.generate_report();
        let gap = |block: &gpu_allocator::MemoryBlockReport| {
            let mut ranges: Vec<_> =
                report.allocations[block.allocations.clone()].iter().map(|one| (one.offset, one.size)).collect();
            ranges.sort_unstable();
            largest_gap(block.size, ranges.into_iter())
        };
        State {
            memory_blocks: report.blocks.len() as u64,
            bytes: report.total_capacity_bytes,
            free_bytes: report.total_capacity_bytes - live_bytes,
            largest_free_bytes: report.blocks.iter().map(gap).max().unwrap_or(0),
            padding_bytes: report.total_allocated_bytes - live_bytes,
            ..State::default()
        }
    }
}

struct Vma {
    live: Vec<Option<vk_mem::Allocation>>,
    allocator: vk_mem::Allocator,
}

impl Vma {
    fn new(gpu: &Gpu, block_bytes: Option<u64>, slots: usize) -> Result<Self> {
        let (instance, physical) = gpu.chosen();
        let mut info = vk_mem::AllocatorCreateInfo::new(instance, &gpu.device, physical);
        info.flags = vk_mem::AllocatorCreateFlags::BUFFER_DEVICE_ADDRESS;
        info.vulkan_api_version = API;
        info.preferred_large_heap_block_size = block_bytes.unwrap_or(0);
        // SAFETY: the device outlives what is measured on it.
        let allocator = unsafe { vk_mem::Allocator::new(info) };
        let allocator = allocator.map_err(|result| Error::device(format!("VulkanMemoryAllocator: {result}")))?;
        Ok(Self { live: vec![None; slots], allocator })
    }
}

impl Player for Vma {
    fn take(&mut self, slot: usize, ask: &Ask) -> std::result::Result<(), String> {
        let requirements =
            vk::MemoryRequirements { size: ask.bytes, alignment: ask.alignment, memory_type_bits: 1 << ask.type_index };
        let mut flags = vk_mem::AllocationCreateFlags::empty();
        if ask.mapped {
            flags |= vk_mem::AllocationCreateFlags::MAPPED;
        }
        if ask.alone {
            flags |= vk_mem::AllocationCreateFlags::DEDICATED_MEMORY;
        }
        let info = vk_mem::AllocationCreateInfo { flags, ..vk_mem::AllocationCreateInfo::default() };
        // SAFETY: the requirements are those of a resource; no handle is part of the request.
        let allocated = unsafe { self.allocator.allocate_memory(&requirements, &info) };
        self.live[slot] = Some(allocated.map_err(|result| result.to_string())?);
        Ok(())
    }

    fn give(&mut self, slot: usize) {
        let mut allocation = self.live[slot].take().expect("a script gives what it took");
        // SAFETY: it came from this allocator, and nothing uses it.
        unsafe { self.allocator.free_memory(&mut allocation) };
    }
}

impl Drop for Vma {
    fn drop(&mut self) {
        for mut allocation in self.live.iter_mut().filter_map(Option::take) {
            // SAFETY: as in `give`.
            unsafe { self.allocator.free_memory(&mut allocation) };
        }
    }
}

impl Accounted for Vma {
    fn held_bytes(&self) -> u64 {
        let budgets = self.allocator.get_heap_budgets().expect("the device is there");
        budgets.iter().map(|budget| budget.statistics.blockBytes).sum()
    }

    fn state(&self, live_bytes: u64) -> State {
        let total = self.allocator.calculate_statistics().expect("the device is there").total;
        State {
            memory_blocks: u64::from(total.statistics.blockCount),
            bytes: total.statistics.blockBytes,
            free_bytes: total.statistics.blockBytes - live_bytes,
            largest_free_bytes: total.unusedRangeSizeMax,
            padding_bytes: total.statistics.allocationBytes - live_bytes,
            ..State::default()
        }
    }
}

/// VulkanMemoryAllocator's ranges in one block (its virtual allocator).
struct Virtual {
    block: vk_mem::VirtualBlock,
    live: BTreeMap<u64, (u64, vk_mem::VirtualAllocation)>,
    size_bytes: u64,
    used_bytes: u64,
}

// SAFETY: the block is reached through its only owner, one thread at a time.
unsafe impl Send for Virtual {}

impl Virtual {
    fn new(size_bytes: u64) -> Self {
        let info = vk_mem::VirtualBlockCreateInfo { size: size_bytes, ..vk_mem::VirtualBlockCreateInfo::default() };
        let block = vk_mem::VirtualBlock::new(info).expect("host memory");
        Self { block, live: BTreeMap::new(), size_bytes, used_bytes: 0 }
    }
}

impl Suballocate for Virtual {
    fn take(&mut self, bytes: u64, alignment: u64) -> Option<u64> {
        let info = vk_mem::VirtualAllocationCreateInfo {
            size: bytes,
            alignment,
            user_data: 0,
            flags: vk_mem::VirtualAllocationCreateFlags::empty(),
        };
        // SAFETY: the size is at least 1 and the alignment a power of two.
        let (allocation, offset) = unsafe { self.block.allocate(info) }.ok()?;
        self.live.insert(offset, (bytes, allocation));
        self.used_bytes += bytes;
        Some(offset)
    }

    fn give_back(&mut self, offset: u64, bytes: u64) -> bool {
        let (_, mut allocation) = self.live.remove(&offset).expect("a range comes back to its block");
        // SAFETY: it came from this block.
        unsafe { self.block.free(&mut allocation) };
        self.used_bytes -= bytes;
        self.live.is_empty()
    }

    fn used_bytes(&self) -> u64 {
        self.used_bytes
    }

    fn free_bytes(&self) -> u64 {
        self.size_bytes - self.used_bytes
    }

    fn largest_free_bytes(&self) -> u64 {
        largest_gap(self.size_bytes, self.live.iter().map(|(offset, (bytes, _))| (*offset, *bytes)))
    }
}

impl Drop for Virtual {
    fn drop(&mut self) {
        // SAFETY: nothing uses the ranges; the block must be empty when it goes.
        unsafe { self.block.clear() };
    }
}
