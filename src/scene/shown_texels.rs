//! Texels of a picture that a triangle shows. The others are gutters: what lies between the charts of an atlas, in whatever colour
//! its painter left it. Coarser levels that average them in bring it onto the charts, most of all at their edges.

use super::{Placement, Scene, TextureSlot, Wrap};
use glam::{DVec2, UVec2};
use std::ops::Range;

/// Texels by which coordinates that end on a square's edge may be off.
const ROUNDING: f64 = 1.0 / 64.0;

/// Texels from the picture's corner beyond which nothing is said of where a triangle lies.
const FARTHEST: f64 = 1e9;

/// A bit a texel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ShownTexels {
    size: [u32; 2],
    /// `size[0]` bits a row, each row from a word of its own on.
    words: Vec<u64>,
}

impl ShownTexels {
    /// Those of image `image`: a triangle of a material that reads it overlaps the texel's square. None: all are taken for shown,
    /// because they are, because a triangle repeats the picture or has coordinates that are no numbers, or because
    /// `--texture-gutters` keeps the others.
    pub fn of(scene: &Scene, image: usize) -> Option<Self> {
        if !scene.texturing.fills_gutters {
            return None;
        }
        let size = [scene.images[image].width, scene.images[image].height];
        let mut shown = Self::none(size);
        let mut added = 0u64;
        for mesh in &scene.meshes {
            let material = &scene.materials[mesh.material];
            let mut readings: Vec<(&Placement, [Wrap; 2])> = Vec::new();
            for slot in TextureSlot::ALL {
                let Some(texture) = material.texture(slot).map(|texture| &scene.textures[texture]) else { continue };
                let reading = (material.placement(slot), [texture.sampler.wrap_u, texture.sampler.wrap_v]);
                if texture.image == image && !readings.contains(&reading) {
                    readings.push(reading);
                }
            }
            for (placement, wraps) in readings {
                let coordinates = [&mesh.uvs, &mesh.uvs_1][placement.uv_set];
                for triangle in 0..mesh.triangle_count() {
                    let corners = mesh.corners(triangle).map(|vertex| {
                        let at = coordinates.get(vertex).copied().unwrap_or_default();
                        let place = placement.picture_from_uv.transform_point2(at).as_dvec2();
                        place * UVec2::from(size).as_dvec2()
                    });
                    if !shown.add(corners, wraps) {
                        return None;
                    }
                    added += 1;
                    // Now and then: a picture that many triangles show is soon shown whole.
                    if added.is_power_of_two() && shown.are_all() {
                        return None;
                    }
                }
            }
        }
        (!shown.are_all()).then_some(shown)
    }

    fn none(size: [u32; 2]) -> Self {
        Self { size, words: vec![0; size[0].div_ceil(u64::BITS) as usize * size[1] as usize] }
    }

    fn row_words(&self) -> usize {
        self.size[0].div_ceil(u64::BITS) as usize
    }

    #[cfg(test)]
    pub fn with(size: [u32; 2], is_shown: impl Fn(u32, u32) -> bool) -> Self {
        let mut shown = Self::none(size);
        let all = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
        all.filter(|(x, y)| is_shown(*x, *y)).for_each(|(x, y)| shown.insert(x, y));
        shown
    }

    /// Index of a texel's word, and its bit there. Texels lie on the picture: so does what `Wrap::texel` gives, and what is
    /// counted up to its size.
    fn place(&self, x: u32, y: u32) -> (usize, u64) {
        (self.row_words() * y as usize + (x / u64::BITS) as usize, 1 << (x % u64::BITS))
    }

    fn insert(&mut self, x: u32, y: u32) {
        let (word, bit) = self.place(x, y);
        self.words[word] |= bit;
    }

    /// Adds what a triangle overlaps, whose corners are in texels; false: it is wider or higher than the picture.
    fn add(&mut self, corners: [DVec2; 3], wraps: [Wrap; 2]) -> bool {
        let low = corners[0].min(corners[1]).min(corners[2]);
        let high = corners[0].max(corners[1]).max(corners[2]);
        let fits = (high - low).cmple(UVec2::from(self.size).as_dvec2()).all();
        // Far out a float has no room for texels.
        let is_near = low.min(-high).min_element() > -FARTHEST;
        if !(corners.iter().all(|corner| corner.is_finite()) && fits && is_near) {
            return false;
        }
        for row in squares(low.y, high.y) {
            let slab = [row as f64, row as f64 + 1.0];
            let [mut first, mut last] = [f64::INFINITY, f64::NEG_INFINITY];
            for (from, to) in [(corners[0], corners[1]), (corners[1], corners[2]), (corners[2], corners[0])] {
                let (from, to) = if from.y <= to.y { (from, to) } else { (to, from) };
                // `squares` has let an end pass that lies a little outside: its nearest place counts.
                if to.y < slab[0] - ROUNDING || from.y > slab[1] + ROUNDING {
                    continue;
                }
                for x in slab.map(|y| x_at(from, to, y)) {
                    [first, last] = [first.min(x), last.max(x)];
                }
            }
            let y = wraps[1].texel(row, self.size[1]);
            let columns = squares(first, last);
            match (u32::try_from(columns.start), u32::try_from(columns.end)) {
                (Ok(first), Ok(end)) if end <= self.size[0] => self.insert_row(first..end, y),
                _ => columns.for_each(|column| self.insert(wraps[0].texel(column, self.size[0]), y)),
            }
        }
        true
    }

    /// Adds `columns`, at least one, of a row.
    fn insert_row(&mut self, columns: Range<u32>, y: u32) {
        let (first, last) = (columns.start, columns.end - 1);
        let (from, to) = (self.place(first, y).0, self.place(last, y).0);
        let upward = u64::MAX << (first % u64::BITS);
        let downward = u64::MAX >> (u64::BITS - 1 - last % u64::BITS);
        if from == to {
            self.words[from] |= upward & downward;
        } else {
            self.words[from] |= upward;
            self.words[from + 1..to].fill(u64::MAX);
            self.words[to] |= downward;
        }
    }

    fn are_all(&self) -> bool {
        let shown: u64 = self.words.iter().map(|word| u64::from(word.count_ones())).sum();
        shown == u64::from(self.size[0]) * u64::from(self.size[1])
    }

    pub fn contains(&self, x: u32, y: u32) -> bool {
        let (word, bit) = self.place(x, y);
        self.words[word] & bit != 0
    }

    /// Whether one of the eight around this is among them, across the picture's edges too, or this one.
    pub fn has_near(&self, x: u32, y: u32) -> bool {
        let [width, height] = self.size;
        let bit = x % u64::BITS;
        let is_in_one_word = (1..u64::BITS - 1).contains(&bit) && x + 1 < width;
        [y + height - 1, y, y + 1].into_iter().any(|y| {
            if is_in_one_word {
                self.words[self.place(x, y % height).0] & (0b111 << (bit - 1)) != 0
            } else {
                [x + width - 1, x, x + 1].into_iter().any(|x| self.contains(x % width, y % height))
            }
        })
    }

    /// Those of the next coarser level: of whose finer ones one is shown.
    pub fn coarser(&self) -> Self {
        let [width, height] = self.size;
        let mut coarser = Self::none([(width / 2).max(1), (height / 2).max(1)]);
        let row = |y: u32| &self.words[self.place(0, y).0..][..self.row_words()];
        let row_words = coarser.row_words();
        for (y, target) in (0..coarser.size[1]).zip(coarser.words.chunks_exact_mut(row_words)) {
            let rows = row(2 * y).iter().zip(row((2 * y + 1).min(height - 1))).map(|(upper, lower)| upper | lower);
            for (index, both) in rows.enumerate() {
                // Both columns of a picture that is one texel wide are one.
                let columns = if width == 1 { both } else { evens(both | both >> 1) };
                // The half of an odd last column has no word.
                if let Some(word) = target.get_mut(index / 2) {
                    *word |= columns << (u64::BITS as usize / 2 * (index % 2));
                }
            }
            let used = coarser.size[0] % u64::BITS;
            if used > 0 {
                target[row_words - 1] &= (1 << used) - 1;
            }
        }
        coarser
    }
}

/// Bits 0, 2, 4 to 62 side by side.
fn evens(word: u64) -> u64 {
    let masks =
        [0x3333_3333_3333_3333, 0x0f0f_0f0f_0f0f_0f0f, 0x00ff_00ff_00ff_00ff, 0x0000_ffff_0000_ffff, 0xffff_ffff];
    let steps = masks.into_iter().enumerate();
    steps.fold(word & 0x5555_5555_5555_5555, |word, (step, mask)| (word | word >> (1 << step)) & mask)
}

/// Those that what reaches from `low` to `high` overlaps, one at least.
fn squares(low: f64, high: f64) -> Range<i64> {
    let first = (low + ROUNDING).floor();
    first as i64..(high - ROUNDING).ceil().max(first + 1.0) as i64
}

/// Where an edge that goes up from `from` to `to` is at height `y`, or its end that is nearest.
fn x_at(from: DVec2, to: DVec2, y: f64) -> f64 {
    if y <= from.y {
        from.x
    } else if y >= to.y {
        to.x
    } else {
        from.x + (to.x - from.x) * ((y - from.y) / (to.y - from.y))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{ColorSpace, Image, Material, Mesh, Sampler, Texture};
    use glam::Vec2;

    /// A picture of this size, read by triangles of these corners, in texels.
    fn read_by(size: [u32; 2], wrap: Wrap, corners: &[[f32; 2]]) -> Option<ShownTexels> {
        let [width, height] = size;
        let uv = |[x, y]: &[f32; 2]| Vec2::new(x / width as f32, y / height as f32);
        let mesh = Mesh {
            positions: vec![glam::Vec3::ZERO; corners.len()],
            uvs: corners.iter().map(uv).collect(),
            indices: (0..corners.len() as u32).collect(),
            ..Mesh::default()
        };
        let rgba8 = vec![0; 4 * (width * height) as usize];
        let sampler = Sampler { wrap_u: wrap, wrap_v: wrap, ..Sampler::default() };
        let scene = Scene {
            meshes: vec![mesh],
            materials: vec![Material { base_color_texture: Some(0), ..Material::default() }],
            textures: vec![Texture { image: 0, sampler, color_space: ColorSpace::Srgb }],
            images: vec![Image { name: String::new(), width, height, rgba8 }.into()],
            ..Scene::default()
        };
        ShownTexels::of(&scene, 0)
    }

    fn rows(shown: &ShownTexels) -> Vec<String> {
        let texel = |x, y| if shown.contains(x, y) { '#' } else { '.' };
        (0..shown.size[1]).map(|y| (0..shown.size[0]).map(|x| texel(x, y)).collect()).collect()
    }

    #[test]
    fn a_triangle_shows_the_squares_that_it_overlaps() {
        // A fifth is no number of a float: ends lie a little beside the squares' edges.
        let shown = read_by([8, 5], Wrap::Repeat, &[[1.0, 1.0], [5.0, 1.0], [1.0, 3.0]]).unwrap();
        assert_eq!(rows(&shown), ["........", ".####...", ".##.....", "........", "........"]);
        // Ends just before a square's edge, which rounding takes for the next one's.
        let shown = read_by([4, 4], Wrap::Repeat, &[[1.995, 2.99], [1.998, 2.99], [1.995, 2.995]]).unwrap();
        assert_eq!(rows(&shown), ["....", "....", "....", "..#."]);
        // A sliver, along rows and across.
        let shown = read_by([4, 3], Wrap::Repeat, &[[0.2, 0.5], [3.6, 0.5], [3.6, 0.6]]).unwrap();
        assert_eq!(rows(&shown), ["####", "....", "...."]);
        let shown = read_by([4, 3], Wrap::Repeat, &[[2.5, 0.2], [2.5, 2.6], [2.6, 2.6]]).unwrap();
        assert_eq!(rows(&shown), ["..#.", "..#.", "..#."]);
    }

    #[test]
    fn what_lies_beyond_an_edge_is_where_the_texture_repeats() {
        let corners = [[3.0, 1.0], [6.0, 1.0], [3.0, 2.0]];
        let of = |wrap| rows(&read_by([4, 3], wrap, &corners).unwrap())[1].clone();
        assert_eq!(of(Wrap::Repeat), "##.#");
        assert_eq!(of(Wrap::MirroredRepeat), "..##");
        assert_eq!(of(Wrap::ClampToEdge), "...#");
    }

    #[test]
    fn nothing_is_said_of_a_picture_that_is_shown_whole() {
        let whole = [[0.0, 0.0], [4.0, 0.0], [4.0, 3.0], [0.0, 0.0], [4.0, 3.0], [0.0, 3.0]];
        assert_eq!(read_by([4, 3], Wrap::Repeat, &whole), None);
        assert_eq!(read_by([4, 3], Wrap::Repeat, &[[0.0, 0.0], [4.5, 0.0], [0.0, 1.0]]), None);
        assert_eq!(read_by([4, 3], Wrap::Repeat, &[[0.0, 0.0], [f32::NAN, 0.0], [0.0, 1.0]]), None);
        assert_eq!(read_by([4, 3], Wrap::Repeat, &[[1e30, 0.0], [1e30, 1.0], [1e30, 0.0]]), None);
    }

    /// Points of a triangle, many, say where it is: the squares that they lie well inside are marked, and each marked square is a texel
    /// from one of theirs at most.
    #[test]
    fn points_of_triangles_lie_in_squares_that_are_shown() {
        let mut random = 1u32;
        let mut next = || {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (random >> 8) as f32 / (1 << 24) as f32
        };
        for _ in 0..200 {
            let corners = [0; 3].map(|_| [next() * 70.0, next() * 9.0]);
            let shown = read_by([70, 9], Wrap::Repeat, &corners).unwrap();
            let [mut seen, mut inside] = [ShownTexels::none([70, 9]), ShownTexels::none([70, 9])];
            for (i, j) in (0..=300).flat_map(|i| (0..=300 - i).map(move |j| (i, j))) {
                let weights = [i as f32 / 300.0, j as f32 / 300.0, (300 - i - j) as f32 / 300.0];
                let at = [0, 1].map(|axis| (0..3).map(|corner| weights[corner] * corners[corner][axis]).sum::<f32>());
                let [x, y] = [(at[0] as u32).min(69), (at[1] as u32).min(8)];
                seen.insert(x, y);
                // A square's edge is no one's.
                if at.iter().all(|at| (0.02..0.98).contains(&at.fract())) {
                    inside.insert(x, y);
                }
            }
            for (x, y) in (0..9).flat_map(|y| (0..70).map(move |x| (x, y))) {
                assert!(shown.contains(x, y) || !inside.contains(x, y), "{corners:?}: {x} {y} is missing");
                let near = (x.saturating_sub(1)..(x + 2).min(70))
                    .any(|x| (y.saturating_sub(1)..(y + 2).min(9)).any(|y| seen.contains(x, y)));
                assert!(!shown.contains(x, y) || near, "{corners:?}: {x} {y} is too far");
            }
        }
    }

    /// Texel by texel, of sizes that end within a word and at its end.
    #[test]
    fn words_at_a_time_are_texels_one_by_one() {
        for size in [[1u32, 5u32], [5, 1], [64, 2], [65, 3], [128, 4], [129, 5], [200, 7], [255, 3]] {
            for sparse in [3, 97] {
                let shown = ShownTexels::with(size, |x, y| (x * 7 + y * 13 + x * y) % sparse == 0);
                let coarser = shown.coarser();
                let pair = |at: u32, axis: usize| [2 * at, (2 * at + 1).min(size[axis] - 1)];
                let all = |[width, height]: [u32; 2]| (0..height).flat_map(move |y| (0..width).map(move |x| (x, y)));
                for (x, y) in all(coarser.size) {
                    let any = pair(y, 1).iter().any(|y| pair(x, 0).iter().any(|x| shown.contains(*x, *y)));
                    assert_eq!(coarser.contains(x, y), any, "{size:?}: {x} {y}");
                }
                let ones: u32 = coarser.words.iter().map(|word| word.count_ones()).sum();
                let counted = all(coarser.size).filter(|(x, y)| coarser.contains(*x, *y)).count();
                assert_eq!(ones as usize, counted, "{size:?}: bits beyond the picture");
                for (x, y) in all(size) {
                    let around = |at: u32, axis: usize| [size[axis] - 1, 0, 1].map(|step| (at + step) % size[axis]);
                    let any = around(y, 1).iter().any(|y| around(x, 0).iter().any(|x| shown.contains(*x, *y)));
                    assert_eq!(shown.has_near(x, y), any, "{size:?}: {x} {y}");
                }
                let mut filled = ShownTexels::none(size);
                let columns = size[0] / 3..size[0];
                filled.insert_row(columns.clone(), size[1] - 1);
                assert_eq!(
                    filled,
                    ShownTexels::with(size, |x, y| columns.contains(&x) && y == size[1] - 1),
                    "{size:?}"
                );
            }
        }
    }

    #[test]
    fn a_coarser_texel_is_shown_where_one_of_its_finer_ones_is() {
        let shown = read_by([7, 5], Wrap::Repeat, &[[2.0, 2.0], [3.0, 2.0], [2.0, 3.0]]).unwrap();
        let coarser = shown.coarser();
        assert_eq!(rows(&coarser), ["...", ".#."]);
        assert_eq!(rows(&coarser.coarser()), ["#"]);
    }
}
