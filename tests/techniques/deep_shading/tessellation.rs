//! What tessellation and blur do to executions a pixel where nothing hides anything (Clarberg & Munkberg 2014, section 6.1 and
//! figure 7): blurred samples fall on shading space by chance, and leave pixels of small triangles without any.

use super::DEEP;
use crate::support::watched::{Changes, Watched, both};
use quincunx::sampling::pcg::Pcg32;
use std::collections::HashSet;
use std::f64::consts::TAU;

const SIZE: [u32; 2] = [320, 180];
const SPP: u32 = 8;
const LAMBERT: (&str, &str) = ("brdf", "lambert");

/// The panel as its scene has it: its width and a picture's height where it stands, metres, and its turn.
const SIDE_M: f64 = 0.8;
const SEEN_M: f64 = 1.237_345;
const TURNS: f64 = 0.0484;

fn px_m() -> f64 {
    SEEN_M / f64::from(SIZE[1])
}

/// Pairs of a triangle and a pixel of shading space that have a sample, for each pixel of the picture, where every sample lies anywhere in
/// its pixel and is moved to anywhere on a disc `blur_px` wide.
fn by_chance(parts: f64, blur_px: f64) -> f64 {
    let mut random = Pcg32::new(7, 0);
    let mut unit = || f64::from(random.unit());
    let (sine, cosine) = (TAU * TURNS).sin_cos();
    let mut seen = HashSet::new();
    for (y, x) in (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| (y, x))) {
        for _ in 0..SPP {
            let (distance, angle) = (0.5 * blur_px * unit().sqrt(), TAU * unit());
            let at = [f64::from(x) + unit() + distance * angle.cos(), f64::from(y) + unit() + distance * angle.sin()];
            let [right, down] = [0, 1].map(|axis: usize| (at[axis] - 0.5 * f64::from(SIZE[axis])) * px_m());
            let along = [right * cosine - down * sine, -right * sine - down * cosine];
            let [s, t] = along.map(|metres| (metres / SIDE_M + 0.5) * parts);
            if [s, t].iter().any(|at| !(0.0..parts).contains(at)) {
                continue;
            }
            let is_upper = (s - s.floor()) + (t - t.floor()) > 1.0;
            seen.insert((at.map(|pixel| pixel.floor() as i32), [s, t].map(|square| square as u32), is_upper));
        }
    }
    seen.len() as f64 / f64::from(SIZE[0] * SIZE[1])
}

#[test]
fn blurred_samples_fall_by_chance_and_more_so_on_small_triangles() {
    let common = [("size", "320x180"), ("spp", "8"), ("tuples", "32"), LAMBERT, ("direct-shadow", "none")];
    // A panel twice as far as what is in focus is blurred as wide as the lens is.
    let blur_px = 12.0;
    let aperture = format!("{:.6}", blur_px * px_m());
    let lens = [("focus", "1"), ("aperture", aperture.as_str())];
    let stochastic = [("visibility", "stochastic"), ("pixel-samples", "own")];
    let mut falls = Vec::new();
    for side_px in [16.0, 2.0] {
        let parts = (SIDE_M / (side_px * px_m())).round();
        let watched = Watched::open(&format!("panel:parts={parts}"));
        let rate = |changes: Changes<'_>| {
            let counters = watched.render(DEEP, &both(&common, changes)).measured_counters().unwrap();
            assert_eq!(counters["samples_without_colour"], 0.0, "{changes:?}");
            counters["shaded_per_pixel"]
        };
        let (sharp, chance) = (rate(&[]), by_chance(parts, blur_px));
        let [tuples, own] = [&lens[..], &both(&lens, &stochastic)].map(rate);
        println!("{side_px} pixels: {sharp} sharp, {tuples} of 32 tuples, {own} stochastic, {chance} by chance");
        assert!((own / chance - 1.0).abs() < 0.01, "{side_px}: {own} for {chance}");
        // Samples of tuples are spread more evenly than by chance.
        assert!((0.97..1.03).contains(&(tuples / chance)), "{side_px}: {tuples} for {chance}");
        falls.push(own / sharp);
    }
    assert!(falls[1] < 0.95 * falls[0], "{falls:?}");
}
