//! SPIDs from what is nearest to each sample, a layer at a time. Shader: spids.frag.
//! reads   visibility.nearest, the scene, the tuples
//! writes  visibility.spids and, with `--zmax on`, visibility.shading_depths, as visibility/mod.rs has them

use super::super::choices::Choices;
use super::super::primitives::Primitives;
use super::super::ranges;
use crate::error::Result;
use crate::gpu::pipeline::{GraphicsDescription, GraphicsPipeline};
use crate::gpu::shader::techniques::deep_shading::visibility::spids::FRAG_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Gpu, Layers};
use crate::passes::fullscreen;
use crate::plan::{Plan, Resources};
use crate::resident::SceneGpu;
use crate::techniques::deep_shading::choices::constants_of;
use crate::techniques::deep_shading::pass_inputs::DrawInputs;
use crate::techniques::deep_shading::resources::{SHADING_DEPTH_FORMAT, SPID_FORMAT, full};
use crate::techniques::deep_shading::visibility::samples::Samples;
use std::sync::Arc;

const RANGES: &str = "visibility.draws";

/// `draws` of the scene.
pub(super) fn plan(plan: &mut Plan, draws: u64) {
    ranges::plan(plan, full(RANGES), draws);
}

pub(super) struct Spids {
    pipeline: GraphicsPipeline,
    ranges: Buffer,
}

impl Spids {
    pub(super) fn new(
        gpu: &Arc<Gpu>,
        scene: &SceneGpu,
        resources: &mut Resources,
        choices: &Choices,
        primitives: &Primitives,
    ) -> Result<Self> {
        let fragment = variant(FRAG_VARIANTS, &[if choices.lists.has_zmax { "shading" } else { "none" }]);
        let formats = [SPID_FORMAT, SHADING_DEPTH_FORMAT];
        let formats = if choices.lists.has_zmax { &formats[..] } else { &formats[..1] };
        let constants = constants_of(choices, &[Some(fragment)]);
        let description = GraphicsDescription { constants: &constants, ..fullscreen::description(fragment, formats) };
        let ranges = resources.buffer(&full(RANGES));
        let order = |draw, first_index| primitives.order(draw, first_index);
        ranges::write(gpu, &ranges, scene, primitives, primitives.ordered().iter(), order, Access::GraphicsRead)?;
        Ok(Self { pipeline: GraphicsPipeline::new(gpu, &description)?, ranges })
    }

    /// Records the pass over the part of each layer that lies in the frame.
    pub(super) fn record(
        &self,
        cmd: &mut Commands,
        inputs: DrawInputs<'_>,
        bound: &[(&'static str, Bound<'_>)],
        samples: &Samples,
    ) -> Result<()> {
        let mut bound = bound.to_vec();
        bound.push(("OrderedRanges", Bound::Buffer(&self.ranges)));
        let set = cmd.set_for(&self.pipeline, &self.pipeline.interface.own(&bound))?;
        for tuple in 0..samples.spids.description.layers() {
            samples.begin(cmd, Layers::One(tuple));
            cmd.set_scissor([0, 0], inputs.table.inside(inputs.frame, tuple));
            cmd.bind_with_set(&self.pipeline, &[], set);
            fullscreen::draw(cmd, tuple);
            cmd.end_rendering();
        }
        Ok(())
    }
}
