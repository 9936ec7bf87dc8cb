//! What the samples of deep shading see, as insertion reads it: an image of SPIDs, of a stated scene or of a device.
//!
//! The scene is a plane that fills the view, cut into right triangles and more or less out of focus: a sample sees the triangle at its
//! place in its pixel, moved by its place on the lens times the blur, and that place is its shading point.

use crate::gpu::shader::techniques::deep_shading::space::NO_PRIMITIVE;
use crate::techniques::deep_shading::tuples::TupleTable;
use crate::units::Extent;

/// The default of `--guard-band`, px: no blur of the plane is wider, so that every shading point lies in shading space.
pub const GUARD_PX: u32 = 64;

/// The default of `--seed`, which scrambles tuples.
const SEED: u32 = 1;

/// SPIDs, an image with a layer a tuple.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Spids {
    pub layer: Extent,
    /// Shading space, whose pixels have a list each.
    pub space: Extent,
    /// Layer by layer, row by row: triangle, and pixel of shading space as 16 bits a side.
    pub words: Vec<[u32; 2]>,
}

impl Spids {
    pub fn layer_count(&self) -> u32 {
        (self.words.len() as u64 / self.layer.pixel_count().max(1)) as u32
    }

    /// Those of a plane of triangles whose legs are `triangle_px`, at least 1, blurred by a circle of the radius `blur_px`, at most
    /// `GUARD_PX`. Samples beside the frame, which pad layers, see nothing.
    pub fn of_plane(frame: Extent, table: &TupleTable, triangle_px: u32, blur_px: f64) -> Self {
        let layer = table.layer(frame);
        let space = Extent::new(frame.width + 2 * GUARD_PX, frame.height + 2 * GUARD_PX);
        let leg = f64::from(triangle_px);
        let squares_across = space.width.div_ceil(triangle_px);
        let mut words = Vec::with_capacity(table.sample_count(frame) as usize);
        for (tuple, place) in (0..).zip(table.tuples(frame, SEED, 0, &[0.0])) {
            for at in (0..layer.height).flat_map(|y| (0..layer.width).map(move |x| [x, y])) {
                let pixel = table.pixel_of(tuple, at);
                if pixel[0] >= frame.width || pixel[1] >= frame.height {
                    words.push([NO_PRIMITIVE; 2]);
                    continue;
                }
                let seen = [0, 1].map(|axis: usize| {
                    let moved = f64::from(place.place_px[axis]) + blur_px * f64::from(place.lens[axis]);
                    f64::from(pixel[axis]) + moved + f64::from(GUARD_PX)
                });
                // A lens of 1 that rounding has made longer stays inside.
                let shading = [0, 1].map(|axis: usize| (seen[axis] as u32).min([space.width, space.height][axis] - 1));
                let square = seen.map(|along| (along / leg) as u32);
                let is_lower = seen.map(|along| along % leg).iter().sum::<f64>() >= leg;
                let triangle = 2 * (square[1] * squares_across + square[0]) + u32::from(is_lower);
                words.push([triangle, shading[1] << 16 | shading[0]]);
            }
        }
        Self { layer, space, words }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn a_sharp_plane_is_seen_where_samples_lie() {
        let (frame, table) = (Extent::new(16, 8), TupleTable::new(8, 8));
        let spids = Spids::of_plane(frame, &table, 4, 0.0);
        assert_eq!((spids.layer, spids.layer_count(), spids.space), (frame, 8, Extent::new(144, 136)));
        for (index, [triangle, shading]) in spids.words.iter().enumerate() {
            let [x, y] = [index as u32 % 16, index as u32 / 16 % 8];
            assert_eq!([shading & 0xffff, shading >> 16], [x + 64, y + 64]);
            // Shading space is 36 squares of 4 pixels wide.
            assert_eq!(triangle / 2, (y + 64) / 4 * 36 + (x + 64) / 4);
        }
        // Those of a pixel on a square's diagonal see both of its triangles, those beside it one.
        let seen =
            |x: usize, y: usize| (0..8).map(|layer| spids.words[layer * 128 + y * 16 + x][0]).collect::<HashSet<u32>>();
        assert_eq!([seen(0, 3).len(), seen(0, 0).len(), seen(3, 3).len()], [2, 1, 1]);
    }

    #[test]
    fn blur_moves_shading_points_by_as_much_and_padding_sees_nothing() {
        let (frame, table) = (Extent::new(13, 5), TupleTable::new(8, 32));
        let spids = Spids::of_plane(frame, &table, 8, 3.0);
        assert_eq!(spids.words.len() as u64, table.sample_count(frame));
        let nothing = spids.words.iter().filter(|[triangle, _]| *triangle == NO_PRIMITIVE).count();
        // Layers of 7 x 3 pixels hold 14 x 6 of the frame, for each of 8 samples a pixel.
        assert_eq!(nothing, 8 * (14 * 6 - 13 * 5));
        let mut farthest: u32 = 0;
        for (index, [_, shading]) in spids.words.iter().enumerate().filter(|(_, words)| words[0] != NO_PRIMITIVE) {
            let (tuple, at) = (index as u32 / 21, [index as u32 % 7, index as u32 % 21 / 7]);
            let pixel = table.pixel_of(tuple, at);
            let seen = [shading & 0xffff, shading >> 16];
            let off = [0, 1].map(|axis: usize| (pixel[axis] + GUARD_PX).abs_diff(seen[axis]));
            farthest = farthest.max(off[0]).max(off[1]);
        }
        assert!((2..=3).contains(&farthest), "{farthest}");
    }
}
