//! Executions a pixel of whole scenes at the paper's size, as the paper gives them (Clarberg & Munkberg 2014, figure 5).
//!
//! Smaller pictures have more, of fewer triangles too: more of their pixels lie on the rims of things. All pixels have the same
//! tuples, which are a quarter of the layers' triangles of 8 samples of 32.

use super::DEEP;
use crate::support::moving::moving;
use crate::support::watched::{Changes, Watched, both};

/// `paper`: its executions a pixel, of which a twentieth may be missing or too many: it says nothing of apertures.
#[track_caller]
fn require_rate(watched: &Watched, blur: Changes<'_>, paper: f64) {
    let plain = [("brdf", "lambert"), ("direct-shadow", "none"), ("light-cutoff", "1000"), ("reconstruct", "off")];
    let common = both(&plain, &[("size", "1280x720"), ("spp", "8"), ("tuples", "8")]);
    let counters = watched.render(DEEP, &both(&common, blur)).measured_counters().unwrap();
    assert_eq!(counters["samples_without_colour"], 0.0, "{counters:?}");
    let rate = counters["shaded_per_pixel"];
    println!("{}: {rate} executions a pixel, the paper's {paper}", watched.session.scene.name);
    assert!((rate / paper - 1.0).abs() < 0.05, "{rate} for {paper}");
}

#[test]
fn the_arena_in_flight_is_shaded_as_often_as_in_the_paper() {
    let watched = Watched::with_scene(moving("arena", [10.0, 10.0 + 1.0 / 60.0]));
    require_rate(&watched, &[("camera", "flight"), ("aperture", "0.1")], 1.54);
}

/// In place of the paper's Sponza, with as many triangles, lights and draws.
#[test]
fn a_hall_is_shaded_as_often_as_in_the_paper() {
    require_rate(&Watched::open("hall:lights=16,draws=392"), &[("aperture", "0.1")], 1.45);
}

#[test]
fn a_power_station_is_shaded_as_often_as_in_the_paper() {
    require_rate(&Watched::open("power"), &[("aperture", "0.15")], 1.31);
}
