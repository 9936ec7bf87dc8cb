//! What `bench device` draws: a grid of squares, of two triangles each, again and again. Shaders: triangles.vert, triangles.frag.
//! reads  indices, 4 B a corner of a triangle      writes  target, 1 B a pixel
//!
//! Triangles that are measured by their number lie in squares of a pixel: the grid lies a quarter of a pixel farther right and an eighth
//! farther down than the pixels, so that no edge meets a middle, and one triangle of each square covers one pixel, the other none. Of those
//! that are turned away none is drawn: a device does no more with them than it must with any.

use super::work::GROUP;
use crate::bench::rounds::{Probe, last_pass};
use crate::error::Result;
use crate::gpu::commands::{Submits, Traffic};
use crate::gpu::pipeline::{GraphicsDescription, GraphicsPipeline};
use crate::gpu::recorded::Recorded;
use crate::gpu::shader::bench::device::triangles::{FRAG, TRIANGLES_COLUMN_BITS, VERT};
use crate::gpu::shader::structs::TrianglesParams;
use crate::gpu::{Access, Berth, Buffer, ColorTarget, Commands, Gpu, Image, ImageDescription, readback, upload};
use crate::memory::kinds::Use;
use crate::passes::fullscreen;
use crate::units::Extent;
use ash::vk;
use std::sync::Arc;

/// A byte a pixel: the least that a fragment can write.
const FORMAT: vk::Format = vk::Format::R8_UINT;
/// How far right and down of the target's corner the grid begins, pixels: parts that every device's rasteriser tells apart.
const SHIFT_PX: [f32; 2] = [0.25, 0.125];
/// Squares whose triangles follow each other from left to right, before those below them: few enough that a device still has the
/// vertices of the row above.
const STRIP_SQUARES: u32 = 4;

/// What is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drawn {
    /// Triangles that cover a pixel or none.
    Triangles,
    /// The same, seen from behind.
    TurnedAway,
    /// Triangles that cover half of the target each.
    Fill,
}

/// How much of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grid {
    /// Pixels of a side of the target, a power of two.
    pub side_px: u32,
    /// Squares of a side of the grid, which covers the target: a power of two, up to 512.
    pub squares: u32,
    /// How often it is drawn, 1 to 255.
    pub draws: u32,
}

impl Drawn {
    /// All that is measured.
    pub const ALL: [Self; 3] = [Self::Triangles, Self::TurnedAway, Self::Fill];

    /// Name in rows.
    pub fn name(self) -> &'static str {
        match self {
            Self::Triangles => "triangles",
            Self::TurnedAway => "triangles turned away",
            Self::Fill => "fill",
        }
    }

    /// As much as is measured: four million triangles, or 268 million pixels.
    pub fn grid(self) -> Grid {
        match self {
            Self::Triangles | Self::TurnedAway => Grid { side_px: 512, squares: 512, draws: 8 },
            Self::Fill => Grid { side_px: 2048, squares: 1, draws: 64 },
        }
    }

    /// Triangles of `grid`, where it is they that take the time.
    pub fn triangle_count(self, grid: Grid) -> Option<u64> {
        (self != Self::Fill).then(|| grid.triangle_count())
    }

    /// Pixels that are drawn of `grid`, those of each draw anew, where it is they that take the time.
    pub fn pixel_count(self, grid: Grid) -> Option<u64> {
        (self == Self::Fill).then(|| grid.pixel_count())
    }

    /// Bytes that are read and written: indices, and pixels with their clear.
    pub fn moved_bytes(self, grid: Grid) -> [u64; 2] {
        let drawn = if self == Self::TurnedAway { 0 } else { grid.pixel_count() };
        [12 * grid.triangle_count(), grid.extent().pixel_count() + drawn]
    }

    /// Corners follow each other clockwise on the screen.
    fn front_face(self) -> vk::FrontFace {
        if self == Self::TurnedAway { vk::FrontFace::COUNTER_CLOCKWISE } else { vk::FrontFace::CLOCKWISE }
    }
}

impl Grid {
    fn extent(self) -> Extent {
        Extent::new(self.side_px, self.side_px)
    }

    fn triangle_count(self) -> u64 {
        2 * u64::from(self.squares).pow(2) * u64::from(self.draws)
    }

    fn pixel_count(self) -> u64 {
        self.extent().pixel_count() * u64::from(self.draws)
    }

    /// Indices of all its triangles, once.
    fn indices(self) -> Vec<u32> {
        let at = |column: u32, row: u32| row << TRIANGLES_COLUMN_BITS | column;
        let strips = (0..self.squares).step_by(STRIP_SQUARES as usize);
        let squares = strips.flat_map(|left| {
            let right = (left + STRIP_SQUARES).min(self.squares);
            (0..self.squares).flat_map(move |row| (left..right).map(move |column| [column, row]))
        });
        let triangles = squares.flat_map(|[x, y]| {
            let across = [at(x + 1, y), at(x, y + 1)];
            [at(x, y), across[0], across[1], across[0], at(x + 1, y + 1), across[1]]
        });
        triangles.collect()
    }

    /// Those of its draw `number`. Sides are powers of two: every place is exact.
    fn params(self, number: u32) -> TrianglesParams {
        let origin_ndc = SHIFT_PX.map(|shift| 2.0 * shift / self.side_px as f32 - 1.0);
        TrianglesParams { origin_ndc, step_ndc: 2.0 / self.squares as f32, number }
    }
}

/// It on the device.
pub struct Drawing {
    // Dropped before what it uses.
    recorded: Recorded,
    _pipeline: GraphicsPipeline,
    _indices: Buffer,
    target: Image,
    pub drawn: Drawn,
    pub grid: Grid,
}

impl Drawing {
    /// Errors: memory, or the driver refuses (exit code 4).
    pub fn new(gpu: &Arc<Gpu>, drawn: Drawn, grid: Grid) -> Result<Self> {
        let is_possible = grid.side_px.is_power_of_two() && grid.squares.is_power_of_two() && grid.squares <= 512;
        assert!(is_possible && (1..=255).contains(&grid.draws), "{grid:?}");
        let formats = [FORMAT];
        let description = GraphicsDescription { vertex: &VERT, ..fullscreen::description(&FRAG, &formats) };
        let pipeline = GraphicsPipeline::new(gpu, &description)?;
        let corners = grid.indices();
        let flags = vk::BufferUsageFlags::INDEX_BUFFER | vk::BufferUsageFlags::TRANSFER_DST;
        let bytes = 4 * corners.len() as u64;
        let indices = Buffer::new(gpu, "bench.device.indices", GROUP, bytes, flags, Use::Device)?;
        upload::buffer(gpu, &indices, bytemuck::cast_slice(&corners), Access::VertexRead)?;
        let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC;
        let description = ImageDescription::plain(grid.extent(), FORMAT, 1, usage);
        let target = Image::at(gpu, "bench.device.drawn", GROUP, description, Berth::Own)?;
        let mut cmd = Commands::begin(gpu, "bench", Submits::PerPass)?;
        let [read_bytes, written_bytes] = drawn.moved_bytes(grid).map(Some);
        cmd.pass("bench.device", Traffic { read_bytes, written_bytes, invocations: None }, |cmd| {
            cmd.barriers([target.discard(Access::ColorWrite)]);
            let clear = vk::ClearColorValue { uint32: [0; 4] };
            cmd.begin_rendering(grid.extent(), &[ColorTarget::new(&target, Some(clear))], None);
            cmd.bind_graphics(&pipeline, bytemuck::bytes_of(&grid.params(1)), &[])?;
            cmd.bind_indices(&indices);
            // SAFETY: the buffer is being recorded inside rendering.
            unsafe {
                gpu.device.cmd_set_cull_mode(cmd.buffer(), vk::CullModeFlags::BACK);
                gpu.device.cmd_set_front_face(cmd.buffer(), drawn.front_face());
            }
            for number in 1..=grid.draws {
                cmd.push(&pipeline.interface, bytemuck::bytes_of(&grid.params(number)));
                // SAFETY: the vertex shader reads no stream.
                unsafe { cmd.draw_indexed(0..corners.len() as u32, 0, 0..1) };
            }
            cmd.end_rendering();
            Ok(())
        })?;
        Ok(Self { recorded: cmd.finish()?, _pipeline: pipeline, _indices: indices, target, drawn, grid })
    }

    /// The target after the last run, row-major: of each pixel the number of the last draw that covered it, 0 where none did.
    ///
    /// Errors: memory for reading it back (exit code 4).
    pub fn target(&self, gpu: &Arc<Gpu>) -> Result<Vec<u8>> {
        readback::image(gpu, &self.target, Access::ColorWrite)
    }
}

impl Probe for Drawing {
    fn measure(&self) -> Result<Vec<f64>> {
        last_pass(&self.recorded)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_square_has_its_two_triangles_once() {
        for squares in [1, 2, 16] {
            let grid = Grid { side_px: 16, squares, draws: 1 };
            let indices = grid.indices();
            let mut seen = BTreeSet::new();
            for corners in indices.chunks(3) {
                let place = |index: u32| {
                    let row = index >> TRIANGLES_COLUMN_BITS;
                    [index - (row << TRIANGLES_COLUMN_BITS), row].map(i64::from)
                };
                let [a, b, c] = [0, 1, 2].map(|corner| place(corners[corner]));
                assert!([a, b, c].iter().flatten().all(|place| *place <= i64::from(squares)), "{a:?} {b:?} {c:?}");
                // Twice its area, which is positive where corners follow each other clockwise, since y goes down.
                assert_eq!((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1]), 1, "{a:?} {b:?} {c:?}");
                assert!(seen.insert(BTreeSet::from([a, b, c])), "{a:?} {b:?} {c:?}");
            }
            assert_eq!(seen.len() as u64, grid.triangle_count());
        }
    }
}
