//! Samples shaded where they are seen, each by itself, at their shading points: all of them (`--lists none`, the oracle), or
//! those that shading space has no place for or whose list is full (pass `strays`). Shaders: those before fragments of
//! visibility, brute.frag.
//! reads  the scene, its lights, visibility.spids, visibility.depth, the lists      writes  shade.colors

use super::choices::Choices;
use super::lists::Lists;
use super::primitives::Primitives;
use super::redraw::{self, TriangleRedraw};
use crate::error::Result;
use crate::gpu::shader::techniques::deep_shading::brute::FRAG_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, AccessSet, Barrier, Bound, Buffer, Commands, Gpu, Traffic};
use crate::passes::{mesh, shadow_maps};
use crate::plan::Resources;
use crate::resident::{DrawList, SceneGpu};
use crate::techniques::deep_shading::resources::full;
use crate::techniques::deep_shading::visibility::samples::Samples;
use crate::units::Extent;
use std::sync::Arc;

pub struct BruteForce {
    redraw: TriangleRedraw,
    name: &'static str,
}

impl BruteForce {
    /// `frame`: its extent.
    pub fn new(
        gpu: &Arc<Gpu>,
        scene: &SceneGpu,
        resources: &mut Resources,
        choices: &Choices,
        frame: Extent,
    ) -> Result<Self> {
        let samples = match choices {
            Choices { has_lists: false, .. } => "all",
            Choices { is_direct: true, .. } => "direct",
            Choices { is_compacted: true, .. } => "compact",
            _ => "linked",
        };
        let shadows = shadow_maps::axis(choices.maps.is_some());
        let fragment = variant(FRAG_VARIANTS, &[samples, mesh::vertex_name(scene), shadows, redraw::axis(choices)]);
        Ok(Self {
            redraw: TriangleRedraw::new(gpu, scene, resources, choices, frame, fragment)?,
            name: choices.brute_pass(),
        })
    }

    /// The lists of which these are the strays; the barrier of the shadow maps.
    #[allow(clippy::too_many_arguments)]
    pub fn record(
        &self,
        cmd: &mut Commands,
        scene: &SceneGpu,
        list: &DrawList,
        primitives: &Primitives,
        bound: &[(&'static str, Bound<'_>)],
        samples: Option<&Samples>,
        (lists, maps): (Option<&Lists>, Option<Barrier>),
        colors: &Buffer,
        counters: &Buffer,
    ) -> Result<()> {
        let traffic = Traffic {
            read_bytes: self.redraw.read_bytes(cmd.gpu(), scene, list, samples),
            // Counted after the frame.
            written_bytes: 0,
            invocations: None,
        };
        cmd.pass(&full(self.name), traffic, |cmd| {
            cmd.barriers(maps);
            match self.redraw.stray_draws() {
                Some(stray_draws) => stray_draws.record(cmd, counters),
                None => cmd.barriers([counters.from(Access::FragmentWrite).to(Access::FragmentWrite)]),
            }
            if let Some(lists) = lists {
                cmd.barriers([colors.from(Access::FragmentWrite).to(Access::FragmentWrite)]);
                lists.links_to(cmd, Access::ComputeRead | Access::GraphicsRead, Access::GraphicsRead);
            } else {
                cmd.barriers([colors.discard(Access::TransferWrite)]);
                cmd.clear(colors);
                cmd.barriers([colors.from(Access::TransferWrite).to(Access::FragmentWrite)]);
            }
            if samples.is_none() {
                let addresses = lists.and_then(|lists| lists.addresses.as_ref());
                cmd.barriers(addresses.map(|addresses| addresses.from(Access::ComputeWrite).to(Access::GraphicsRead)));
            }
            let samples = samples.map(|samples| {
                // With lists compute shaders read them first: what wrote them was waited for by those alone.
                let left = match lists {
                    Some(_) => Access::ComputeSample | samples.written,
                    None => AccessSet::from(samples.written),
                };
                (samples, left)
            });
            let mut bound = bound.to_vec();
            bound.extend(lists.map(Lists::bound).into_iter().flatten());
            bound.extend([("Colors", Bound::Buffer(colors)), ("Counters", Bound::Buffer(counters))]);
            self.redraw.record(cmd, scene, list, primitives, samples, bound)
        })
    }
}
