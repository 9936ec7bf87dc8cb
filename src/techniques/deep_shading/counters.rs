//! What a frame counts in its shaders, for the report.

use crate::error::Result;
use crate::gpu::{Access, Buffer, Gpu, readback};
use std::collections::BTreeMap;
use std::sync::Arc;

/// COUNTER_COUNT of counters.glsl.
pub const COUNT: u64 = 10;

/// Numbers that the last frame left in `counters`; `pixels` of the frame. `is_counted`: with `--instrument on`.
///
/// Errors: memory for the copy (exit code 4).
pub fn read(gpu: &Arc<Gpu>, counters: &Buffer, last: Access, pixels: u64) -> Result<BTreeMap<&'static str, f64>> {
    let words: Vec<u32> = bytemuck::pod_collect_to_vec(&readback::buffer(gpu, counters, 4 * COUNT, last)?);
    let [_, strays, shaded, missing, listed, duplicates, longest, overflows, list_pixels, samples] =
        words.try_into().map(|words: [u32; COUNT as usize]| words.map(f64::from)).expect("as many as asked for");
    Ok(BTreeMap::from([
        ("shader_invocations", shaded),
        ("shaded_per_pixel", shaded / pixels as f64),
        ("samples_seen", samples),
        ("samples_outside_shading_space", strays),
        ("samples_without_colour", missing),
        ("listed_primitives", listed),
        ("listed_again", duplicates),
        ("longest_list", longest),
        ("lists", list_pixels),
        ("lists_beyond_16", overflows),
    ]))
}
