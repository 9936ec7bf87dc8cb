//! new_technique: where it must equal deferred shading, and what its own setting does.

use crate::support::difference::require_same;
use crate::support::watched::{Watched, both};

const NAME: &str = "new_technique";
const SIZE: (&str, &str) = ("size", "97x53");

/// With BLEND surfaces, emissive ones, and rays for shadows.
#[test]
fn without_a_factor_it_is_deferred_shading() {
    for (spec, changes) in [
        ("lamps:objects=20,lights=20", &[][..]),
        ("cornell", &[("direct-shadow", "ray"), ("brdf", "lambert")]),
        ("fence:lights=6", &[("ambient", "0.2")]),
    ] {
        let watched = Watched::open(spec);
        let changes = both(changes, &[SIZE]);
        let deferred = watched.picture("deferred", &both(&changes, &[("cull", "none")]));
        require_same(&watched.session.gpu, &watched.picture(NAME, &changes), &deferred, &(spec, changes));
    }
}

#[test]
fn the_factor_scales_the_light_of_the_lights() {
    let watched = Watched::open("lamps:objects=20,lights=20");
    let picture = |scale| watched.picture(NAME, &[SIZE, ("rig", "none"), ("light-scale", scale)]);
    let (plain, doubled) = (picture("1"), picture("2"));
    assert!(plain.mean()[0] > 0.01);
    for (one, other) in plain.pixels.as_flattened().iter().zip(doubled.pixels.as_flattened()) {
        assert!((2.0 * one - other).abs() <= 1e-6 * other.abs(), "{one} and {other}");
    }
}
