//! Insertion: each sample's triangle at the head of its list, by compare-exchange, unless the list has it. Shader: insert.comp.
//! reads   visibility.spids, visibility.shading_depths
//! writes  lists.begins, lists.nodes, lists.zmax, lists.marks, and addresses as they are without compaction; in places of colours entries that wait

use super::super::choices::Choices;
use super::Lists;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::deep_shading::lists::insert::COMP_VARIANTS;
use crate::gpu::shader::techniques::deep_shading::space::NEAREST_DEPTH;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Traffic};
use crate::techniques::deep_shading::resources::full;
use crate::techniques::deep_shading::visibility::samples::Samples;
use std::sync::Arc;

pub struct Insert {
    pipeline: ComputePipeline,
}

impl Insert {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices) -> Result<Self> {
        let on = |is_on| if is_on { "on" } else { "off" };
        let axes = [choices.lists.has_zmax, choices.lists.has_addresses, choices.lists.has_marks].map(on);
        let shader = variant(COMP_VARIANTS, &axes);
        let constants = [
            ("TOLERATES_DUPLICATES", u32::from(choices.lists.tolerates_duplicates)),
            ("IS_COMPACTED", u32::from(choices.lists.is_compacted)),
            ("HAS_LIST_ENTRIES", u32::from(choices.lists.has_entries)),
            ("IS_COUNTED", u32::from(choices.is_counted)),
            ("BY_ADDRESS", u32::from(choices.is_by_address)),
            ("HAS_FENCES", u32::from(!gpu.caps.identity.barriers_end_threads())),
        ];
        Ok(Self { pipeline: ComputePipeline::new(gpu, shader, &constants)? })
    }

    /// `bound`: what shaders of the technique may read.
    pub fn record(
        &self,
        cmd: &mut Commands,
        bound: &[(&'static str, Bound<'_>)],
        seen: Edge<'_, Samples>,
        lists: &Lists,
        colors: &Buffer,
        counters: Edge<'_, Buffer>,
    ) -> Result<()> {
        let samples = seen.resource;
        let spids = &samples.spids;
        let traffic = Traffic { invocations: Some(samples.count()), ..Traffic::default() };
        cmd.pass(&full("lists"), traffic, |cmd| {
            let words = [(Some(&lists.begins), 0), (lists.zmax.as_ref(), NEAREST_DEPTH), (lists.marks.as_ref(), 0)];
            let filled: Vec<(&Buffer, u32)> =
                words.into_iter().filter_map(|(buffer, word)| Some((buffer?, word))).collect();
            cmd.barriers(filled.iter().map(|(buffer, _)| buffer.discard(Access::TransferWrite)));
            filled.iter().for_each(|(buffer, word)| cmd.fill_buffer(buffer, *word));
            cmd.barriers(filled.iter().map(|(buffer, _)| buffer.from(Access::TransferWrite).to(Access::ComputeWrite)));
            cmd.barriers([counters.to(Access::ComputeWrite)]);
            let fresh = [Some(&lists.nodes), Some(colors), lists.addresses.as_ref()].into_iter().flatten();
            cmd.barriers(fresh.map(|buffer| buffer.discard(Access::ComputeWrite)));
            cmd.barriers(seen.colors_to(Access::ComputeSample));
            let mut bound = bound.to_vec();
            bound.extend(lists.bound());
            bound.extend([
                ("Colors", Bound::Buffer(colors)),
                ("Counters", Bound::Buffer(counters.resource)),
                ("spids", samples.sampled(spids, Access::ComputeSample)),
            ]);
            let depths = samples.shading_depths();
            bound.extend(depths.map(|image| ("shading_depths", samples.sampled(image, Access::ComputeSample))));
            let groups = self.pipeline.groups(samples.threads());
            cmd.dispatch(&self.pipeline, &[], &self.pipeline.interface.own(&bound), groups)
        })
    }
}
