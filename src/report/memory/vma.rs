//! Memory blocks in the words of VulkanMemoryAllocator's statistics (`vmaBuildStatsString`, its GpuMemDump.schema.json), which its
//! GpuMemDumpVis and others draw. An arena is one range there, because that format has none that share bytes.

use super::{MemoryReport, MemoryRow};
use crate::caps::{Caps, MemoryType};
use crate::memory::ledger::BlockState;
use serde_json::{Map, Value, json};

/// A range in a memory block.
struct Range {
    name: String,
    offset: u64,
    bytes: u64,
    kind: &'static str,
    usage: u32,
}

/// None where nothing was made. `caps`: of the device.
pub fn document(report: &MemoryReport, caps: &Caps) -> Option<Value> {
    let blocks = report.memory_blocks.as_ref()?;
    let mut pools = Map::new();
    for block in blocks {
        let pool = pools
            .entry(format!("Type {}", block.memory_type))
            .or_insert_with(|| json!({ "PreferredBlockSize": 0, "Blocks": {}, "DedicatedAllocations": [] }));
        pool["PreferredBlockSize"] = pool["PreferredBlockSize"].as_u64().unwrap_or_default().max(block.bytes).into();
        pool["Blocks"][block.index.to_string()] = of_block(report, block);
    }
    let heaps = caps.heaps.iter().enumerate().map(|(index, heap)| {
        let types = caps.memory_types.iter().enumerate().filter(|(_, kind)| kind.heap as usize == index);
        let types = types.map(|(index, kind)| {
            let of_type: Vec<&BlockState> = blocks.iter().filter(|block| block.memory_type as usize == index).collect();
            (format!("Type {index}"), json!({ "Flags": flags(kind), "Stats": statistics(report, &of_type) }))
        });
        let in_heap: Vec<&BlockState> = blocks
            .iter()
            .filter(|block| {
                caps.memory_types.get(block.memory_type as usize).is_some_and(|kind| kind.heap as usize == index)
            })
            .collect();
        let held_bytes: u64 = in_heap.iter().map(|block| block.bytes).sum();
        let heap = json!({
            "Flags": if heap.device_local { vec!["DEVICE_LOCAL"] } else { Vec::new() },
            "Size": heap.bytes,
            "Budget": { "BudgetBytes": heap.bytes, "UsageBytes": held_bytes },
            "Stats": statistics(report, &in_heap),
            "MemoryPools": types.collect::<Map<String, Value>>(),
        });
        (format!("Heap {index}"), heap)
    });
    let all: Vec<&BlockState> = blocks.iter().collect();
    Some(json!({
        "General": {
            "API": "Vulkan",
            "apiVersion": caps.identity.api,
            "GPU": caps.identity.name,
            "memoryHeapCount": caps.heaps.len(),
            "memoryTypeCount": caps.memory_types.len(),
            "bufferImageGranularity": caps.limits.buffer_image_granularity_bytes,
        },
        "Total": statistics(report, &all),
        "MemoryInfo": heaps.collect::<Map<String, Value>>(),
        "DefaultPools": pools,
        "CustomPools": {},
    }))
}

fn flags(kind: &MemoryType) -> Vec<&'static str> {
    let all = [
        (kind.device_local, "DEVICE_LOCAL"),
        (kind.host_visible, "HOST_VISIBLE"),
        (kind.host_coherent, "HOST_COHERENT"),
        (kind.host_cached, "HOST_CACHED"),
        (kind.lazily_allocated, "LAZILY_ALLOCATED"),
    ];
    all.into_iter().filter(|(is_set, _)| *is_set).map(|(_, name)| name).collect()
}

/// Ranges of a block that share no bytes, in their order.
fn ranges(report: &MemoryReport, block: &BlockState) -> Vec<Range> {
    let inside = || report.resources.iter().filter(|row| row.memory_block == Some(block.index));
    let own = inside().filter(|row| row.arena.is_none()).map(|row| Range {
        name: row.name.clone(),
        offset: row.offset.unwrap_or_default(),
        bytes: row.bound_bytes,
        kind: if row.format.is_some() { "IMAGE_OPTIMAL" } else { "BUFFER" },
        usage: row.usage.unwrap_or_default(),
    });
    let arenas = report.arenas.iter().enumerate().filter_map(|(index, arena)| {
        let is_part = |row: &&MemoryRow| row.arena.as_ref().is_some_and(|place| place.index == index);
        let part = inside().find(is_part)?;
        let offset = part.offset? - part.arena.as_ref()?.offset;
        let name = format!("{} resources that share bytes", arena.parts);
        Some(Range { name, offset, bytes: arena.bytes, kind: "UNKNOWN", usage: 0 })
    });
    let mut all: Vec<Range> = own.chain(arenas).collect();
    all.sort_by_key(|range| range.offset);
    all
}

/// Sizes of what lies between ranges, and behind the last.
fn unused(ranges: &[Range], block: &BlockState) -> Vec<(u64, u64)> {
    let mut end = 0;
    let mut gaps = Vec::new();
    for range in ranges {
        if range.offset > end {
            gaps.push((end, range.offset - end));
        }
        end = end.max(range.offset + range.bytes);
    }
    if block.bytes > end {
        gaps.push((end, block.bytes - end));
    }
    gaps
}

fn of_block(report: &MemoryReport, block: &BlockState) -> Value {
    let ranges = ranges(report, block);
    let gaps = unused(&ranges, block);
    let mut places: Vec<(u64, Value)> = ranges
        .iter()
        .map(|Range { name, offset, bytes, kind, usage }| {
            (*offset, json!({ "Offset": offset, "Type": kind, "Size": bytes, "Usage": usage, "Name": name }))
        })
        .chain(gaps.iter().map(|(offset, bytes)| (*offset, json!({ "Offset": offset, "Type": "FREE", "Size": bytes }))))
        .collect();
    places.sort_by_key(|(offset, _)| *offset);
    json!({
        "MapRefCount": 0,
        "TotalBytes": block.bytes,
        "UnusedBytes": gaps.iter().map(|(_, bytes)| bytes).sum::<u64>(),
        "Allocations": ranges.len(),
        "UnusedRanges": gaps.len(),
        "Suballocations": places.into_iter().map(|(_, place)| place).collect::<Vec<_>>(),
    })
}

fn statistics(report: &MemoryReport, blocks: &[&BlockState]) -> Value {
    let (mut sizes, mut gaps) = (Vec::new(), Vec::new());
    for block in blocks {
        let ranges = ranges(report, block);
        gaps.extend(unused(&ranges, block).into_iter().map(|(_, bytes)| bytes));
        sizes.extend(ranges.into_iter().map(|range| range.bytes));
    }
    let mut all = Map::from_iter([
        ("BlockCount".to_owned(), json!(blocks.len())),
        ("BlockBytes".to_owned(), json!(blocks.iter().map(|block| block.bytes).sum::<u64>())),
        ("AllocationCount".to_owned(), json!(sizes.len())),
        ("AllocationBytes".to_owned(), json!(sizes.iter().sum::<u64>())),
        ("UnusedRangeCount".to_owned(), json!(gaps.len())),
    ]);
    for (name, numbers) in [("AllocationSize", &sizes), ("UnusedRangeSize", &gaps)] {
        // The format has them of more than one.
        if numbers.len() > 1 {
            all.insert(format!("{name}Min"), json!(numbers.iter().min()));
            all.insert(format!("{name}Max"), json!(numbers.iter().max()));
        }
    }
    Value::Object(all)
}
