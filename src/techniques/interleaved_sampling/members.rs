//! The members of a basis: its samples, each of which is a regular grid over the frame and drawn as a picture of its own
//! (Keller and Heidrich 2001, section 2.1).

use crate::choice::choices;
use crate::frame::Placement;
use crate::sampling::basis::Basis;
use crate::sampling::side::Side;
use crate::units::Extent;
use glam::Vec2;
use std::collections::VecDeque;

choices! {
    /// How members are drawn and come to their pixels (`--members`).
    pub enum Drawing {
        /// Each as a small picture, whose samples are scattered.
        "layers" => Layers,
        /// Each as a small picture, a texture of a polygon over the frame, which a stipple pattern masks (section 3.1).
        "stipple" => Stipple,
        /// Each over the whole frame, whose other pixels are masked: rasterised once a member, as deep shading is once a tuple.
        "tuples" => Tuples,
        /// As samples of the device's, several members at once, each behind its own mask: hardware of the paper's proposal
        /// (section 3.1, VK_EXT_sample_locations).
        "sample-locations" => SampleLocations,
    }
}

impl Drawing {
    /// A member is drawn over the whole frame, and other pixels are masked.
    pub fn is_over_frame(self) -> bool {
        matches!(self, Self::Tuples | Self::SampleLocations)
    }
}

/// Where the samples of members lie in a frame, and in the pictures that members are drawn into.
pub struct Members {
    basis: Basis,
    frame: Extent,
    drawing: Drawing,
    /// Members that are drawn at once.
    at_once: u32,
    /// The first of the members that have a sample in each pixel of a period, row by row; `u32::MAX` where none has.
    firsts: Vec<u32>,
    sources: Option<Vec<u32>>,
}

impl Members {
    /// `at_once`: members that a run draws, one unless samples of the device's are members.
    pub fn new(basis: Basis, frame: Extent, drawing: Drawing, at_once: u32) -> Self {
        assert!(at_once == 1 || drawing == Drawing::SampleLocations, "{at_once} members at once as {drawing:?}");
        let mut members = Self { basis, frame, drawing, at_once, firsts: Vec::new(), sources: None };
        members.firsts = members.firsts_of_pixels();
        members.sources = members.nearest_sources();
        members
    }

    pub fn basis(&self) -> &Basis {
        &self.basis
    }

    pub fn count(&self) -> u32 {
        self.basis.member_count()
    }

    /// Members that a run draws: as many as there are left.
    pub fn at_once(&self) -> u32 {
        self.at_once
    }

    /// Runs in which all of them are drawn.
    pub fn run_count(&self) -> u32 {
        self.count().div_ceil(self.at_once)
    }

    /// Where in their pixels the members of a run have their samples, px; the middle where none is left.
    pub fn places_px(&self, run: u32) -> Vec<[f32; 2]> {
        let members = run * self.at_once..(run + 1) * self.at_once;
        let place = |member| self.basis.place_px(member).map(|at_px| at_px.fract() as f32);
        members.map(|member| if member < self.count() { place(member) } else { [0.5; 2] }).collect()
    }

    pub fn frame(&self) -> Extent {
        self.frame
    }

    pub fn drawing(&self) -> Drawing {
        self.drawing
    }

    /// Texels of what a member is drawn into.
    pub fn picture(&self) -> Extent {
        match self.drawing {
            Drawing::Layers | Drawing::Stipple => self.grid(),
            Drawing::Tuples | Drawing::SampleLocations => self.frame,
        }
    }

    /// A member's samples across and down, as many as a frame may have.
    pub fn grid(&self) -> Extent {
        // A side of P / B pixels has B samples in every P pixels.
        let samples =
            |pixels: u32, side: Side| (u64::from(pixels) * u64::from(side.bases)).div_ceil(side.pixels.into());
        let [x, y] = self.basis.sides;
        Extent::new(samples(self.frame.width, x) as u32, samples(self.frame.height, y) as u32)
    }

    /// Pixels between neighbouring texels of a member's picture, across and down. Where there is but one it stands as near to
    /// the next as a pixel: drivers move corners by parts of what lies between two texels (1/256 on many, 1/16 at worst).
    pub fn spacing_px(&self) -> [f64; 2] {
        let grid = self.grid();
        let [across, down] = self.basis.sides.map(Side::length_px);
        let is_whole = self.drawing.is_over_frame();
        let spacing = |samples: u32, apart: f64| if is_whole || samples == 1 { 1.0 } else { apart };
        [spacing(grid.width, across), spacing(grid.height, down)]
    }

    /// How the frame lies in a member's picture: its samples in the middles of texels.
    pub fn placement(&self, member: u32) -> Placement {
        if self.drawing == Drawing::SampleLocations {
            // It is the samples that are moved.
            return Placement::WHOLE;
        }
        let (picture, place) = (self.picture(), self.basis.place_px(member));
        // Over the whole frame a texel is a pixel, the first of which has a place as its pixel's has.
        let place = if self.drawing == Drawing::Tuples { place.map(f64::fract) } else { place };
        let axis = |pixels: u32, texels: u32, spacing: f64, place: f64| {
            let (pixels, texels) = (f64::from(pixels), f64::from(texels));
            let scale = pixels / (spacing * texels);
            [scale, 2.0 * ((0.5 * pixels - place) / spacing + 0.5) / texels - 1.0]
        };
        let [across, down] = self.spacing_px();
        let x = axis(self.frame.width, picture.width, across, place[0]);
        let y = axis(self.frame.height, picture.height, down, place[1]);
        Placement { scale: Vec2::new(x[0] as f32, y[0] as f32), shift: Vec2::new(x[1] as f32, y[1] as f32) }
    }

    /// The pixel that sample `index` of a member along an axis lies in: the twin of members.glsl.
    pub fn pixel(&self, member: u32, axis: usize, index: u32) -> u32 {
        let Side { pixels, bases } = self.basis.sides[axis];
        index / bases * pixels + self.first_pixels(member, axis)[(index % bases) as usize]
    }

    /// The pixels of the samples in the first whole number of bases that lie in whole pixels.
    fn first_pixels(&self, member: u32, axis: usize) -> Vec<u32> {
        let (side, place) = (self.basis.sides[axis], self.basis.place_px(member)[axis]);
        let at = |base: u32| place + f64::from(base) * side.length_px();
        (0..side.bases).map(|base| (at(base).floor() as u32).min(side.pixels - 1)).collect()
    }

    /// What members.glsl reads: of each member the pixels of its first samples, across and then down (`bases` of both sides a
    /// member); behind them, from `firsts_at` on, the first member of each pixel of a period.
    pub fn table(&self) -> Vec<u32> {
        let of_member = |member| [0, 1].into_iter().flat_map(move |axis| self.first_pixels(member, axis));
        (0..self.count()).flat_map(of_member).chain(self.firsts.iter().copied()).collect()
    }

    /// Where in the table the first members of pixels begin.
    pub fn firsts_at(&self) -> u32 {
        self.count() * (self.basis.sides[0].bases + self.basis.sides[1].bases)
    }

    fn firsts_of_pixels(&self) -> Vec<u32> {
        let [width, height] = self.basis.sides.map(|side| side.pixels);
        let mut firsts = vec![u32::MAX; width as usize * height as usize];
        for member in 0..self.count() {
            for y in self.first_pixels(member, 1) {
                for x in self.first_pixels(member, 0) {
                    let first = &mut firsts[(y * width + x) as usize];
                    *first = (*first).min(member);
                }
            }
        }
        firsts
    }

    /// Where a pixel of the frame has no sample: of each pixel, in row order, the nearest one that has some, itself where it has;
    /// None where every pixel has a sample.
    pub fn sources(&self) -> Option<&[u32]> {
        self.sources.as_deref()
    }

    fn nearest_sources(&self) -> Option<Vec<u32>> {
        if self.firsts.iter().all(|first| *first != u32::MAX) {
            return None;
        }
        let [period_x, period_y] = self.basis.sides.map(|side| side.pixels);
        let (width, height) = (self.frame.width, self.frame.height);
        let is_filled = |x: u32, y: u32| self.firsts[(y % period_y * period_x + x % period_x) as usize] != u32::MAX;
        // Rings of neighbours from all filled pixels outwards.
        let mut source = vec![u32::MAX; (width * height) as usize];
        let mut next = VecDeque::new();
        for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
            if is_filled(x, y) {
                source[(y * width + x) as usize] = y * width + x;
                next.push_back([x, y]);
            }
        }
        while let Some([x, y]) = next.pop_front() {
            let own = source[(y * width + x) as usize];
            let around = [[x.wrapping_sub(1), y], [x + 1, y], [x, y.wrapping_sub(1)], [x, y + 1]];
            for [x, y] in around.into_iter().filter(|[x, y]| *x < width && *y < height) {
                if source[(y * width + x) as usize] == u32::MAX {
                    source[(y * width + x) as usize] = own;
                    next.push_back([x, y]);
                }
            }
        }
        // A frame that is smaller than a basis may have no sample at all: its pixels are black.
        Some(source)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::choice::Choice;
    use crate::sampling::sampler::{Places, Sampler};
    use proptest::prelude::*;

    fn members(sides: [Side; 2], samples: f64, frame: Extent) -> Members {
        drawn(sides, samples, frame, Drawing::Layers)
    }

    fn drawn(sides: [Side; 2], samples: f64, frame: Extent, drawing: Drawing) -> Members {
        let basis = Basis::new(sides, &[], samples, Sampler::Random, Places::Spread, 5).unwrap();
        Members::new(basis, frame, drawing, 1)
    }

    proptest! {
        /// What the placement draws into the middle of a texel is the sample's place in the frame, in the pixel that the table
        /// says; and together members have the samples of the pattern.
        #[test]
        fn texels_are_samples_of_the_pattern(
            sides in prop::array::uniform2((1u32..12, 1u32..4)), samples in 0.4f64..5.0, width in 1u32..40, height in 1u32..40,
            is_whole: bool,
        ) {
            // Over the whole frame a member's samples lie in one place of their pixels.
            let sides = sides.map(|(pixels, bases)| Side::new(pixels, if is_whole { 1 } else { bases }));
            let drawing = if is_whole { Drawing::Tuples } else { Drawing::Layers };
            let members = drawn(sides, samples, Extent::new(width, height), drawing);
            let pattern = members.basis().pattern();
            let (grid, layer, mut found) = (members.grid(), members.picture(), vec![Vec::new(); (width * height) as usize]);
            for member in 0..members.count() {
                let Placement { scale, shift } = members.placement(member);
                for (x, y) in (0..grid.height).flat_map(|y| (0..grid.width).map(move |x| (x, y))) {
                    let pixel = [members.pixel(member, 0, x), members.pixel(member, 1, y)];
                    let texel = if is_whole { pixel } else { [x, y] };
                    let ndc = Vec2::new(
                        2.0 * (texel[0] as f32 + 0.5) / layer.width as f32 - 1.0,
                        2.0 * (texel[1] as f32 + 0.5) / layer.height as f32 - 1.0,
                    );
                    let at = ((ndc - shift) / scale + 1.0) * 0.5 * Vec2::new(width as f32, height as f32);
                    let inside = at - Vec2::new(pixel[0] as f32, pixel[1] as f32);
                    prop_assert!((-1e-3..1.001).contains(&inside.x) && (-1e-3..1.001).contains(&inside.y), "{:?}", inside);
                    if pixel[0] < width && pixel[1] < height {
                        found[(pixel[1] * width + pixel[0]) as usize].push((member, inside));
                    }
                }
            }
            for (index, found) in (0..).zip(&found) {
                let of_pattern = pattern.samples_of([index % width, index / width]);
                prop_assert_eq!(found.len(), of_pattern.len());
                for (member, inside) in found {
                    let is_there = |sample: &&crate::sampling::pattern::Sample| {
                        sample.subset == *member && (Vec2::from(sample.place_px) - *inside).abs().max_element() < 1e-3
                    };
                    prop_assert!(of_pattern.iter().any(|sample| is_there(&sample)));
                }
            }
        }

        #[test]
        fn gaps_are_filled_by_the_nearest(samples in 0.1f64..0.6, width in 3u32..20, height in 3u32..20) {
            let members = members([Side::new(3, 1), Side::new(2, 1)], samples, Extent::new(width, height));
            let pattern = members.basis().pattern();
            let has = |pixel: u32| !pattern.samples_of([pixel % width, pixel / width]).is_empty();
            let is_any_filled = (0..width * height).any(has);
            let Some(sources) = members.sources() else {
                prop_assert!((0..width * height).all(has));
                return Ok(());
            };
            for (pixel, source) in (0..).zip(sources.iter().copied()) {
                let apart = |other: u32| (pixel % width).abs_diff(other % width) + (pixel / width).abs_diff(other / width);
                let is_nearest = || (0..width * height).filter(|other| has(*other)).all(|other| apart(source) <= apart(other));
                let is_right = if is_any_filled { has(source) && is_nearest() } else { source == u32::MAX };
                prop_assert!(is_right, "{} from {}", pixel, source);
            }
        }
    }

    /// Every sample of the pattern is one of one run's, at its place.
    #[test]
    fn samples_of_the_device_are_members() {
        let basis = Basis::new([Side::new(3, 1), Side::new(2, 1)], &[], 2.5, Sampler::Relaxed, Places::Spread, 5);
        let basis = basis.unwrap().in_sixteenths();
        let members = Members::new(basis.clone(), Extent::new(9, 7), Drawing::SampleLocations, 4);
        assert_eq!((members.count(), members.run_count()), (15, 4));
        let places: Vec<[f32; 2]> = (0..4).flat_map(|run| members.places_px(run)).collect();
        assert_eq!((places.len(), places[15]), (16, [0.5; 2]));
        for sample in basis.pattern().samples() {
            assert_eq!(places[sample.subset as usize], sample.place_px);
        }
    }

    #[test]
    fn a_single_member_is_drawn_as_any_picture() {
        let frame = Extent::new(7, 5);
        let alone = members([Side::new(1, 1); 2], 1.0, frame);
        assert_eq!(alone.picture(), frame);
        let basis = || Basis::new([Side::new(1, 1); 2], &[], 1.0, Sampler::Relaxed, Places::Spread, 5).unwrap();
        for drawing in Drawing::ALL {
            assert_eq!(Members::new(basis(), frame, *drawing, 1).placement(0), Placement::WHOLE);
        }
    }
}
