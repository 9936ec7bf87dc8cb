//! Gather by fragment programs and look-up textures, in one pass or in two: Segovia 2006, sections 3.4 and 4.4.
//! Shaders: fullscreen.vert, fragment.frag.
//! reads   shade.irradiance  image, gather.lookup (one pass), gather.lookup_translate and gather.lookup_blocks (two)
//! writes  gather.irradiance  buffer, frame order, by way of gather.drawn; between two passes gather.blocks.irradiance

use super::super::choices::Choices;
use super::super::drawn_irradiance::{self, DrawnIrradiance};
use super::super::lookup::{self, Lookup};
use super::super::split_method::Copier;
use super::super::sub_buffers::Texels;
use crate::error::Result;
use crate::gpu::pipeline::GraphicsPipeline;
use crate::gpu::shader::structs::MappingParams;
use crate::gpu::shader::techniques::interleaved_deferred::gather::fragment::FRAG;
use crate::gpu::{Access, Buffer, ColorTarget, Commands, Edge, Gpu, Traffic};
use crate::passes::fullscreen;
use crate::plan::{Plan, Resources};
use crate::techniques::interleaved_deferred::resources::NAME;
use std::sync::Arc;

/// Plans the look-up textures that `by` needs, and the image that is drawn last.
pub fn plan(plan: &mut Plan, mapping: &MappingParams, by: Copier) {
    match by {
        Copier::OneFragmentPass => Lookup::plan(plan, "gather.lookup", mapping.extent()),
        Copier::TwoFragmentPasses => {
            Lookup::plan(plan, "gather.lookup_translate", mapping.padded());
            Lookup::plan(plan, "gather.lookup_blocks", mapping.extent());
        }
        Copier::OnePass | Copier::TwoPass | Copier::Tile => return,
    }
    DrawnIrradiance::plan(plan, "gather", mapping);
}

/// The fragment program with one of its look-up textures.
struct Program {
    pipeline: GraphicsPipeline,
    lookup: Lookup,
}

impl Program {
    fn new(gpu: &Arc<Gpu>, lookup: Lookup) -> Result<Self> {
        let formats = [drawn_irradiance::FORMAT];
        Ok(Self { pipeline: GraphicsPipeline::new(gpu, &fullscreen::description(&FRAG, &formats))?, lookup })
    }

    fn draw(&self, cmd: &mut Commands, source: &Texels) -> Result<()> {
        let bound = [self.lookup.bound(), ("source_irradiance", source.source())];
        cmd.bind_graphics(&self.pipeline, &[], &bound)?;
        fullscreen::draw(cmd, 0);
        Ok(())
    }
}

/// The program that ends in frame order, and the image that it draws.
struct LastProgram {
    program: Program,
    drawn: DrawnIrradiance,
}

impl LastProgram {
    fn record(
        &self,
        cmd: &mut Commands,
        pass: &str,
        mapping: &MappingParams,
        source: Edge<'_, Texels>,
        irradiance: &Buffer,
    ) -> Result<()> {
        let pixels = mapping.extent().pixel_count();
        let traffic = Traffic {
            read_bytes: Some(pixels * (8 + lookup::TEXEL_BYTES) + self.drawn.bytes()),
            written_bytes: Some(pixels * 8 + self.drawn.bytes()),
            invocations: None,
        };
        cmd.pass(&format!("{NAME}.{pass}"), traffic, |cmd| {
            cmd.barriers([source.to(Access::FragmentSample)]);
            let draws = |cmd: &mut Commands| self.program.draw(cmd, source.resource);
            self.drawn.record(cmd, mapping, None, irradiance, draws)
        })
    }
}

/// In one pass.
pub struct FragmentGather(LastProgram);

impl FragmentGather {
    pub fn new(gpu: &Arc<Gpu>, resources: &mut Resources, choices: &Choices) -> Result<Self> {
        let mapping = &choices.mapping;
        let tiled_of = |pixel| Some(mapping.tiled_of(mapping.texel_of_pixel(pixel)));
        let program = Program::new(gpu, Lookup::new(gpu, resources, "gather.lookup", tiled_of)?)?;
        Ok(Self(LastProgram { program, drawn: DrawnIrradiance::new(resources, "gather") }))
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        mapping: &MappingParams,
        source: Edge<'_, Texels>,
        irradiance: &Buffer,
    ) -> Result<()> {
        self.0.record(cmd, "gather", mapping, source, irradiance)
    }
}

/// In two passes: block translation, block gathering.
pub struct FragmentGatherBlocks {
    translate: Program,
    between: Texels,
    blocks: LastProgram,
}

impl FragmentGatherBlocks {
    pub fn new(gpu: &Arc<Gpu>, resources: &mut Resources, choices: &Choices, between: Texels) -> Result<Self> {
        let mapping = &choices.mapping;
        let tiled_of = |at| Some(mapping.tiled_of(mapping.texel_of_block_texel(at)));
        let translate = Lookup::new(gpu, resources, "gather.lookup_translate", tiled_of)?;
        let block_texel_of = |pixel| Some(mapping.block_texel_of_pixel(pixel));
        let blocks = Lookup::new(gpu, resources, "gather.lookup_blocks", block_texel_of)?;
        Ok(Self {
            translate: Program::new(gpu, translate)?,
            between,
            blocks: LastProgram {
                program: Program::new(gpu, blocks)?,
                drawn: DrawnIrradiance::new(resources, "gather"),
            },
        })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        mapping: &MappingParams,
        source: Edge<'_, Texels>,
        irradiance: &Buffer,
    ) -> Result<()> {
        let texels = mapping.texel_count();
        let traffic = Traffic {
            read_bytes: Some(texels * (8 + lookup::TEXEL_BYTES)),
            written_bytes: Some(texels * 8),
            invocations: None,
        };
        cmd.pass(&format!("{NAME}.gather.translate"), traffic, |cmd| {
            cmd.barriers([source.to(Access::FragmentSample), self.between.discard(Access::ColorWrite)]);
            // Every texel is drawn: a clear spares the load.
            let colors = [ColorTarget::new(self.between.attachment(), Some(Default::default()))];
            cmd.begin_rendering(mapping.padded(), &colors, None);
            self.translate.draw(cmd, source.resource)?;
            cmd.end_rendering();
            Ok(())
        })?;
        let between = self.between.from(Access::ColorWrite);
        self.blocks.record(cmd, "gather.blocks", mapping, between, irradiance)
    }
}
