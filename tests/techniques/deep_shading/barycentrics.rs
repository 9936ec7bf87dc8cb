//! Places on triangles that the rasteriser interpolates, or the device gives every fragment, in place of computed ones
//! (`--barycentrics`; Clarberg & Munkberg 2014, section 5).

use super::{DEEP, FRAGMENT, SIZE, refusal, turning};
use crate::support::watched::{Changes, Watched, both};
use crate::support::{Feature, has, placing_steps};
use quincunx::metrics;
use quincunx::picture::Picture;

/// Triangles as they are, which is what these weights are of.
const CORNERS: Changes<'_> = &[FRAGMENT, ("conservative", "none")];

/// The picture, and what does not depend on where in a triangle a place is.
fn shaded(watched: &Watched, common: Changes<'_>, barycentrics: &str) -> (Picture, [f64; 4]) {
    let changes = both(&both(common, CORNERS), &[("barycentrics", barycentrics)]);
    let renderer = watched.render(DEEP, &changes);
    let counters = renderer.measured_counters().unwrap();
    let counted = ["shading_pixels_drawn", "shader_invocations", "samples_seen", "samples_without_colour"];
    (renderer.picture().unwrap(), counted.map(|name| counters[name]))
}

/// The same is shaded, as nearly where as corners are snapped and levels of textures are differences of neighbours.
fn require_near(barycentrics: &str) {
    let scenes: [(Watched, Changes<'_>); 3] = [
        (Watched::open("hall:triangles=8000"), &[("aperture", "0.1")]),
        (Watched::with_scene(turning("fence:lights=6,alpha=mask")), &[("camera", "rotor")]),
        (Watched::open("cornell"), &[("shading-scale", "0.5")]),
    ];
    for (watched, changes) in &scenes {
        let common = &both(&[SIZE, ("spp", "4"), ("direct-shadow", "none")], changes);
        let (computed, counted) = shaded(watched, common, "computed");
        let (found, found_counted) = shaded(watched, common, barycentrics);
        assert_eq!(found_counted, counted, "{barycentrics}: {changes:?}");
        let metrics::Metrics { rmse, flip, .. } = metrics::compare(&found, &computed, 0.1).unwrap().metrics;
        println!("{barycentrics}, {changes:?}: rmse {rmse}, FLIP {flip}");
        let steps = placing_steps(&watched.session.gpu.caps);
        assert!(
            rmse > 0.0 && rmse < 0.003 * steps && flip < 0.01 * steps,
            "{barycentrics}, {changes:?}: {rmse}, {flip}"
        );
    }
}

#[test]
fn interpolated_places_are_nearly_the_computed_ones() {
    require_near("interpolated");
}

#[test]
fn the_device_s_own_places_are_nearly_the_computed_ones() {
    let watched = Watched::open("cornell");
    if has(&watched.session.gpu.caps, Feature::FragmentBarycentrics) {
        require_near("device");
    }
}

#[test]
fn hulls_have_no_corners_to_interpolate_between() {
    let watched = Watched::open("cornell");
    for conservative in ["auto", "vertex"] {
        let text = refusal(&watched, &[FRAGMENT, ("barycentrics", "interpolated"), ("conservative", conservative)]);
        for words in ["--barycentrics interpolated", "corners", "--conservative hardware and none"] {
            assert!(text.contains(words), "{text}");
        }
    }
}
