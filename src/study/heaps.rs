//! What a technique takes of each heap, and beside it what the driver says of the heap itself: two accounts that are never mixed, because
//! a driver counts what else there is.

use super::Study;
use crate::units::Bytes;
use serde_json::{Value, json};

/// A heap's part of a study.
struct Share {
    /// What its resources take, before sharing.
    bound_bytes: u64,
    /// What its memory blocks take; None where nothing was made.
    block_bytes: Option<u64>,
}

fn shares(study: &Study) -> Vec<Share> {
    let report = study.table.report();
    let heap_of = |memory_type: u32| study.caps.memory_types.get(memory_type as usize).map(|kind| kind.heap as usize);
    let share = |heap: usize| Share {
        bound_bytes: report
            .resources
            .iter()
            .filter(|row| heap_of(row.memory_type) == Some(heap))
            .map(|row| row.bound_bytes)
            .sum(),
        block_bytes: report.memory_blocks.as_ref().map(|blocks| {
            blocks.iter().filter(|block| heap_of(block.memory_type) == Some(heap)).map(|block| block.bytes).sum()
        }),
    };
    (0..study.caps.heaps.len()).map(share).collect()
}

/// A line a heap.
pub fn text(study: &Study) -> String {
    let line = |(index, share): (usize, Share)| {
        let heap = &study.caps.heaps[index];
        let kind = if heap.device_local { "device local" } else { "the host's" };
        let blocks = share.block_bytes.map(|bytes| format!(", {} in memory blocks", Bytes(bytes)));
        let driver = study.driver_heaps.as_ref().and_then(|heaps| heaps.get(index)).map(|heap| {
            format!("; the driver says {} used of a budget of {}", Bytes(heap.usage_bytes), Bytes(heap.budget_bytes))
        });
        format!(
            "heap {index} ({kind}, {}): {} bound{}{}\n",
            Bytes(heap.bytes),
            Bytes(share.bound_bytes),
            blocks.unwrap_or_default(),
            driver.unwrap_or_default()
        )
    };
    shares(study).into_iter().enumerate().map(line).collect()
}

/// The same as data; `driver` is null where it says nothing.
pub fn json(study: &Study) -> Value {
    let heap = |(index, share): (usize, Share)| {
        let heap = &study.caps.heaps[index];
        json!({
            "bytes": heap.bytes,
            "device_local": heap.device_local,
            "bound_bytes": share.bound_bytes,
            "memory_block_bytes": share.block_bytes,
            "driver": study.driver_heaps.as_ref().and_then(|heaps| heaps.get(index)),
        })
    };
    shares(study).into_iter().enumerate().map(heap).collect()
}
