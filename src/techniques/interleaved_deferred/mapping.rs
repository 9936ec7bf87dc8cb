//! Which texel of the frame goes where: the twin of mapping.glsl (Segovia 2006, sections 1 and 3.2).

use crate::gpu::shader::structs::MappingParams;
use crate::units::Extent;

/// The mapping of one frame and pattern.
///
/// Sub-buffers are padded to one size, their width to an even number, so that a thread can carry two texels.
pub fn mapping(extent: Extent, pattern: [u32; 2]) -> MappingParams {
    MappingParams {
        pattern_x: pattern[0],
        pattern_y: pattern[1],
        sub_width_px: extent.width.div_ceil(pattern[0]).next_multiple_of(2),
        sub_height_px: extent.height.div_ceil(pattern[1]),
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

    /// Texels of all sub-buffers.
    pub fn texel_count(&self) -> u64 {
        self.sub_texel_count() * u64::from(self.subset_count())
    }

    /// Texels between the rows of a buffer in frame order.
    pub fn row_pitch(&self) -> u32 {
        self.width_px.next_multiple_of(2)
    }

    /// Texels of a buffer in frame order, with its padding.
    pub fn frame_texel_count(&self) -> u64 {
        u64::from(self.row_pitch()) * u64::from(self.height_px)
    }

    /// Which of the n * m subsets shades a pixel: 0..n*m, row-major inside the pattern.
    pub fn subset_of(&self, [x, y]: [u32; 2]) -> u32 {
        y % self.pattern_y * self.pattern_x + x % self.pattern_x
    }

    /// Texel of all sub-buffers that holds a pixel.
    pub fn texel_of(&self, [x, y]: [u32; 2]) -> u64 {
        let row = u64::from(self.subset_of([x, y])) * u64::from(self.sub_height_px) + u64::from(y / self.pattern_y);
        row * u64::from(self.sub_width_px) + u64::from(x / self.pattern_x)
    }

    /// The pixel that texel `inside` of sub-buffer `subset` comes from; in the padding it lies outside the frame.
    pub fn pixel_of(&self, subset: u32, inside: [u32; 2]) -> [u32; 2] {
        let first = [subset % self.pattern_x, subset / self.pattern_x];
        [inside[0] * self.pattern_x + first[0], inside[1] * self.pattern_y + first[1]]
    }

    /// Where texels of sub-buffers stand in a picture that shows them side by side (figure 3b): for each pixel of that
    /// picture, row-major, its texel. Padding is left out, so the picture has the frame's extent.
    pub fn side_by_side(&self) -> Vec<u64> {
        let columns = spread(self.width_px, self.pattern_x);
        let rows = spread(self.height_px, self.pattern_y);
        rows.iter().flat_map(|y| columns.iter().map(|x| self.texel_of([*x, *y]))).collect()
    }
}

/// 0..length, sorted by their remainder: all of the first sub-buffer, then all of the second.
fn spread(length: u32, pattern: u32) -> Vec<u32> {
    (0..pattern).flat_map(|first| (first..length).step_by(pattern as usize)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn split_then_gather_is_the_identity(w in 1u32..70, h in 1u32..50, n in 1u32..20, m in 1u32..20) {
            let mapping = mapping(Extent::new(w, h), [n, m]);
            let mut sources = vec![None; mapping.texel_count() as usize];
            for subset in 0..mapping.subset_count() {
                for y in 0..mapping.sub_height_px {
                    for x in 0..mapping.sub_width_px {
                        let pixel = mapping.pixel_of(subset, [x, y]);
                        let texel = (u64::from(subset) * mapping.sub_texel_count()
                            + u64::from(y) * u64::from(mapping.sub_width_px) + u64::from(x)) as usize;
                        if pixel[0] < w && pixel[1] < h {
                            prop_assert_eq!(mapping.texel_of(pixel), texel as u64);
                            prop_assert_eq!(mapping.subset_of(pixel), subset);
                        }
                        sources[texel] = Some(pixel);
                    }
                }
            }
            for y in 0..h {
                for x in 0..w {
                    prop_assert_eq!(sources[mapping.texel_of([x, y]) as usize], Some([x, y]));
                }
            }
        }

        #[test]
        fn side_by_side_shows_each_pixel_once(w in 1u32..40, h in 1u32..40, n in 1u32..9, m in 1u32..9) {
            let mapping = mapping(Extent::new(w, h), [n, m]);
            let mut shown = mapping.side_by_side();
            prop_assert_eq!(shown.len() as u64, Extent::new(w, h).pixel_count());
            shown.sort_unstable();
            shown.dedup();
            prop_assert_eq!(shown.len() as u64, Extent::new(w, h).pixel_count());
        }
    }
}
