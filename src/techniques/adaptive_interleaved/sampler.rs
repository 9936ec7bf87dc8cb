//! The sampler: which samples a pixel of a tile uses in an iteration (Dubla 2009, section 3, figure 1). Twin of
//! glsl/techniques/adaptive_interleaved/tile.glsl, guidance.glsl and the components' `contribute`.
//!
//! A component has disjoint sets of samples, one an iteration, and a set has one sample, or one subset of them, for
//! each pixel of a tile: a pixel of the frame always uses those of its place in the tile, and none of them twice.

use crate::gpu::shader::structs::AdaptiveParams;
use crate::gpu::shader::techniques::adaptive_interleaved::guidance::ROUNDING_GRACE;

impl AdaptiveParams {
    /// Texels of a tile.
    pub fn tile_size(&self) -> u32 {
        self.tile_x * self.tile_y
    }

    /// The place of a texel in its tile, row-major.
    pub fn slot_of(&self, [x, y]: [u32; 2]) -> u32 {
        y % self.tile_y * self.tile_x + x % self.tile_x
    }

    /// The tile of a texel, row-major.
    pub fn tile_of(&self, [x, y]: [u32; 2]) -> u32 {
        y / self.tile_y * self.tile_columns + x / self.tile_x
    }

    /// Texels of a tile that the component has, row-major.
    pub fn texels_of(&self, tile: u32) -> impl Iterator<Item = [u32; 2]> + use<> {
        let corner = [tile % self.tile_columns * self.tile_x, tile / self.tile_columns * self.tile_y];
        let [tile_x, tile_y] = [self.tile_x, self.tile_y];
        let (width, height) = (self.width, self.height);
        let texels = (0..tile_y).flat_map(move |y| (0..tile_x).map(move |x| [corner[0] + x, corner[1] + y]));
        texels.filter(move |[x, y]| *x < width && *y < height)
    }

    /// Stretch of the virtual point lights that a pixel is lit by in an iteration: [first, end].
    pub fn id_stretch(&self, slot: u32, iteration: u32) -> [u32; 2] {
        let size = self.tile_size();
        let subset = (slot + iteration) % size;
        [subset, subset + 1].map(|subset| subset * self.source_count / size)
    }

    /// Index of the point of area light `area` that a pixel sends a ray to in an iteration.
    pub fn ss_point(&self, area: u32, slot: u32, iteration: u32) -> u32 {
        (area * self.most + iteration) * self.tile_size() + slot
    }

    /// Further iterations of a tile, from the mean of what its pixels with a surface found in the initial pass;
    /// `is_penumbra`: whether a tile that found 1 needs none.
    pub fn further_iterations(&self, refine: f32, is_penumbra: bool) -> u32 {
        let left = self.most - self.base;
        if self.refines_all != 0 {
            return left;
        }
        let refines = refine > 0.0 && !(is_penumbra && refine >= 1.0);
        if refines { ((refine * self.most as f32 + ROUNDING_GRACE) as u32).min(left) } else { 0 }
    }

    /// The same by the luminances that its pixels with a surface have from the initial pass: as many that the standard error
    /// of their mean comes to `until_error` of it.
    pub fn further_until_error(&self, luminances: &[f32]) -> u32 {
        let (left, count) = (self.most - self.base, luminances.len() as f32);
        match (luminances, self.refines_all) {
            ([], _) => return 0,
            ([_], _) | (_, 1) => return left,
            _ => {}
        }
        let mean = luminances.iter().sum::<f32>() / count;
        let mean_square = luminances.iter().map(|one| one * one).sum::<f32>() / count;
        let variance = (mean_square - mean * mean).max(0.0) * (count / (count - 1.0));
        let bound = self.until_error * mean;
        let needed = if bound > 0.0 { self.base as f32 * variance / (count * bound * bound) } else { 0.0 };
        ((needed.min(self.most as f32) - ROUNDING_GRACE).ceil() - self.base as f32).max(0.0).min(left as f32) as u32
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bytemuck::Zeroable;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    fn params(tile: [u32; 2], most: u32, source_count: u32) -> AdaptiveParams {
        let [tile_x, tile_y] = tile;
        AdaptiveParams { tile_x, tile_y, tile_columns: 1, most, base: 1, source_count, ..AdaptiveParams::zeroed() }
    }

    proptest! {
        #[test]
        fn no_pixel_uses_a_virtual_light_twice_and_a_tile_uses_all_in_each_iteration(
            x in 1u32..=8, y in 1u32..=8, count in 1u32..1000,
        ) {
            let params = params([x, y], x * y, count.max(x * y));
            let lights = |slots: &mut dyn Iterator<Item = (u32, u32)>| {
                let mut all: Vec<u32> = slots
                    .flat_map(|(slot, iteration)| {
                        let [first, end] = params.id_stretch(slot, iteration);
                        first..end
                    })
                    .collect();
                all.sort_unstable();
                all
            };
            let every: Vec<u32> = (0..params.source_count).collect();
            for slot in 0..x * y {
                prop_assert_eq!(&lights(&mut (0..x * y).map(|iteration| (slot, iteration))), &every);
            }
            for iteration in 0..x * y {
                prop_assert_eq!(&lights(&mut (0..x * y).map(|slot| (slot, iteration))), &every);
                let sizes = (0..x * y).map(|slot| params.id_stretch(slot, iteration)).map(|[first, end]| end - first);
                let (least, most) = (sizes.clone().min(), sizes.max());
                prop_assert!(most.unwrap() - least.unwrap() <= 1);
            }
        }

        #[test]
        fn no_point_of_an_area_light_is_used_twice(x in 1u32..=8, y in 1u32..=8, most in 1u32..=64, lights in 1u32..5) {
            let params = params([x, y], most, lights);
            let mut used = BTreeSet::new();
            for light in 0..lights {
                for iteration in 0..most {
                    for slot in 0..x * y {
                        prop_assert!(used.insert(params.ss_point(light, slot, iteration)));
                    }
                }
            }
            prop_assert_eq!(used.last().copied(), Some(lights * most * x * y - 1));
        }

        #[test]
        fn every_pixel_of_the_frame_is_in_one_tile(x in 1u32..=8, y in 1u32..=8, width in 1u32..40, height in 1u32..40) {
            let columns = width.div_ceil(x);
            let params = AdaptiveParams { width, height, tile_columns: columns, ..params([x, y], 1, 1) };
            let mut pixels: Vec<[u32; 2]> =
                (0..columns * height.div_ceil(y)).flat_map(|tile| params.texels_of(tile)).collect();
            prop_assert!(pixels.iter().all(|pixel| params.slot_of(*pixel) < params.tile_size()));
            let is_of = |tile: u32| params.texels_of(tile).all(|pixel| params.tile_of(pixel) == tile);
            prop_assert!((0..columns * height.div_ceil(y)).all(is_of));
            pixels.sort_unstable_by_key(|[x, y]| [*y, *x]);
            let every: Vec<[u32; 2]> = (0..height).flat_map(|y| (0..width).map(move |x| [x, y])).collect();
            prop_assert_eq!(pixels, every);
        }
    }

    #[test]
    fn guidance_asks_for_its_part_of_the_most_and_not_beyond() {
        let params = params([3, 3], 9, 256);
        let further = |refine, is_penumbra| params.further_iterations(refine, is_penumbra);
        assert_eq!(
            [0.0, 0.05, 1.0 / 9.0, 0.5, 8.0 / 9.0, 1.0].map(|refine| further(refine, false)),
            [0, 0, 1, 4, 8, 8]
        );
        assert_eq!([0.0, 0.5, 8.0 / 9.0, 1.0].map(|refine| further(refine, true)), [0, 4, 8, 0]);
        let all = AdaptiveParams { refines_all: 1, ..params };
        assert_eq!(all.further_iterations(0.0, true), 8);
    }
}
