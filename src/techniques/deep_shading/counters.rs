//! What a frame counts in its shaders, for the report.

use super::touched::TouchedEntries;
use crate::error::Result;
use crate::gpu::shader::techniques::deep_shading::counters::{
    COUNTED_COLORS, COUNTED_CROWDED, COUNTED_DIGEST, COUNTED_DRAWN, COUNTED_DUPLICATES, COUNTED_EVALUATIONS,
    COUNTED_EVALUATIONS_CARRIED, COUNTED_FORGOTTEN, COUNTED_LISTED, COUNTED_LONGEST, COUNTED_MISSING, COUNTED_NODES,
    COUNTED_ORDERED, COUNTED_OTHER_CHARTS, COUNTED_OVERFLOWS, COUNTED_PIXELS, COUNTED_ROW_IDS, COUNTED_SAMPLES,
    COUNTED_SHADED, COUNTED_STRAYS, COUNTED_TESTS, COUNTED_TESTS_CARRIED, COUNTED_TESTS_HIT, COUNTER_COUNT,
};
use crate::gpu::{Access, Buffer, Gpu, readback};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Words of the counters.
pub const COUNT: u64 = COUNTER_COUNT as u64;

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

    /// `counter`: one of the `COUNTED_` words.
    fn word(&self, counter: u32) -> u64 {
        self.0[counter as usize].into()
    }

    fn number(&self, counter: u32) -> f64 {
        self.word(counter) as f64
    }

    /// The report's, whatever is shaded. `pixels` of the frame: executions a pixel are of one view's, however many eyes it is
    /// seen by. `has_tests`: a shader tested samples.
    pub fn report(&self, pixels: u64, has_tests: bool) -> BTreeMap<&'static str, f64> {
        let shaded = self.number(COUNTED_SHADED);
        let mut counters = BTreeMap::from([
            ("shader_invocations", shaded),
            ("shaded_per_pixel", shaded / pixels as f64),
            ("samples_seen", self.number(COUNTED_SAMPLES)),
        ]);
        if has_tests {
            let tests = self.number(COUNTED_TESTS) + self.number(COUNTED_TESTS_CARRIED) * 4_294_967_296.0;
            counters.insert("sample_tests", tests);
            counters.insert("sample_tests_hit", self.number(COUNTED_TESTS_HIT));
        }
        counters
    }

    /// Counters of lists in shading space.
    pub fn of_lists(&self) -> [(&'static str, f64); 10] {
        let crowded = self.number(COUNTED_CROWDED);
        [
            ("samples_outside_shading_space", self.number(COUNTED_STRAYS) - crowded),
            ("samples_of_full_lists", crowded),
            ("samples_without_colour", self.number(COUNTED_MISSING)),
            ("listed_primitives", self.number(COUNTED_LISTED)),
            ("listed_again", self.number(COUNTED_DUPLICATES)),
            ("listed_digest", self.number(COUNTED_DIGEST)),
            ("nodes_written", self.number(COUNTED_NODES)),
            ("longest_list", self.number(COUNTED_LONGEST)),
            ("lists", self.number(COUNTED_PIXELS)),
            ("lists_beyond_16", self.number(COUNTED_OVERFLOWS)),
        ]
    }

    /// Counters of shading space where fragments shade in it.
    pub fn of_fragments(&self) -> [(&'static str, f64); 1] {
        [("shading_pixels_drawn", self.number(COUNTED_DRAWN))]
    }

    /// Evaluations of so many lights, where a compute shader shades.
    pub fn of_lights(&self, lights: u64) -> [(&'static str, f64); 2] {
        let carried = self.word(COUNTED_EVALUATIONS_CARRIED) << 32;
        let evaluated = self.word(COUNTED_EVALUATIONS) + carried;
        let all = self.word(COUNTED_SHADED) * lights;
        [("light_evaluations", evaluated as f64), ("light_evaluations_culled", (all - evaluated) as f64)]
    }

    /// Counters of a compact geometry buffer.
    pub fn of_entries(&self) -> [(&'static str, f64); 3] {
        [
            ("samples_outside_shading_space", self.number(COUNTED_STRAYS)),
            ("samples_without_colour", self.number(COUNTED_MISSING)),
            ("shading_samples_forgotten", self.number(COUNTED_FORGOTTEN)),
        ]
    }

    /// Counters of textures in which draws are shaded.
    pub fn of_textures(&self) -> [(&'static str, f64); 2] {
        [
            ("samples_without_colour", self.number(COUNTED_MISSING)),
            ("samples_of_other_charts", self.number(COUNTED_OTHER_CHARTS)),
        ]
    }

    /// Entries of a compact geometry buffer.
    pub fn entry_count(&self) -> u64 {
        self.word(COUNTED_COLORS)
    }

    /// How much of the buffers of one entry a sample was used, with lists of `begins` shading pixels.
    pub fn entries(&self, begins: u64) -> TouchedEntries {
        TouchedEntries {
            nodes: self.word(COUNTED_NODES),
            colors: self.word(COUNTED_LISTED) + self.word(COUNTED_DUPLICATES) + self.word(COUNTED_STRAYS),
            row_ids: self.word(COUNTED_ROW_IDS),
            addresses: self.word(COUNTED_SAMPLES),
            begins,
            ordered: self.word(COUNTED_ORDERED),
        }
    }
}
