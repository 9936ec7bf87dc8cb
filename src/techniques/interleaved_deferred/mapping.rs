//! Which texel of the frame goes where: the twin of mapping.glsl (Segovia 2006, sections 1, 3.2 and 3.3), which explains
//! the three orders: pixels of the padded frame, block texels, texels of sub-buffers as [x, y, number of the sub-buffer].

use crate::gpu::shader::structs::MappingParams;
use crate::sampling::pattern::grid;
use crate::units::Extent;

/// Workgroups that a list of texels is worth at least, where it has so many: the last one's threads may stand behind its end.
const LEAST_WORKGROUPS: u64 = 4;

/// The mapping of one frame, pattern and block.
///
/// Sub-buffers are padded to one size: to whole sub-blocks, and so many that their width is even and a thread can carry
/// two texels. A block is a multiple of the pattern; splits without blocks give the pattern.
pub fn mapping(extent: Extent, pattern: [u32; 2], block: [u32; 2]) -> MappingParams {
    assert!(block[0].is_multiple_of(pattern[0]) && block[1].is_multiple_of(pattern[1]), "{block:?} of {pattern:?}");
    let [sub_block_x, sub_block_y] = [block[0] / pattern[0], block[1] / pattern[1]];
    let mut blocks_x = extent.width.div_ceil(block[0]);
    if !(blocks_x * sub_block_x).is_multiple_of(2) {
        blocks_x += 1;
    }
    MappingParams {
        pattern_x: pattern[0],
        pattern_y: pattern[1],
        block_x: block[0],
        block_y: block[1],
        sub_width_px: blocks_x * sub_block_x,
        sub_height_px: extent.height.div_ceil(block[1]) * sub_block_y,
        width_px: extent.width,
        height_px: extent.height,
    }
}

impl MappingParams {
    /// Sub-buffers, and light subsets: n * m.
    pub fn subset_count(&self) -> u32 {
        self.pattern_x * self.pattern_y
    }

    /// Texels of one sub-buffer with its padding.
    pub fn sub_texel_count(&self) -> u64 {
        u64::from(self.sub_width_px) * u64::from(self.sub_height_px)
    }

    /// Texels of a sub-buffer that a thread shades at most, of workgroups of `lanes`.
    pub fn most_list_texels(&self, lanes: u64) -> u32 {
        let room = self.sub_texel_count() / (lanes * LEAST_WORKGROUPS);
        room.checked_ilog2().map_or(1, |power| 1 << power)
    }

    /// Texels of all sub-buffers, and of the block layout.
    pub fn texel_count(&self) -> u64 {
        self.sub_texel_count() * u64::from(self.subset_count())
    }

    /// The frame with its padding: the extent of the block layout, and of sub-buffers tiled side by side.
    pub fn padded(&self) -> Extent {
        Extent::new(self.sub_width_px * self.pattern_x, self.sub_height_px * self.pattern_y)
    }

    /// The frame.
    pub fn extent(&self) -> Extent {
        Extent::new(self.width_px, self.height_px)
    }

    /// Blocks in each direction, those that are all padding included.
    pub fn block_counts(&self) -> [u32; 2] {
        let padded = self.padded();
        [padded.width / self.block_x, padded.height / self.block_y]
    }

    /// Texels between the rows of a buffer in frame order.
    pub fn row_pitch(&self) -> u32 {
        self.width_px.next_multiple_of(2)
    }

    /// Texels of a buffer in frame order, with its padding.
    pub fn frame_texel_count(&self) -> u64 {
        u64::from(self.row_pitch()) * u64::from(self.height_px)
    }

    /// Whether a pixel of the padded frame is one of the frame.
    pub fn is_in_frame(&self, [x, y]: [u32; 2]) -> bool {
        x < self.width_px && y < self.height_px
    }

    fn sub_block(&self) -> [u32; 2] {
        [self.block_x / self.pattern_x, self.block_y / self.pattern_y]
    }

    fn place_in_pattern(&self, subset: u32) -> [u32; 2] {
        [subset % self.pattern_x, subset / self.pattern_x]
    }

    /// Which of the n * m subsets shades a pixel: 0..n*m, row-major inside the pattern.
    pub fn subset_of(&self, pixel: [u32; 2]) -> u32 {
        grid::subset_of([self.pattern_x, self.pattern_y], pixel)
    }

    /// Split in one pass: pixel (x, y) goes to (x / n, y / m) of sub-buffer (x mod n, y mod m).
    pub fn texel_of_pixel(&self, [x, y]: [u32; 2]) -> [u32; 3] {
        [x / self.pattern_x, y / self.pattern_y, self.subset_of([x, y])]
    }

    /// Inverse of `texel_of_pixel`; a texel of the padding gives a pixel outside the frame.
    pub fn pixel_of_texel(&self, [x, y, subset]: [u32; 3]) -> [u32; 2] {
        let first = self.place_in_pattern(subset);
        [x * self.pattern_x + first[0], y * self.pattern_y + first[1]]
    }

    /// Block splitting: the block stays, and inside it each pixel goes to its sub-block.
    pub fn block_texel_of_pixel(&self, [x, y]: [u32; 2]) -> [u32; 2] {
        let along = |at: u32, block: u32, pattern: u32| {
            let inside = at % block;
            at - inside + inside % pattern * (block / pattern) + inside / pattern
        };
        [along(x, self.block_x, self.pattern_x), along(y, self.block_y, self.pattern_y)]
    }

    /// Inverse of `block_texel_of_pixel`.
    pub fn pixel_of_block_texel(&self, [x, y]: [u32; 2]) -> [u32; 2] {
        let along = |at: u32, block: u32, pattern: u32| {
            let (inside, sub_block) = (at % block, block / pattern);
            at - inside + inside % sub_block * pattern + inside / sub_block
        };
        [along(x, self.block_x, self.pattern_x), along(y, self.block_y, self.pattern_y)]
    }

    /// Block translation: a whole sub-block goes to its place in its sub-buffer.
    pub fn texel_of_block_texel(&self, [x, y]: [u32; 2]) -> [u32; 3] {
        let [width, height] = self.sub_block();
        let (inside_x, inside_y) = (x % self.block_x, y % self.block_y);
        let subset = inside_y / height * self.pattern_x + inside_x / width;
        [x / self.block_x * width + inside_x % width, y / self.block_y * height + inside_y % height, subset]
    }

    /// Inverse of `texel_of_block_texel`.
    pub fn block_texel_of_texel(&self, [x, y, subset]: [u32; 3]) -> [u32; 2] {
        let ([width, height], place) = (self.sub_block(), self.place_in_pattern(subset));
        [
            x / width * self.block_x + place[0] * width + x % width,
            y / height * self.block_y + place[1] * height + y % height,
        ]
    }

    /// Where a texel lies when sub-buffers lie one after the other, row by row: in buffers, and in an image's layers.
    pub fn linear_of(&self, [x, y, subset]: [u32; 3]) -> u64 {
        let row = u64::from(subset) * u64::from(self.sub_height_px) + u64::from(y);
        row * u64::from(self.sub_width_px) + u64::from(x)
    }

    /// Where a texel lies when sub-buffers are tiled in one image (figure 3b).
    pub fn tiled_of(&self, [x, y, subset]: [u32; 3]) -> [u32; 2] {
        let place = self.place_in_pattern(subset);
        [place[0] * self.sub_width_px + x, place[1] * self.sub_height_px + y]
    }

    /// Inverse of `tiled_of`.
    pub fn texel_of_tiled(&self, [x, y]: [u32; 2]) -> [u32; 3] {
        let subset = y / self.sub_height_px * self.pattern_x + x / self.sub_width_px;
        [x % self.sub_width_px, y % self.sub_height_px, subset]
    }

    /// A picture that shows sub-buffers side by side (figure 3b): for each of its places, row-major, the pixel that it
    /// shows. Padding is left out, so the picture has the frame's extent.
    pub fn side_by_side(&self) -> Vec<[u32; 2]> {
        let columns = spread(self.width_px, self.pattern_x);
        let rows = spread(self.height_px, self.pattern_y);
        rows.iter().flat_map(|y| columns.iter().map(|x| [*x, *y])).collect()
    }
}

/// 0..length, sorted by their remainder: all of the first sub-buffer, then all of the second.
fn spread(length: u32, pattern: u32) -> Vec<u32> {
    (0..pattern).flat_map(|first| (first..length).step_by(pattern as usize)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::pattern::{Pattern, Sample};
    use proptest::prelude::*;
    use std::collections::HashSet;

    fn places(extent: Extent) -> impl Iterator<Item = [u32; 2]> {
        (0..extent.height).flat_map(move |y| (0..extent.width).map(move |x| [x, y]))
    }

    prop_compose! {
        /// Any frame, pattern and block that is a multiple of it.
        fn any_mapping()(w in 1u32..70, h in 1u32..50, n in 1u32..12, m in 1u32..12, p in 1u32..5, q in 1u32..5)
            -> MappingParams { mapping(Extent::new(w, h), [n, m], [n * p, m * q]) }
    }

    proptest! {
        /// The shaders' arithmetic deals pixels out as the host's pattern does.
        #[test]
        fn subsets_are_those_of_the_grid(mapping in any_mapping()) {
            let grid = Pattern::grid([mapping.pattern_x, mapping.pattern_y]);
            prop_assert_eq!(grid.subset_count(), mapping.subset_count());
            for pixel in places(mapping.padded()) {
                prop_assert_eq!(grid.subset_of(pixel), Some(mapping.subset_of(pixel)));
            }
            let first = |(pixel, sample): ([u32; 2], &Sample)| mapping.pixel_of_texel([0, 0, sample.subset]) == pixel;
            prop_assert!(grid.placed().all(first));
        }

        #[test]
        fn split_then_gather_is_the_identity(mapping in any_mapping()) {
            let mut texels = HashSet::new();
            for pixel in places(mapping.padded()) {
                let texel = mapping.texel_of_pixel(pixel);
                prop_assert_eq!(mapping.pixel_of_texel(texel), pixel);
                prop_assert_eq!(mapping.subset_of(pixel), texel[2]);
                prop_assert!(texel[0] < mapping.sub_width_px && texel[1] < mapping.sub_height_px);
                prop_assert!(texel[2] < mapping.subset_count());
                prop_assert!(texels.insert(texel));
            }
            prop_assert_eq!(texels.len() as u64, mapping.texel_count());
        }

        #[test]
        fn two_passes_are_one(mapping in any_mapping()) {
            for pixel in places(mapping.padded()) {
                let at = mapping.block_texel_of_pixel(pixel);
                prop_assert!(at[0] < mapping.padded().width && at[1] < mapping.padded().height);
                prop_assert_eq!(mapping.pixel_of_block_texel(at), pixel);
                let texel = mapping.texel_of_block_texel(at);
                prop_assert_eq!(texel, mapping.texel_of_pixel(pixel));
                prop_assert_eq!(mapping.block_texel_of_texel(texel), at);
                // A block stays where it is.
                prop_assert_eq!([at[0] / mapping.block_x, at[1] / mapping.block_y],
                                [pixel[0] / mapping.block_x, pixel[1] / mapping.block_y]);
            }
        }

        #[test]
        fn every_texel_has_a_place_of_its_own(mapping in any_mapping()) {
            let mut linear = HashSet::new();
            for at in places(mapping.padded()) {
                let texel = mapping.texel_of_tiled(at);
                prop_assert_eq!(mapping.tiled_of(texel), at);
                prop_assert!(mapping.linear_of(texel) < mapping.texel_count());
                prop_assert!(linear.insert(mapping.linear_of(texel)));
            }
        }

        #[test]
        fn padding_is_whole_sub_blocks_of_an_even_width(mapping in any_mapping()) {
            let padded = mapping.padded();
            prop_assert!(mapping.sub_width_px.is_multiple_of(2));
            prop_assert!(padded.width.is_multiple_of(mapping.block_x) && padded.height.is_multiple_of(mapping.block_y));
            prop_assert!(padded.width >= mapping.width_px && padded.width < mapping.width_px + 2 * mapping.block_x);
            prop_assert!(padded.height >= mapping.height_px && padded.height < mapping.height_px + mapping.block_y);
        }

        #[test]
        fn side_by_side_shows_each_pixel_once(w in 1u32..40, h in 1u32..40, n in 1u32..9, m in 1u32..9) {
            let mut shown = mapping(Extent::new(w, h), [n, m], [n, m]).side_by_side();
            prop_assert_eq!(shown.len() as u64, Extent::new(w, h).pixel_count());
            shown.sort_unstable();
            shown.dedup();
            prop_assert_eq!(shown.len() as u64, Extent::new(w, h).pixel_count());
        }
    }

    /// 33x17 in patterns of 4x2 and blocks of 12x4: three blocks across would leave sub-buffers of nine columns, so there are
    /// four, and five down.
    #[test]
    fn sizes_are_those_counted_on_paper() {
        let made = mapping(Extent::new(33, 17), [4, 2], [12, 4]);
        assert_eq!([made.sub_width_px, made.sub_height_px], [12, 10]);
        assert_eq!((made.subset_count(), made.sub_texel_count(), made.texel_count()), (8, 120, 960));
        assert_eq!((made.padded(), made.extent()), (Extent::new(48, 20), Extent::new(33, 17)));
        assert_eq!(made.block_counts(), [4, 5]);
        assert_eq!((made.row_pitch(), made.frame_texel_count()), (34, 34 * 17));
        let inside = [[32, 16], [33, 16], [32, 17], [33, 17]].map(|pixel| made.is_in_frame(pixel));
        assert_eq!(inside, [true, false, false, false]);
    }
}
