//! `--sampler`: tuples are the samples of the pattern that it names, and more of any of them come to what path tracing sees.

use super::DEEP;
use crate::support::choices::words;
use crate::support::watched::{Watched, both};
use crate::support::{Feature, has};
use quincunx::metrics;

const LENS: [(&str, &str); 3] = [("size", "64x48"), ("brdf", "lambert"), ("aperture", "0.15")];

/// `interleaved_sampling` draws the samples of the same pattern, each by itself: one picture but for what rounds at edges, and
/// another pattern is another one.
#[test]
fn tuples_are_the_samples_that_interleaved_sampling_draws() {
    let watched = Watched::open("cornell");
    if !has(&watched.session.gpu.caps, Feature::ExactPositions) {
        return;
    }
    // A lens of a micron: of a wide one the second axis points up in one technique and down in the other.
    let common = [("shutter", "0,0.1"), ("direct-shadow", "none"), ("aperture", "0.000001")];
    let common = both(&LENS, &common);
    let tuples = |sampler: &str| {
        let own = [("shading", "ssaa"), ("spp", "4"), ("tuples", "16"), ("sampler", sampler)];
        watched.picture(DEEP, &both(&common, &own))
    };
    let [r2, jittered] = ["r2", "jittered"].map(|sampler| {
        let members = [("members", "tuples"), ("effect", "aa,motion,defocus"), ("samples", "4"), ("sampler", sampler)];
        watched.picture("interleaved_sampling", &both(&common, &members))
    });
    let flip = |one, other| metrics::compare(one, other, 0.1).unwrap().metrics.flip;
    let (same, other) = (flip(&tuples("r2"), &r2), flip(&tuples("r2"), &jittered));
    println!("the same pattern {same}, another one {other}");
    assert!(same < 0.005 && other > 0.03, "{same} {other}");
}

/// Sixteen sets of four samples have less than half of one set's error, in the mean over three seeds; independent ones come to a
/// quarter.
#[test]
fn more_of_any_tuples_come_to_what_path_tracing_sees() {
    let watched = Watched::open("cornell");
    if !has(&watched.session.gpu.caps, Feature::ExactPositions) {
        return;
    }
    let traced = [("transport", "direct"), ("light-visibility", "off"), ("emissive", "off"), ("spp", "1024")];
    let reference = watched.picture("path_traced", &both(&LENS, &traced));
    let rmse = |sampler: &str, sets: &str| {
        let of_seed = |seed: &str| {
            let own = [("spp", "4"), ("sampler", sampler), ("accumulate", sets), ("seed", seed)];
            metrics::compare(&watched.picture(DEEP, &both(&LENS, &own)), &reference, 0.1).unwrap().metrics.rmse
        };
        ["1", "2", "3"].map(of_seed).iter().sum::<f64>() / 3.0
    };
    for sampler in words(DEEP, "sampler") {
        let errors = ["1", "16"].map(|sets| rmse(sampler, sets));
        println!("{sampler}: {errors:?}");
        assert!(errors[1] < 0.5 * errors[0], "{sampler}: {errors:?}");
    }
}
