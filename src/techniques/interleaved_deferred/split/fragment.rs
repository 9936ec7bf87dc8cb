//! Split by fragment programs and look-up textures, in one pass or in two: Segovia 2006, sections 3.2, 3.3 and 4.2.
//! Shaders: fullscreen.vert, fragment.frag.
//! reads   gbuffer.position, gbuffer.normal, gbuffer.color where it is moved, split.lookup (one pass), split.lookup_blocks and
//!         split.lookup_translate (two)
//! writes  split.position, split.normal, split.color  images; between two passes split.blocks.position, .normal, .color

use super::super::choices::Choices;
use super::super::lookup::{self, Lookup};
use super::super::split_method::Copier;
use super::super::sub_buffers::{Surface, words_format};
use crate::error::Result;
use crate::gpu::pipeline::{GraphicsDescription, GraphicsPipeline};
use crate::gpu::shader::structs::MappingParams;
use crate::gpu::shader::techniques::interleaved_deferred::split::fragment::FRAG_VARIANTS;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Barrier, Bound, ColorTarget, Commands, Edge, Gpu, Traffic};
use crate::passes::fullscreen;
use crate::passes::gbuffer::GBuffer;
use crate::plan::{Plan, Resources};
use crate::techniques::interleaved_deferred::resources::NAME;
use std::sync::Arc;

/// Plans the look-up textures that `by` needs.
pub fn plan(plan: &mut Plan, mapping: &MappingParams, by: Copier) {
    let lookups: &[&str] = match by {
        Copier::OneFragmentPass => &["split.lookup"],
        Copier::TwoFragmentPasses => &["split.lookup_blocks", "split.lookup_translate"],
        Copier::OnePass | Copier::TwoPass | Copier::Tile => &[],
    };
    lookups.iter().for_each(|what| Lookup::plan(plan, what, mapping.padded()));
}

/// What a draw reads.
struct Source<'a> {
    barriers: Vec<Barrier>,
    bound: Vec<(&'static str, Bound<'a>)>,
    /// Texels that are read, and the bytes of each.
    texels: u64,
    texel_bytes: u64,
}

/// One draw: a fragment program with its look-up texture.
struct Program {
    pipeline: GraphicsPipeline,
    lookup: Lookup,
}

impl Program {
    /// `reads_frame`: and not the block layout.
    fn new(gpu: &Arc<Gpu>, choices: &Choices, reads_frame: bool, lookup: Lookup) -> Result<Self> {
        let (parts, position) = (choices.moved, choices.shading.position);
        let formats = [words_format(position.bytes()), words_format(8), words_format(8)];
        let source = if reads_frame { "frame" } else { "blocks" };
        let shader = variant(FRAG_VARIANTS, &[position.name(), source, parts.color_name()]);
        let constants: Vec<_> = parts.constant().into_iter().filter(|_| reads_frame).collect();
        let count = if parts.has_color() { 3 } else { 2 };
        let description =
            GraphicsDescription { constants: &constants, ..fullscreen::description(shader, &formats[..count]) };
        Ok(Self { pipeline: GraphicsPipeline::new(gpu, &description)?, lookup })
    }

    fn record(
        &self,
        cmd: &mut Commands,
        pass: &str,
        mapping: &MappingParams,
        source: Source<'_>,
        target: &Surface,
    ) -> Result<()> {
        let traffic = Traffic {
            read_bytes: Some(source.texels * source.texel_bytes + mapping.texel_count() * lookup::TEXEL_BYTES),
            written_bytes: Some(mapping.texel_count() * target.texel_bytes),
            invocations: None,
        };
        cmd.pass(&format!("{NAME}.{pass}"), traffic, |cmd| {
            cmd.barriers(source.barriers);
            cmd.barriers(target.discard(Access::ColorWrite));
            // Every texel is drawn: a clear spares the load.
            let clear = Some(Default::default());
            let colors: Vec<_> = target.all().map(|part| ColorTarget::new(part.attachment(), clear)).collect();
            cmd.begin_rendering(mapping.padded(), &colors, None);
            let mut bound = source.bound;
            bound.push(self.lookup.bound());
            cmd.bind_graphics(&self.pipeline, &[], &bound)?;
            fullscreen::draw(cmd, 0);
            cmd.end_rendering();
            Ok(())
        })
    }

    fn record_from_frame(
        &self,
        cmd: &mut Commands,
        pass: &str,
        mapping: &MappingParams,
        gbuffer: Edge<'_, GBuffer>,
        target: &Surface,
    ) -> Result<()> {
        let source = Source {
            barriers: gbuffer.parts_to(target.parts, Access::FragmentSample),
            bound: gbuffer.resource.bound_parts(target.parts),
            // Padding is written, and read nowhere.
            texels: mapping.extent().pixel_count(),
            texel_bytes: gbuffer.resource.parts_bytes(target.parts),
        };
        self.record(cmd, pass, mapping, source, target)
    }
}

/// In one pass.
pub struct FragmentSplit(Program);

impl FragmentSplit {
    pub fn new(gpu: &Arc<Gpu>, resources: &mut Resources, choices: &Choices) -> Result<Self> {
        let mapping = &choices.mapping;
        let pixel_at = |at| mapping.pixel_of_texel(mapping.texel_of_tiled(at));
        let source_of = |at| Some(pixel_at(at)).filter(|pixel| mapping.is_in_frame(*pixel));
        let lookup = Lookup::new(gpu, resources, "split.lookup", source_of)?;
        Ok(Self(Program::new(gpu, choices, true, lookup)?))
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        mapping: &MappingParams,
        gbuffer: Edge<'_, GBuffer>,
        split: &Surface,
    ) -> Result<()> {
        self.0.record_from_frame(cmd, "split", mapping, gbuffer, split)
    }
}

/// In two passes: block splitting, block translation.
pub struct FragmentSplitBlocks {
    blocks: Program,
    between: Surface,
    translate: Program,
}

impl FragmentSplitBlocks {
    pub fn new(gpu: &Arc<Gpu>, resources: &mut Resources, choices: &Choices, between: Surface) -> Result<Self> {
        let mapping = &choices.mapping;
        let pixel_of = |at| Some(mapping.pixel_of_block_texel(at)).filter(|pixel| mapping.is_in_frame(*pixel));
        let blocks = Lookup::new(gpu, resources, "split.lookup_blocks", pixel_of)?;
        let block_texel_of = |at| Some(mapping.block_texel_of_texel(mapping.texel_of_tiled(at)));
        let translate = Lookup::new(gpu, resources, "split.lookup_translate", block_texel_of)?;
        Ok(Self {
            blocks: Program::new(gpu, choices, true, blocks)?,
            between,
            translate: Program::new(gpu, choices, false, translate)?,
        })
    }

    pub fn record(
        &self,
        cmd: &mut Commands,
        mapping: &MappingParams,
        gbuffer: Edge<'_, GBuffer>,
        split: &Surface,
    ) -> Result<()> {
        self.blocks.record_from_frame(cmd, "split.blocks", mapping, gbuffer, &self.between)?;
        let source = Source {
            barriers: self.between.from(Access::ColorWrite).to(split.parts, Access::FragmentSample),
            bound: self.between.source(split.parts).collect(),
            texels: mapping.texel_count(),
            texel_bytes: split.texel_bytes,
        };
        self.translate.record(cmd, "split.translate", mapping, source, split)
    }
}
