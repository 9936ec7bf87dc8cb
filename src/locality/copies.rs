//! The copies of interleaved deferred shading as kernels: what each shader of its splits and gathers reads and writes, by the twin of
//! its mapping. Mirrors glsl/techniques/interleaved_deferred/split and gather.

use super::access::{Access, Kernel};
use super::frame::{Resource, Space, TEXEL_BYTES, Texels};
use super::layout::Layout;
use crate::gpu::shader::structs::MappingParams;
use crate::techniques::interleaved_deferred::split_method::{Form, StorageKind};

/// Which copy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pass {
    SplitOnePass,
    SplitBlocks,
    SplitTranslate,
    SplitTile,
    GatherOnePass,
    GatherTranslate,
    GatherBlocks,
    GatherTile,
}

impl Pass {
    /// As reports call it, without the technique.
    pub fn name(self) -> &'static str {
        match self {
            Self::SplitOnePass => "split",
            Self::SplitBlocks => "split.blocks",
            Self::SplitTranslate => "split.translate",
            Self::SplitTile => "split.tile",
            Self::GatherOnePass => "gather",
            Self::GatherTranslate => "gather.translate",
            Self::GatherBlocks => "gather.blocks",
            Self::GatherTile => "gather.tile",
        }
    }

    fn is_gather(self) -> bool {
        matches!(self, Self::GatherOnePass | Self::GatherTranslate | Self::GatherBlocks | Self::GatherTile)
    }
}

/// The memory of a frame's copies.
#[derive(Clone, Copy)]
pub struct Memory {
    /// Position and normal of the G-buffer, images.
    pub gbuffer: [Resource; 2],
    /// Between two passes.
    pub blocks: Texels,
    pub sub_buffers: Texels,
    /// Irradiance in frame order, a buffer.
    pub gathered: Resource,
}

impl Memory {
    pub fn new(mapping: &MappingParams, storage: StorageKind, layout: Layout) -> Self {
        let mut space = Space::default();
        let mut image = || space.image(layout, mapping.extent());
        let gbuffer = [image(), image()];
        let blocks = Texels::new(&mut space, storage, layout, mapping);
        let sub_buffers = Texels::new(&mut space, storage, layout, mapping);
        let gathered = space.buffer(mapping.frame_texel_count());
        Self { gbuffer, blocks, sub_buffers, gathered }
    }
}

/// A copy of one frame.
pub struct Copy<'a> {
    pub pass: Pass,
    pub form: Form,
    pub mapping: &'a MappingParams,
    pub memory: &'a Memory,
    /// Invocations of a workgroup, across and down.
    pub group_size: [u32; 2],
}

/// Where a texel lies, of the three orders.
#[derive(Clone, Copy)]
enum Place {
    Frame([u32; 2]),
    Block([u32; 2]),
    Texel([u32; 3]),
}

impl Copy<'_> {
    /// Texels that a thread moves (RUN of sub_buffers.glsl).
    fn run(&self) -> u32 {
        if self.memory.sub_buffers.storage == StorageKind::Buffer { 2 } else { 1 }
    }

    /// Parts of a surface, or the irradiance.
    fn parts(&self) -> usize {
        if self.pass.is_gather() { 1 } else { 2 }
    }

    /// Invocations that a pass asks for; those of tiles are workgroups.
    fn threads(&self) -> [u32; 3] {
        let mapping = self.mapping;
        let padded = [mapping.padded().width.div_ceil(self.run()), mapping.padded().height, 1];
        let [across, down] = [mapping.sub_width_px.div_ceil(self.run()), mapping.sub_height_px];
        let pairs = [mapping.width_px.div_ceil(2), mapping.height_px, 1];
        match (self.pass, self.form) {
            // Sub-buffers before rows: as the shader has them.
            (Pass::SplitOnePass, Form::Pull) => [across, mapping.subset_count(), down],
            (Pass::SplitTranslate, Form::Pull) | (Pass::GatherOnePass | Pass::GatherTranslate, Form::Push) => {
                [across, down, mapping.subset_count()]
            }
            (Pass::GatherOnePass | Pass::GatherBlocks, Form::Pull) => pairs,
            _ => padded,
        }
    }

    fn is_tile(&self) -> bool {
        matches!(self.pass, Pass::SplitTile | Pass::GatherTile)
    }

    fn read(&self, part: usize, place: Place) -> Option<Access> {
        let address = match place {
            Place::Frame(pixel) => {
                let [x, y] = pixel;
                let held = [x.min(self.mapping.width_px - 1), y.min(self.mapping.height_px - 1)];
                // A pixel of the padding has no normal.
                if part == 1 && !self.mapping.is_in_frame(pixel) {
                    return None;
                }
                self.memory.gbuffer[part].texel(held)
            }
            Place::Block(at) => self.memory.blocks.of_block(part, self.mapping, at),
            Place::Texel(texel) => self.memory.sub_buffers.of_sub_buffer(part, self.mapping, texel),
        };
        Some(Access::read(address, TEXEL_BYTES))
    }

    fn write(&self, part: usize, place: Place, texels: u32) -> Option<Access> {
        let address = match place {
            Place::Frame(pixel) if !self.mapping.is_in_frame(pixel) => return None,
            Place::Frame([x, y]) => {
                let index = u64::from(y) * u64::from(self.mapping.row_pitch()) + u64::from(x);
                self.memory.gathered.entry(index)
            }
            Place::Block(at) => self.memory.blocks.of_block(part, self.mapping, at),
            Place::Texel(texel) => self.memory.sub_buffers.of_sub_buffer(part, self.mapping, texel),
        };
        Some(Access::write(address, TEXEL_BYTES * texels))
    }

    /// A run of texels: read one after the other, and written together where words of neighbours go out together.
    fn moved(&self, run: &[(Place, Place)], together: bool, out: &mut Vec<Option<Access>>) {
        let parts = 0..self.parts();
        if !together {
            for (from, to) in run {
                out.extend(parts.clone().map(|part| self.read(part, *from)));
                out.extend(parts.clone().map(|part| self.write(part, *to, 1)));
            }
            return;
        }
        for (from, _) in run {
            out.extend(parts.clone().map(|part| self.read(part, *from)));
        }
        out.extend(parts.map(|part| self.write(part, run[0].1, run.len() as u32)));
    }

    fn tile(&self, [block_x, block_y, _]: [u32; 3], [x, y]: [u32; 2], out: &mut Vec<Option<Access>>) {
        let mapping = self.mapping;
        let [width, height] = [mapping.block_x, mapping.block_y];
        let sub_block = [width / mapping.pattern_x, height / mapping.pattern_y];
        let [threads_x, threads_y] = self.group_size;
        let (threads, texels) = (threads_x * threads_y, width * height);
        let indices = || (y * threads_x + x..texels).step_by(threads as usize);
        let in_frame = |index: u32| Place::Frame([block_x * width + index % width, block_y * height + index / width]);
        let in_sub_buffer = |index: u32| {
            let row = index / sub_block[0];
            let moved = [index % sub_block[0], row % sub_block[1], row / sub_block[1]];
            Place::Texel([moved[0] + block_x * sub_block[0], moved[1] + block_y * sub_block[1], moved[2]])
        };
        for index in indices() {
            let from = if self.pass == Pass::SplitTile { in_frame(index) } else { in_sub_buffer(index) };
            out.extend((0..self.parts()).map(|part| self.read(part, from)));
        }
        for index in indices() {
            let to = if self.pass == Pass::SplitTile { in_sub_buffer(index) } else { in_frame(index) };
            out.extend((0..self.parts()).map(|part| self.write(part, to, 1)));
        }
    }
}

impl Kernel for Copy<'_> {
    fn groups(&self) -> [u32; 3] {
        if self.is_tile() {
            let [across, down] = self.mapping.block_counts();
            return [across, down, 1];
        }
        let ([x, y, z], [width, height]) = (self.threads(), self.group_size);
        [x.div_ceil(width), y.div_ceil(height), z]
    }

    fn group_size(&self) -> [u32; 2] {
        self.group_size
    }

    fn accesses(&self, group: [u32; 3], local: [u32; 2], out: &mut Vec<Option<Access>>) {
        if self.is_tile() {
            return self.tile(group, local, out);
        }
        let (mapping, run) = (self.mapping, self.run());
        let [x, y, z] = [group[0] * self.group_size[0] + local[0], group[1] * self.group_size[1] + local[1], group[2]];
        let is_in_padded = x * run < mapping.padded().width && y < mapping.padded().height;
        let is_texel =
            |[x, y, z]: [u32; 3]| x < mapping.sub_width_px && y < mapping.sub_height_px && z < mapping.subset_count();
        // Texels of a row of one of the three orders, and where each of them comes from or goes to.
        let in_padded = |to: &dyn Fn([u32; 2]) -> (Place, Place)| -> Option<Vec<(Place, Place)>> {
            is_in_padded.then(|| (0..run).map(|step| to([x * run + step, y])).collect())
        };
        let in_sub_buffer = |first: [u32; 3], to: &dyn Fn([u32; 3]) -> (Place, Place)| -> Option<Vec<(Place, Place)>> {
            is_texel(first).then(|| (0..run).map(|step| to([first[0] + step, first[1], first[2]])).collect())
        };
        let in_frame = |from: &dyn Fn([u32; 2]) -> Place| -> Option<Vec<(Place, Place)>> {
            let pair = [[x * 2, y], [(x * 2 + 1).min(mapping.width_px - 1), y]];
            mapping.is_in_frame(pair[0]).then(|| pair.map(|pixel| (from(pixel), Place::Frame(pair[0]))).to_vec())
        };
        let moved = match (self.pass, self.form) {
            (Pass::SplitOnePass, Form::Pull) => in_sub_buffer([x * run, z, y], &|texel| {
                (Place::Frame(mapping.pixel_of_texel(texel)), Place::Texel(texel))
            }),
            (Pass::SplitOnePass, Form::Push) => {
                in_padded(&|pixel| (Place::Frame(pixel), Place::Texel(mapping.texel_of_pixel(pixel))))
            }
            (Pass::SplitBlocks, Form::Pull) => {
                in_padded(&|at| (Place::Frame(mapping.pixel_of_block_texel(at)), Place::Block(at)))
            }
            (Pass::SplitBlocks, Form::Push) => {
                in_padded(&|pixel| (Place::Frame(pixel), Place::Block(mapping.block_texel_of_pixel(pixel))))
            }
            (Pass::SplitTranslate, Form::Pull) => in_sub_buffer([x * run, y, z], &|texel| {
                (Place::Block(mapping.block_texel_of_texel(texel)), Place::Texel(texel))
            }),
            (Pass::SplitTranslate, Form::Push) => {
                in_padded(&|at| (Place::Block(at), Place::Texel(mapping.texel_of_block_texel(at))))
            }
            (Pass::GatherOnePass, Form::Pull) => in_frame(&|pixel| Place::Texel(mapping.texel_of_pixel(pixel))),
            (Pass::GatherOnePass, Form::Push) => in_sub_buffer([x * run, y, z], &|texel| {
                (Place::Texel(texel), Place::Frame(mapping.pixel_of_texel(texel)))
            }),
            (Pass::GatherTranslate, Form::Pull) => {
                in_padded(&|at| (Place::Texel(mapping.texel_of_block_texel(at)), Place::Block(at)))
            }
            (Pass::GatherTranslate, Form::Push) => in_sub_buffer([x * run, y, z], &|texel| {
                (Place::Texel(texel), Place::Block(mapping.block_texel_of_texel(texel)))
            }),
            (Pass::GatherBlocks, Form::Pull) => in_frame(&|pixel| Place::Block(mapping.block_texel_of_pixel(pixel))),
            (Pass::GatherBlocks, Form::Push) => {
                in_padded(&|at| (Place::Block(at), Place::Frame(mapping.pixel_of_block_texel(at))))
            }
            (Pass::SplitTile | Pass::GatherTile, _) => unreachable!("tiles have returned"),
        };
        let pairs_go_together = matches!(self.pass, Pass::GatherOnePass | Pass::GatherBlocks);
        let together = self.form == Form::Pull && (run == 2 || pairs_go_together);
        if let Some(moved) = moved {
            self.moved(&moved, together, out);
        }
    }
}
