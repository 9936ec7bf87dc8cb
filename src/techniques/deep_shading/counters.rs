//! What a frame counts in its shaders, for the report.

use super::touched::TouchedEntries;
use crate::error::Result;
use crate::gpu::{Access, Buffer, Gpu, readback};
use std::collections::BTreeMap;
use std::sync::Arc;

/// COUNTER_COUNT of counters.glsl.
pub const COUNT: u64 = 21;

/// Numbers that a frame left, as counters.glsl has them.
pub struct FrameCounts([u32; COUNT as usize]);

impl FrameCounts {
    /// Those of the last frame, in `counters`.
    ///
    /// Errors: memory for the copy (exit code 4).
    pub fn read(gpu: &Arc<Gpu>, counters: &Buffer, last: Access) -> Result<Self> {
        let words: Vec<u32> = bytemuck::pod_collect_to_vec(&readback::buffer(gpu, counters, 4 * COUNT, last)?);
        Ok(Self(words.try_into().expect("as many as asked for")))
    }

    /// The report's, whatever is shaded. `pixels` of the frame: executions a pixel are of one view's, however many eyes it is seen by.
    /// `has_tests`: a shader tested samples.
    pub fn report(&self, pixels: u64, has_tests: bool) -> BTreeMap<&'static str, f64> {
        let [_, _, shaded, _, _, _, _, _, _, samples, tests, carried, hits, ..] = self.0.map(f64::from);
        let mut counters = BTreeMap::from([
            ("shader_invocations", shaded),
            ("shaded_per_pixel", shaded / pixels as f64),
            ("samples_seen", samples),
        ]);
        if has_tests {
            counters.insert("sample_tests", tests + carried * 4_294_967_296.0);
            counters.insert("sample_tests_hit", hits);
        }
        counters
    }

    /// Counters of lists in shading space.
    pub fn of_lists(&self) -> [(&'static str, f64); 11] {
        let [
            _,
            strays,
            _,
            missing,
            listed,
            duplicates,
            longest,
            overflows,
            list_pixels,
            _,
            _,
            _,
            _,
            crowded,
            nodes,
            _,
            digest,
            _,
            _,
            drawn,
            _,
        ] = self.0.map(f64::from);
        [
            ("samples_outside_shading_space", strays - crowded),
            ("samples_of_full_lists", crowded),
            ("samples_without_colour", missing),
            ("shading_pixels_drawn", drawn),
            ("listed_primitives", listed),
            ("listed_again", duplicates),
            ("listed_digest", digest),
            ("nodes_written", nodes),
            ("longest_list", longest),
            ("lists", list_pixels),
            ("lists_beyond_16", overflows),
        ]
    }

    /// Counters of a compact geometry buffer.
    pub fn of_entries(&self) -> [(&'static str, f64); 3] {
        let [_, strays, _, missing, .., forgotten, _, _, _] = self.0.map(f64::from);
        [
            ("samples_outside_shading_space", strays),
            ("samples_without_colour", missing),
            ("shading_samples_forgotten", forgotten),
        ]
    }

    /// Counters of textures in which draws are shaded.
    pub fn of_textures(&self) -> [(&'static str, f64); 2] {
        let [_, _, _, missing, .., of_other_charts, _, _] = self.0.map(f64::from);
        [("samples_without_colour", missing), ("samples_of_other_charts", of_other_charts)]
    }

    /// Entries of a compact geometry buffer.
    pub fn entry_count(&self) -> u64 {
        let [entries, ..] = self.0;
        entries.into()
    }

    /// How much of the buffers of one entry a sample was used, with lists of `begins` shading pixels.
    pub fn entries(&self, begins: u64) -> TouchedEntries {
        let [_, strays, _, _, listed, duplicates, _, _, _, samples, .., nodes, row_ids, _, _, _, _, _] =
            self.0.map(u64::from);
        TouchedEntries { nodes, colors: listed + duplicates + strays, row_ids, addresses: samples, begins }
    }
}
