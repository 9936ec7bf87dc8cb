//! Samples find their shading samples in the cache, and what has no entry yet gets one, with what its material says (Liktor &
//! Dachsbacher 2012). Shaders: those before fragments of visibility, gbuffer.frag, cache.glsl.
//! reads   the scene, visibility.spids, visibility.depth
//! writes  indirect.pointers, indirect.cache, indirect.places, .normals, .base_colors, .radiances

use super::super::choices::Choices;
use super::super::primitives::Primitives;
use super::super::redraw::{self, TriangleRedraw};
use super::entries::Entries;
use crate::error::Result;
use crate::gpu::shader::techniques::deep_shading::indirect::gbuffer::FRAG_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, AccessSet, Bound, Buffer, Commands, Gpu, Traffic};
use crate::passes::mesh;
use crate::plan::Resources;
use crate::resident::{DrawList, SceneGpu};
use crate::techniques::deep_shading::resources::full;
use crate::techniques::deep_shading::visibility::samples::Samples;
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

    /// The scene, what of it is drawn, and its ids.
    pub fn record(
        &self,
        cmd: &mut Commands,
        (scene, list, primitives): (&SceneGpu, &DrawList, &Primitives),
        bound: &[(&'static str, Bound<'_>)],
        samples: &Samples,
        entries: &Entries,
        counters: &Buffer,
    ) -> Result<()> {
        let traffic = Traffic {
            read_bytes: self.0.read_bytes(cmd.gpu(), scene, list, Some(samples)),
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
            cmd.barriers([counters.from(Access::FragmentWrite).to(Access::FragmentWrite)]);
            let mut bound = bound.to_vec();
            bound.extend(entries.bound());
            bound.push(("Counters", Bound::Buffer(counters)));
            let samples = Some((samples, AccessSet::from(samples.written)));
            self.0.record(cmd, scene, list, primitives, samples, bound)
        })
    }
}
