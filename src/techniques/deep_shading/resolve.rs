//! Resolve: the mean of each pixel's samples, gathered through the address buffer, by following links, or from the samples' own
//! places (Clarberg & Munkberg 2014, section 3.2). Shader: resolve.comp.
//! reads  visibility.spids, shade.colors, lists.addresses or the lists      writes  resolve.color  image, RGBA32F

use super::choices::Choices;
use super::full;
use super::lists::Lists;
use super::visibility::Samples;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::deep_shading::resolve::COMP_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, AccessSet, Bound, Buffer, Commands, Gpu, Image, Traffic};
use std::sync::Arc;

pub struct Resolve {
    pipeline: ComputePipeline,
}

impl Resolve {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices) -> Result<Self> {
        let fetch = match choices {
            Choices { has_lists: false, .. } => "own",
            Choices { is_direct: true, .. } => "direct",
            Choices { has_addresses: true, .. } => "address",
            Choices { is_compacted: true, .. } => "compact",
            _ => "linked",
        };
        let constants = [("IS_COUNTED", u32::from(choices.is_counted))];
        Ok(Self { pipeline: ComputePipeline::new(gpu, variant(COMP_VARIANTS, &[fetch]), &constants)? })
    }

    /// The samples, where they have SPIDs; `left`: who read the SPIDs, and who wrote them where compute shaders have not waited for it yet.
    #[allow(clippy::too_many_arguments)]
    pub fn record(
        &self,
        cmd: &mut Commands,
        bound: &[(&'static str, Bound<'_>)],
        samples: Option<(&Samples, AccessSet)>,
        lists: Option<&Lists>,
        colors: &Buffer,
        counters: &Buffer,
        color: &Image,
    ) -> Result<()> {
        let extent = color.description.extent;
        let traffic = Traffic {
            read_bytes: samples.map_or(0, |(samples, _)| samples.spids.description.bytes())
                + lists.and_then(|lists| lists.addresses.as_ref()).map_or(0, |buffer| buffer.bytes)
                + colors.bytes,
            written_bytes: color.description.bytes(),
            invocations: Some(extent.pixel_count()),
        };
        cmd.pass(&full("resolve"), traffic, |cmd| {
            match lists {
                Some(Lists { addresses: Some(addresses), .. }) => {
                    cmd.barriers([addresses.from(Access::ComputeWrite | Access::GraphicsRead).to(Access::ComputeRead)]);
                }
                Some(lists) => lists.links_to_compute(cmd, Access::ComputeRead),
                None => {}
            }
            cmd.barriers(samples.map(|(samples, left)| samples.spids.from(left).to(Access::ComputeSample)));
            cmd.barriers([color.discard(Access::ComputeWrite)]);
            cmd.barriers([
                colors.from(Access::FragmentWrite).to(Access::ComputeRead),
                counters.from(Access::FragmentWrite).to(Access::ComputeWrite),
            ]);
            let mut bound = bound.to_vec();
            bound.extend(lists.map(Lists::bound).into_iter().flatten());
            bound.extend([
                ("Colors", Bound::Buffer(colors)),
                ("Counters", Bound::Buffer(counters)),
                ("color", Bound::Storage(color)),
            ]);
            let spids = samples.map(|(samples, _)| samples.sampled(&samples.spids, Access::ComputeSample));
            bound.extend(spids.map(|spids| ("spids", spids)));
            let groups = self.pipeline.groups([extent.width, extent.height, 1]);
            cmd.dispatch(&self.pipeline, &[], &self.pipeline.interface.own(&bound), groups)
        })
    }
}
