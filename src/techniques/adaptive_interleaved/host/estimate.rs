//! The estimate of one component, tile by tile: initial pass, guidance, further iterations (Dubla 2009, Listing 1). Twin of
//! glsl/techniques/adaptive_interleaved/estimate.glsl and guidance.glsl.

use crate::error::Result;
use crate::gpu::shader::structs::AdaptiveParams;
use crate::interrupt;
use crate::passes::encode;
use crate::techniques::adaptive_interleaved::components::{Estimate, Given, HostComponent, LUMINANCE, Point};
use rayon::prelude::*;
use std::ops::Range;

/// What a tile comes to.
pub struct TileEstimate {
    /// Iterations after the initial pass.
    pub further: u32,
    /// In the order of `AdaptiveParams::texels_of`.
    pub texels: Vec<TexelEstimate>,
}

pub struct TexelEstimate {
    /// Row-major place among the component's texels.
    pub index: usize,
    /// The mean of the iterations, as halves.
    pub irradiance: [u32; 2],
    pub ray_count: u32,
}

/// All tiles, in their order. `points`: of the frame's pixels. `is_guided`: tiles iterate on after the initial pass.
///
/// Errors: Ctrl-C (exit code 130).
pub fn tiles(
    component: &dyn HostComponent,
    given: &Given<'_>,
    points: &[Point],
    is_guided: bool,
) -> Result<Vec<TileEstimate>> {
    let one = |tile| {
        interrupt::check()?;
        Ok(estimate(component, given, points, tile, is_guided))
    };
    (0..given.params.tile_count).into_par_iter().map(one).collect()
}

fn estimate(
    component: &dyn HostComponent,
    given: &Given<'_>,
    points: &[Point],
    tile: u32,
    is_guided: bool,
) -> TileEstimate {
    let params = given.params;
    let point_of = |texel: [u32; 2]| {
        let [x, y] = texel.map(|side| side * params.scale);
        points[(y * given.frame.width_px + x) as usize]
    };
    let of_texel = |texel| {
        let (slot, point) = (params.slot_of(texel), point_of(texel));
        Texel { texel, slot, point, is_estimated: component.is_estimated(&point), estimate: Estimate::NONE }
    };
    let mut texels: Vec<Texel> = params.texels_of(tile).map(of_texel).collect();
    texels.iter_mut().for_each(|texel| texel.iterate(component, given, 0..params.base));
    let further = if is_guided { further_iterations(component, params, &texels) } else { 0 };
    let end = params.base + further;
    texels.iter_mut().for_each(|texel| texel.iterate(component, given, params.base..end));
    let results = texels.iter().map(|Texel { texel: [x, y], estimate, .. }| TexelEstimate {
        index: (y * params.width + x) as usize,
        irradiance: encode::halves(estimate.sum / end as f32),
        ray_count: estimate.ray_count,
    });
    TileEstimate { further, texels: results.collect() }
}

/// A texel of a tile at work.
struct Texel {
    texel: [u32; 2],
    slot: u32,
    point: Point,
    is_estimated: bool,
    estimate: Estimate,
}

impl Texel {
    fn iterate(&mut self, component: &dyn HostComponent, given: &Given<'_>, iterations: Range<u32>) {
        if self.is_estimated {
            iterations.for_each(|i| component.contribute(given, &self.point, self.slot, i, &mut self.estimate));
        }
    }
}

fn further_iterations(component: &dyn HostComponent, params: &AdaptiveParams, texels: &[Texel]) -> u32 {
    let estimated = texels.iter().filter(|texel| texel.is_estimated);
    if params.until_error > 0.0 {
        let of_one = |texel: &Texel| texel.estimate.sum.dot(LUMINANCE) / params.base as f32;
        return params.further_until_error(&estimated.map(of_one).collect::<Vec<_>>());
    }
    let words: Vec<u32> = estimated.map(|texel| component.found_word(params, texel.slot, &texel.estimate)).collect();
    match words.is_empty() {
        true => 0,
        false => params.further_iterations(component.refine_of(params, &words), component.is_penumbra()),
    }
}
