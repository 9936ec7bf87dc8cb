//! Samples shaded where they are seen, each by itself, at their shading points: all of them (`--lists none`, the oracle), or
//! the strays alone (pass of that name). Shaders: those before fragments of visibility, brute.frag.
//! reads  the scene, its lights, visibility.spids, visibility.depth, the lists      writes  shade.colors

use super::choices::{Choices, ListChoices};
use super::lists::ListsEdge;
use super::pass_inputs::{DrawInputs, ShadingEdges};
use super::redraw::{self, TriangleRedraw};
use crate::error::Result;
use crate::gpu::shader::techniques::deep_shading::brute::FRAG_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Commands, Gpu, Traffic};
use crate::passes::{mesh, shadow_maps};
use crate::plan::Resources;
use crate::resident::SceneGpu;
use crate::techniques::deep_shading::resources::full;
use crate::techniques::deep_shading::visibility::samples::SeenSamples;
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
            Choices { lists: ListChoices { is_direct: true, .. }, .. } => "direct",
            Choices { lists: ListChoices { is_compacted: true, .. }, .. } => "compact",
            _ => "linked",
        };
        let shadows = shadow_maps::axis(choices.maps.is_some());
        let fragment = variant(FRAG_VARIANTS, &[samples, mesh::vertex_name(scene), shadows, redraw::axis(choices)]);
        Ok(Self {
            redraw: TriangleRedraw::new(gpu, scene, resources, choices, frame, fragment)?,
            name: choices.brute_pass(),
        })
    }

    /// `seen`: None where lists alone say what samples see. `lists`: those of which these are the strays; None: all samples are
    /// shaded here, and nothing has touched their colours.
    pub fn record(
        &self,
        cmd: &mut Commands,
        inputs: DrawInputs<'_>,
        seen: Option<SeenSamples<'_>>,
        lists: Option<ListsEdge<'_>>,
        edges: ShadingEdges<'_>,
    ) -> Result<()> {
        let ShadingEdges { colors, counters, maps } = edges;
        let traffic = Traffic {
            read_bytes: self.redraw.read_bytes(cmd.gpu(), inputs, seen),
            // Counted after the frame.
            written_bytes: 0,
            invocations: None,
        };
        cmd.pass(&full(self.name), traffic, |cmd| {
            cmd.barriers(maps.and_then(|maps| maps.to(Access::FragmentSample)));
            match self.redraw.stray_draws() {
                Some(stray_draws) => stray_draws.record(cmd, counters),
                None => cmd.barriers([counters.to(Access::FragmentWrite)]),
            }
            if let Some(lists) = lists {
                cmd.barriers([colors.to(Access::FragmentWrite)]);
                cmd.barriers(lists.links_to(Access::GraphicsRead));
                if seen.is_none() {
                    cmd.barriers(lists.addresses_to(Access::GraphicsRead));
                }
            } else {
                let colors = colors.resource;
                cmd.barriers([colors.discard(Access::TransferWrite)]);
                cmd.clear(colors);
                cmd.barriers([colors.from(Access::TransferWrite).to(Access::FragmentWrite)]);
            }
            let mut bound = inputs.bound.to_vec();
            bound.extend(lists.map(|edge| edge.lists.bound()).into_iter().flatten());
            bound.extend(
                [("Colors", colors), ("Counters", counters)].map(|(name, edge)| (name, Bound::Buffer(edge.resource))),
            );
            self.redraw.record(cmd, inputs, seen, bound)
        })
    }
}
