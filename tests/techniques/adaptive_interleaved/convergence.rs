//! Each component comes to its paths as its samples become many, at the rate of samples that are evenly spread: every tile
//! has one pixel, and nothing is filtered.

use super::NAME;
use crate::support::watched::{Watched, both};
use quincunx::picture::Picture;

/// Errors by the count of samples, each four times the one before.
struct Converging([f32; 4]);

impl Converging {
    /// The slope of the line through the logarithms of errors and counts: -0.5 is that of independent samples.
    fn exponent(&self) -> f32 {
        let around_middle = self.0.iter().zip([-3.0, -1.0, 1.0, 3.0]);
        // Counts are two octaves apart: 20 is the sum of the squares of what the errors are weighed by.
        around_middle.map(|(error, weight)| weight * error.log2()).sum::<f32>() / 20.0
    }

    fn require_at_most(&self, exponent: f32) {
        let errors = self.0;
        println!("{errors:?}: exponent {}", self.exponent());
        assert!(self.exponent() < exponent, "{errors:?}: exponent {}", self.exponent());
        assert!(errors[3] < 0.15 * errors[0], "{errors:?}");
    }
}

/// RMSE over all but the worst 15 % of the pixels: paths spread over their pixels, and where those show an edge no count of
/// samples at their middle helps.
fn error(picture: &Picture, reference: &Picture) -> f32 {
    let pairs = picture.pixels.iter().zip(&reference.pixels);
    let mut squares: Vec<f32> = pairs.map(|(one, other)| (0..3).map(|i| (one[i] - other[i]).powi(2)).sum()).collect();
    squares.sort_by(f32::total_cmp);
    let kept = &squares[..squares.len() * 17 / 20];
    (kept.iter().sum::<f32>() / kept.len() as f32).sqrt()
}

const OWN: [(&str, &str); 3] = [("mode", "max"), ("tile", "1x1"), ("position", "float")];
const PATHS: [(&str, &str); 2] = [("brdf", "lambert"), ("ambient-visibility", "off")];

#[test]
fn soft_shadows_converge_to_paths() {
    let watched = Watched::open("cornell");
    let shared = [("size", "64x48"), ("emissive", "on"), ("background", "0")];
    let paths = both(&both(&shared, &PATHS), &[("transport", "direct"), ("spp", "1024")]);
    let reference = watched.picture("path_traced", &paths);
    let of = |most: &str| {
        let own = both(&both(&shared, &OWN), &[("components", "ss"), ("ss-max", most)]);
        error(&watched.picture(NAME, &own), &reference)
    };
    Converging(["1", "4", "16", "64"].map(of)).require_at_most(-0.6);
}

/// One set of virtual lights is that of every pixel, so that their errors are one: three sets are averaged.
#[test]
fn indirect_light_converges_to_paths() {
    let watched = Watched::open("cornell");
    let shared = [("size", "48x36"), ("emissive", "on"), ("background", "0")];
    let light = [("transport", "one-bounce"), ("direct-light", "off"), ("spp", "4096")];
    let reference = watched.picture("path_traced", &both(&both(&shared, &PATHS), &light));
    let of = |count: &str| {
        let of_seed = |seed: &str| {
            let lights = [("vpls", count), ("vpl-clamp", "0.2%"), ("id-scale", "1"), ("id-max", "1"), ("seed", seed)];
            let own = both(&both(&shared, &OWN), &both(&[("components", "id")], &lights));
            error(&watched.picture(NAME, &own), &reference)
        };
        let errors = ["1", "2", "3"].map(of_seed);
        (errors.map(|error| error * error).iter().sum::<f32>() / 3.0).sqrt()
    };
    Converging(["4", "16", "64", "256"].map(of)).require_at_most(-0.45);
}

#[test]
fn airlight_converges_to_paths() {
    let watched = Watched::open("cornell");
    let medium = ("medium", "0.2,0.05,0.4");
    let shared = [("size", "48x36"), ("emissive", "on"), ("background", "0"), ("lights", "0"), medium];
    let light = [("transport", "direct"), ("airlight", "seen"), ("direct-light", "off"), ("spp", "4096")];
    let reference = watched.picture("path_traced", &both(&both(&shared, &PATHS), &light));
    let of = |most: &str| {
        let own = both(&both(&shared, &OWN), &[("components", "pm"), ("pm-max", most), ("pm-steps", "4")]);
        error(&watched.picture(NAME, &own), &reference)
    };
    Converging(["1", "4", "16", "64"].map(of)).require_at_most(-0.6);
}
