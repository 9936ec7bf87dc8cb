//! Samples find their shading samples in the cache, and what has no entry yet gets one, with what its material says (Liktor &
//! Dachsbacher 2012). Shaders: those before fragments of visibility, gbuffer.frag, cache.glsl.
//! reads   the scene, visibility.spids, visibility.depth
//! writes  indirect.pointers, indirect.cache, indirect.places, .normals, .base_colors, .radiances

use super::super::choices::Choices;
use super::super::pass_inputs::DrawInputs;
use super::super::redraw::{self, TriangleRedraw};
use super::entries::Entries;
use crate::error::Result;
use crate::gpu::shader::techniques::deep_shading::indirect::gbuffer::FRAG_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Edge, Gpu, Traffic};
use crate::passes::mesh;
use crate::plan::Resources;
use crate::resident::SceneGpu;
use crate::techniques::deep_shading::resources::full;
use crate::techniques::deep_shading::visibility::samples::SeenSamples;
use crate::units::Extent;
use std::sync::Arc;

pub struct Gbuffer(TriangleRedraw);

impl Gbuffer {
    /// `frame`: its extent.
    pub fn new(
        gpu: &Arc<Gpu>,
        scene: &SceneGpu,
        resources: &mut Resources,
        choices: &Choices,
        frame: Extent,
    ) -> Result<Self> {
        let fragment = variant(FRAG_VARIANTS, &[mesh::vertex_name(scene), redraw::axis(choices)]);
        Ok(Self(TriangleRedraw::new(gpu, scene, resources, choices, frame, fragment)?))
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        inputs: DrawInputs<'_>,
        seen: SeenSamples<'_>,
        entries: &Entries,
        counters: Edge<'_, Buffer>,
    ) -> Result<()> {
        let traffic = Traffic {
            read_bytes: self.0.read_bytes(cmd.gpu(), inputs, Some(seen)),
            // Entries are counted after the frame.
            written_bytes: entries.pointers.bytes,
            invocations: None,
        };
        cmd.pass(&full("indirect.gbuffer"), traffic, |cmd| {
            let cleared = [&entries.pointers, &entries.cache];
            cmd.barriers(cleared.map(|buffer| buffer.discard(Access::TransferWrite)));
            cleared.iter().for_each(|buffer| cmd.clear(buffer));
            cmd.barriers(cleared.map(|buffer| buffer.from(Access::TransferWrite).to(Access::FragmentWrite)));
            cmd.barriers(entries.entries.iter().map(|buffer| buffer.discard(Access::FragmentWrite)));
            cmd.barriers([counters.to(Access::FragmentWrite)]);
            let mut bound = inputs.bound.to_vec();
            bound.extend(entries.bound());
            bound.push(("Counters", Bound::Buffer(counters.resource)));
            self.0.record(cmd, inputs, Some(seen), bound)
        })
    }
}
