//! What the stages of each pass counted, by the device's own count: a query of pipeline statistics around the pass.
//!
//! Devices count in their own ways (Vulkan 1.3, "Pipeline Statistics Queries"): invocations that only help others to
//! differences, discarded ones, all pixels of a block of which a triangle touches one, a vertex once for several triangles. So a
//! count of fragments bounds what their shaders count themselves from above, and is no second copy of it.

use super::Gpu;
use super::failure::failed;
use crate::caps::{Ability, Caps, Need};
use crate::error::{Error, Result};
use ash::vk;
use ash::vk::QueryPipelineStatisticFlags as Flags;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Counts of one pass, by Vulkan's names for them; those that the device does not count are left out.
pub type PassStatistics = BTreeMap<&'static str, u64>;

/// In the order of their bits, in which Vulkan returns them.
const COUNTED: [(Flags, &str); 9] = [
    (Flags::INPUT_ASSEMBLY_VERTICES, "input_assembly_vertices"),
    (Flags::INPUT_ASSEMBLY_PRIMITIVES, "input_assembly_primitives"),
    (Flags::VERTEX_SHADER_INVOCATIONS, "vertex_shader_invocations"),
    (Flags::GEOMETRY_SHADER_INVOCATIONS, "geometry_shader_invocations"),
    (Flags::GEOMETRY_SHADER_PRIMITIVES, "geometry_shader_primitives"),
    (Flags::CLIPPING_INVOCATIONS, "clipping_invocations"),
    (Flags::CLIPPING_PRIMITIVES, "clipping_primitives"),
    (Flags::FRAGMENT_SHADER_INVOCATIONS, "fragment_shader_invocations"),
    (Flags::COMPUTE_SHADER_INVOCATIONS, "compute_shader_invocations"),
];

/// What a device of these caps counts: without geometry shaders their counts may not be asked for.
fn counted(caps: &Caps) -> impl Iterator<Item = (Flags, &'static str)> {
    let of_geometry = Flags::GEOMETRY_SHADER_INVOCATIONS | Flags::GEOMETRY_SHADER_PRIMITIVES;
    let has_geometry = caps.features.geometry_shader;
    COUNTED.into_iter().filter(move |(flag, _)| has_geometry || !of_geometry.contains(*flag))
}

/// Errors: a device of these caps counts nothing (exit code 3).
pub fn require(caps: &Caps) -> Result<()> {
    let need = Need {
        of: "--statistics".to_owned(),
        ability: Ability::PipelineStatistics,
        instead: "without it reports have the counts that shaders keep themselves (counters), which need nothing",
    };
    if need.is_met(caps) { Ok(()) } else { Err(need.refusal(caps)) }
}

/// A query a pass.
pub struct Statistics {
    gpu: Arc<Gpu>,
    pool: vk::QueryPool,
    pass_count: u32,
}

impl Statistics {
    /// Queries for `pass_count` passes, at least one, on a device that `require` found fit.
    ///
    /// Errors: the driver refuses (exit code 4).
    pub fn new(gpu: &Arc<Gpu>, pass_count: u32) -> Result<Self> {
        assert!(gpu.caps.features.pipeline_statistics, "a device without statistics is refused before");
        let flags = counted(&gpu.caps).fold(Flags::empty(), |all, (flag, _)| all | flag);
        let info = vk::QueryPoolCreateInfo::default()
            .query_type(vk::QueryType::PIPELINE_STATISTICS)
            .query_count(pass_count)
            .pipeline_statistics(flags);
        // SAFETY: a live device, whose features have what is asked for.
        let pool = unsafe { gpu.device.create_query_pool(&info, None) }
            .map_err(|result| Error::device(format!("creating {pass_count} pipeline statistics: {result}")))?;
        gpu.name(pool, "statistics");
        Ok(Self { gpu: gpu.clone(), pool, pass_count })
    }

    /// Records the reset that must come before the first pass of each frame.
    pub fn reset(&self, buffer: vk::CommandBuffer) {
        // SAFETY: the buffer is being recorded, outside rendering.
        unsafe { self.gpu.device.cmd_reset_query_pool(buffer, self.pool, 0, self.pass_count) };
    }

    /// Begins to count a pass, outside rendering: no other is being counted.
    pub fn begin(&self, buffer: vk::CommandBuffer, pass: u32) {
        // SAFETY: as above; the query lies in the pool and was reset.
        unsafe { self.gpu.device.cmd_begin_query(buffer, self.pool, pass, vk::QueryControlFlags::empty()) };
    }

    /// Ends it, in the same command buffer and outside rendering.
    pub fn end(&self, buffer: vk::CommandBuffer, pass: u32) {
        // SAFETY: as above; `begin` began it.
        unsafe { self.gpu.device.cmd_end_query(buffer, self.pool, pass) };
    }

    /// Counts of each of the first `pass_count` passes, after the fence of the frame that made them.
    pub fn read_first(&self, pass_count: usize) -> Result<Vec<PassStatistics>> {
        // As far apart as all of them, of which fewer may be written.
        let mut counts = vec![[0u64; COUNTED.len()]; pass_count];
        let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WAIT;
        // SAFETY: the queries were made by the submits whose fences the caller waited for.
        unsafe { self.gpu.device.get_query_pool_results(self.pool, 0, &mut counts, flags) }
            .map_err(|result| failed("reading pipeline statistics", result))?;
        let named = |counts: [u64; COUNTED.len()]| counted(&self.gpu.caps).map(|(_, name)| name).zip(counts).collect();
        Ok(counts.into_iter().map(named).collect())
    }
}

impl Drop for Statistics {
    fn drop(&mut self) {
        // SAFETY: the fence of the last frame that used it was waited for.
        unsafe { self.gpu.device.destroy_query_pool(self.pool, None) };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::caps::known;

    #[test]
    fn a_device_that_counts_nothing_is_refused_with_the_reason() {
        let mut caps = known::caps(known::DEFAULT).unwrap();
        require(&caps).unwrap();
        caps.features.pipeline_statistics = false;
        let error = require(&caps).unwrap_err();
        assert_eq!(error.exit_code(), 3);
        let text = error.to_string();
        for words in ["--statistics", "pipelineStatisticsQuery", caps.identity.driver_text(), "counters"] {
            assert!(text.contains(words), "{text}");
        }
    }

    #[test]
    fn counts_come_in_vulkan_s_order_and_those_of_geometry_shaders_only_where_there_are_any() {
        assert!(COUNTED.is_sorted_by_key(|(flag, _)| flag.as_raw()));
        let mut caps = known::caps(known::DEFAULT).unwrap();
        assert_eq!(counted(&caps).count(), COUNTED.len());
        caps.features.geometry_shader = false;
        let without: Vec<&str> = counted(&caps).map(|(_, name)| name).collect();
        assert!(
            without.len() == COUNTED.len() - 2 && without.iter().all(|name| !name.contains("geometry")),
            "{without:?}"
        );
    }
}
