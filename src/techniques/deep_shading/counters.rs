//! What a frame counts in its shaders, for the report.

use crate::error::Result;
use crate::gpu::{Access, Buffer, Gpu, readback};
use std::collections::BTreeMap;
use std::sync::Arc;

/// COUNTER_COUNT of counters.glsl.
pub const COUNT: u64 = 13;

/// Numbers that the last frame left in `counters`; `pixels` of the frame. `has_tests`: a shader tested samples. A baseline has
/// neither lists nor shading space.
///
/// Errors: memory for the copy (exit code 4).
pub fn read(
    gpu: &Arc<Gpu>,
    counters: &Buffer,
    last: Access,
    pixels: u64,
    has_tests: bool,
    is_baseline: bool,
) -> Result<BTreeMap<&'static str, f64>> {
    let words: Vec<u32> = bytemuck::pod_collect_to_vec(&readback::buffer(gpu, counters, 4 * COUNT, last)?);
    let words =
        words.try_into().map(|words: [u32; COUNT as usize]| words.map(f64::from)).expect("as many as asked for");
    let [
        _,
        strays,
        shaded,
        missing,
        listed,
        duplicates,
        longest,
        overflows,
        list_pixels,
        samples,
        tests,
        carried,
        hits,
    ] = words;
    let mut counters = BTreeMap::from([
        ("shader_invocations", shaded),
        ("shaded_per_pixel", shaded / pixels as f64),
        ("samples_seen", samples),
    ]);
    if has_tests {
        counters.insert("sample_tests", tests + carried * 4_294_967_296.0);
        counters.insert("sample_tests_hit", hits);
    }
    if is_baseline {
        return Ok(counters);
    }
    counters.extend([
        ("samples_outside_shading_space", strays),
        ("samples_without_colour", missing),
        ("listed_primitives", listed),
        ("listed_again", duplicates),
        ("longest_list", longest),
        ("lists", list_pixels),
        ("lists_beyond_16", overflows),
    ]);
    Ok(counters)
}
