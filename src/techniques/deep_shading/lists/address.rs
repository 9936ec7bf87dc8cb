//! Addresses: where each sample's colour will lie in a compacted list, looked up once. Shader: address.comp.
//! reads  visibility.spids, the lists      writes  lists.addresses

use super::super::choices::Choices;
use super::ListsEdge;
use crate::error::Result;
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::shader::techniques::deep_shading::lists::address::COMP;
use crate::gpu::{Access, Bound, Commands, Edge, Gpu, Traffic};
use crate::techniques::deep_shading::choices::constants_of;
use crate::techniques::deep_shading::resources::full;
use crate::techniques::deep_shading::visibility::samples::Samples;
use std::sync::Arc;

pub struct Address {
    pipeline: ComputePipeline,
}

impl Address {
    pub fn new(gpu: &Arc<Gpu>, choices: &Choices) -> Result<Self> {
        let constants = constants_of(choices, &[Some(&COMP)]);
        Ok(Self { pipeline: ComputePipeline::new(gpu, &COMP, &constants)? })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        bound: &[(&'static str, Bound<'_>)],
        seen: Edge<'_, Samples>,
        compacted: ListsEdge<'_>,
    ) -> Result<()> {
        let (samples, lists) = (seen.resource, compacted.lists);
        let spids = &samples.spids;
        let addresses = lists.addresses.as_ref().expect("only with --address-buffer on");
        let traffic = Traffic {
            // Lists are walked as far as they hold it.
            read_bytes: None,
            written_bytes: Some(addresses.bytes),
            invocations: Some(samples.count()),
        };
        cmd.pass(&full("lists.address"), traffic, |cmd| {
            cmd.barriers(compacted.links_to(Access::ComputeRead));
            cmd.barriers([seen.spids_to(Access::ComputeSample)]);
            cmd.barriers(compacted.addresses_to(Access::ComputeWrite));
            let mut bound = bound.to_vec();
            bound.extend(lists.bound());
            bound.push(("spids", samples.sampled(spids, Access::ComputeSample)));
            let groups = self.pipeline.groups(samples.threads());
            cmd.dispatch(&self.pipeline, &[], &self.pipeline.interface.own(&bound), groups)
        })
    }
}
