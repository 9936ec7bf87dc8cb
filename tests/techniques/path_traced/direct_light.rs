//! `--direct-light off`: what is left is what other surfaces, or the medium, have scattered before.

use crate::support::watched::{Watched, both};

/// What comes straight and what does not add up to all, the view of what shines by itself counted once. Shadow rays, and
/// scattered rays that meet emitters or the surroundings, are both among it.
#[test]
fn straight_light_and_the_rest_are_all_of_it() {
    let watched = Watched::open("cornell");
    for common in [
        &[("transport", "one-bounce"), ("emissive", "on")][..],
        &[("transport", "full"), ("emissive", "on"), ("ambient", "0.3"), ("brdf", "lambert")][..],
        &[("transport", "one-bounce"), ("vpl-visibility", "off"), ("emissive", "on")][..],
    ] {
        let mean = |own: &[(&str, &str)]| {
            let shared = [("size", "36x27"), ("spp", "256")];
            watched.picture("path_traced", &both(&both(&shared, common), own)).mean()
        };
        let (all, rest) = (mean(&[]), mean(&[("direct-light", "off")]));
        let straight = mean(&[("transport", "direct")]);
        let seen = mean(&[("transport", "direct"), ("direct-light", "off")]);
        for channel in 0..3 {
            let sum = rest[channel] + straight[channel] - seen[channel];
            assert!((sum / all[channel] - 1.0).abs() < 0.015, "{common:?}, {channel}: {sum} and {}", all[channel]);
            assert!(rest[channel] - seen[channel] > 0.03 * all[channel], "{common:?}: no light is left");
            assert!(straight[channel] - seen[channel] > 0.1 * all[channel], "{common:?}: no light is straight");
        }
    }
}
