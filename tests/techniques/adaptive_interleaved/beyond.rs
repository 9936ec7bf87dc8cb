//! What the paper does not have: rays in another order, virtual lights drawn by contribution, refinement until an error,
//! guidance by what lies around.

use super::{CORNELL, EXTENT, NAME, sampler};
use crate::support::difference::require_same;
use crate::support::watched::{Watched, both};
use glam::{Vec3, vec3};
use quincunx::gpu::shader::structs::AdaptiveParams;

/// Threads side by side that have a tile, or a slot of several: the same rays.
#[test]
fn both_orders_of_rays_give_the_same_picture() {
    let watched = Watched::open("cornell");
    for own in [
        &[("tile", "3x3")][..],
        &[("tile", "8x8"), ("base", "3"), ("mode", "max")],
        &[("tile", "5x2"), ("id-max", "7"), ("workgroup", "8x8"), ("mode", "igi")],
        &[("tile", "4x3"), ("id-scale", "2"), ("medium", "0.1,0,0")],
    ] {
        let picture = |order| watched.picture(NAME, &both(&both(&CORNELL, own), &[("ray-order", order)]));
        require_same(&watched.session.gpu, &picture("slot"), &picture("tile"), &own);
    }
}

/// All virtual lights at once are what both come to; by contribution with fewer rays sooner.
#[test]
fn lights_drawn_by_contribution_come_sooner_to_all_of_them() {
    let watched = Watched::open("cornell");
    let shared = both(&CORNELL, &[("components", "id"), ("vpls", "252")]);
    let run = |choice: &str, max: &str| {
        // Nothing is filtered: what a pixel has is judged, not what its tile has.
        let own = [("mode", "max"), ("tile", "3x3"), ("id-choice", choice), ("id-max", max)];
        let renderer = watched.render_stages(NAME, &both(&shared, &own), &["irradiance.id"]);
        let irradiance = watched.rgb(&renderer, "irradiance.id");
        (irradiance, renderer.measured_counters().unwrap()["rays"])
    };
    let (exact, all_rays) = run("even", "9");
    let error = |found: &[[f32; 3]]| {
        let squares = found
            .iter()
            .zip(&exact)
            .map(|(one, other)| (Vec3::from_array(*one) - Vec3::from_array(*other)).length_squared());
        (squares.sum::<f32>() / exact.len() as f32).sqrt()
    };
    let mean = |found: &[[f32; 3]]| found.as_flattened().iter().sum::<f32>() / found.len() as f32;
    for max in ["1", "4"] {
        let [(even, even_rays), (drawn, drawn_rays)] = ["even", "contribution"].map(|choice| run(choice, max));
        let (of_even, of_drawn) = (error(&even), error(&drawn));
        println!("{max}: {of_even} by {even_rays} rays, {of_drawn} by {drawn_rays}; all {all_rays}");
        assert!((mean(&drawn) / mean(&exact) - 1.0).abs() < 0.01, "{} and {}", mean(&drawn), mean(&exact));
        assert!(drawn_rays <= even_rays, "{drawn_rays} and {even_rays}");
        assert!(of_drawn < 0.5 * of_even, "{of_drawn} and {of_even}");
    }
}

/// Each tile has the iterations that the variance of its pixels in the initial pass asks for; none where they agree.
#[test]
fn tiles_are_refined_until_the_error_that_is_wanted() {
    let watched = Watched::open("cornell");
    let shared = both(&CORNELL, &[("components", "ss"), ("tile", "3x3")]);
    let first = watched.render_stages(NAME, &both(&shared, &[("mode", "igi")]), &["irradiance.ss"]);
    let first = watched.rgb(&first, "irradiance.ss");
    let sampler = AdaptiveParams {
        width: EXTENT.width,
        height: EXTENT.height,
        tile_columns: EXTENT.width.div_ceil(3),
        ..sampler([3, 3], 9)
    };
    let mut rays = Vec::new();
    for wanted in ["0.3", "0.1", "0.02"] {
        let own = both(&shared, &[("until-error", wanted)]);
        let renderer = watched.render_stages(NAME, &own, &["guidance.ss.iterations"]);
        let iterations = watched.integers(&renderer, "guidance.ss.iterations");
        rays.push(renderer.measured_counters().unwrap()["rays"]);
        let wanted: f32 = wanted.parse().unwrap();
        let (mut off, mut count, mut between) = (0, 0, 0);
        for tile in 0..sampler.tile_columns * EXTENT.height.div_ceil(3) {
            let texels: Vec<usize> = sampler.texels_of(tile).map(|[x, y]| (y * EXTENT.width + x) as usize).collect();
            let luminances: Vec<f32> =
                texels.iter().map(|texel| Vec3::from_array(first[*texel]).dot(vec3(0.2126, 0.7152, 0.0722))).collect();
            // Beside the background fewer texels decide: those are not known here.
            if luminances.len() < 9 || luminances.contains(&0.0) {
                continue;
            }
            let mean = luminances.iter().sum::<f32>() / 9.0;
            let variance = luminances.iter().map(|one| (one - mean).powi(2)).sum::<f32>() / 8.0;
            let needed = (variance / 9.0).sqrt() / (wanted * mean);
            let expected = (needed * needed).ceil().clamp(1.0, 9.0) as u32;
            off += u32::from(iterations[texels[0]] != expected);
            between += u32::from((2..9).contains(&expected));
            count += 1;
        }
        println!("{wanted}: {off} of {count} off, {between} between");
        // Halves round what is read back.
        assert!(count > 150 && between > 5 && off * 50 <= count, "{wanted}: {off} of {count}, {between}");
    }
    assert!(rays[0] < rays[1] && rays[1] < rays[2], "{rays:?}");
}

/// The most that the tiles around ask for, or those of the other component over the same pixels: by the stages of guidance
/// that is local.
#[test]
fn guidance_may_see_neighbours_and_other_components() {
    let watched = Watched::open("cornell");
    let [width, height] = [EXTENT.width as usize, EXTENT.height as usize];
    for scale in [1, 2] {
        let text = scale.to_string();
        let shared = both(&CORNELL, &[("id-scale", &text)]);
        let iterations = |of: &str| {
            let stages = ["guidance.id.iterations", "guidance.ss.iterations"];
            let renderer = watched.render_stages(NAME, &both(&shared, &[("guidance-of", of)]), &stages);
            stages.map(|stage| watched.integers(&renderer, stage))
        };
        let (own, around, joined) = (iterations("tile"), iterations("neighbours"), iterations("components"));
        let mut raised = 0;
        for (component, other) in [(0, 1), (1, 0)] {
            let side = if component == 0 { 3 * scale } else { 3 };
            let most = |x: std::ops::Range<usize>, y: std::ops::Range<usize>, of: &[u32]| {
                let pixels = y.flat_map(|y| x.clone().map(move |x| y.min(height - 1) * width + x.min(width - 1)));
                pixels.map(|pixel| of[pixel]).max().unwrap()
            };
            for (x, y) in (0..height).step_by(side).flat_map(|y| (0..width).step_by(side).map(move |x| (x, y))) {
                let at = y * width + x;
                let [left, above] = [x, y].map(|at| at.saturating_sub(side));
                let expected =
                    most(left..(x + 2 * side).min(width), above..(y + 2 * side).min(height), &own[component]);
                assert_eq!(around[component][at], expected, "neighbours of {component} at {x},{y}, {scale}");
                let expected = most(x..x + side, y..y + side, &own[other]).max(own[component][at]);
                assert_eq!(joined[component][at], expected, "components at {x},{y} of {component}, {scale}");
                raised += u32::from(expected > own[component][at]);
            }
        }
        assert!(raised > 20, "{raised}");
    }
}
