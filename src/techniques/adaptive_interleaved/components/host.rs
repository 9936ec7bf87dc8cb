//! What a component does on the host: the twin of what a file of glsl/techniques/adaptive_interleaved/components gives to
//! estimate.glsl and guidance.glsl. Dubla 2009, Listing 1.

use crate::bvh::shadow::ShadowRays;
use crate::gpu::shader::structs::{AdaptiveParams, FrameBlock, LightBlock};
use crate::picture::tonemap::REC709_WEIGHTS;
use glam::Vec3;

/// Weights of Rec. 709's primaries.
pub const LUMINANCE: Vec3 = {
    let [red, green, blue] = REC709_WEIGHTS;
    Vec3::new(red as f32, green as f32, blue as f32)
};

/// A component with its samples.
pub trait HostComponent: Sync {
    /// Whether a texel has an estimate.
    fn is_estimated(&self, point: &Point) -> bool {
        point.has_surface
    }

    /// One iteration of a texel, whose place in its tile is `slot`.
    fn contribute(&self, given: &Given<'_>, point: &Point, slot: u32, iteration: u32, estimate: &mut Estimate);

    /// What an estimated texel has found in the initial pass: the mean of its information.
    fn found_word(&self, params: &AdaptiveParams, _slot: u32, estimate: &Estimate) -> u32 {
        (estimate.information / params.base as f32).to_bits()
    }

    /// What the estimated texels of a tile have found together, at least one, in the order of their slots: the mean
    /// (mean_guidance.glsl).
    fn refine_of(&self, _: &AdaptiveParams, words: &[u32]) -> f32 {
        mean_of(words)
    }

    /// Whether a tile that has found 1 needs no further iteration.
    fn is_penumbra(&self) -> bool;
}

/// What all components read.
pub struct Given<'a> {
    pub params: &'a AdaptiveParams,
    pub frame: &'a FrameBlock,
    /// The scene's own lights.
    pub lights: &'a [LightBlock],
    pub shadows: ShadowRays<'a>,
}

/// What the pixel of a texel shows.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    pub pixel: [u32; 2],
    pub position_ws: Vec3,
    /// Unit vector; 0 without a surface.
    pub normal_ws: Vec3,
    pub has_surface: bool,
}

/// A texel's estimate.
#[derive(Clone, Copy, Debug)]
pub struct Estimate {
    /// Irradiance, of airlight radiance, summed over the iterations.
    pub sum: Vec3,
    /// What guides: the component's own, summed over the iterations.
    pub information: f32,
    /// Lights that were met in any of them, and in all, a bit each.
    pub lit_any: u32,
    pub lit_all: u32,
    pub ray_count: u32,
}

impl Estimate {
    pub const NONE: Self = Self { sum: Vec3::ZERO, information: 0.0, lit_any: 0, lit_all: u32::MAX, ray_count: 0 };
}

/// The mean of words that are numbers, at least one.
pub fn mean_of(words: &[u32]) -> f32 {
    words.iter().map(|word| f32::from_bits(*word)).sum::<f32>() / words.len() as f32
}
