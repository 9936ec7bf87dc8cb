//! A driver that ends long loops without a word must not be believed: `Identity::loop_end`, glsl/loops.glsl.

use crate::support;
use crate::support::difference::require_same;
use crate::support::shared_scenes;
use crate::support::watched::{Changes, Watched};
use quincunx::caps::quirks::LoopEnd;

/// One light more than the iterations of the defect; a driver without it adds them all.
#[test]
fn a_sum_that_the_driver_ends_early_is_no_picture() {
    let watched = Watched::open("cornell");
    for (technique, changes) in [
        (
            "deferred",
            &[("size", "16x16"), ("lights", "65536"), ("direct-shadow", "none"), ("cull", "none")] as Changes<'_>,
        ),
        // What ends early goes through half floats, a filter and an upsampling here.
        (
            "adaptive_interleaved",
            &[("size", "8x8"), ("components", "id"), ("vpls", "65536"), ("tile", "1x1"), ("id-max", "1")],
        ),
    ] {
        let picture = watched.render(technique, changes).picture();
        match watched.session.gpu.caps.identity.loop_end() {
            None => drop(picture.unwrap()),
            Some(LoopEnd { iterations, gone_in }) => {
                let error = picture.unwrap_err();
                assert_eq!(error.exit_code(), 1, "{technique}: {error}");
                assert!(error.to_string().contains(&format!("after {iterations} iterations")), "{technique}: {error}");
                assert!(error.to_string().contains(&format!("a newer driver ({gone_in})")), "{technique}: {error}");
            }
        }
    }
}

/// 1,663 lights, one of which casts shadow rays, on up to 32 pixels a thread; and 188 that all do.
#[test]
fn as_many_pixels_as_a_thread_may_have_iterations_for() {
    let Some(folder) = shared_scenes() else { return };
    for (map, technique, changes) in [
        ("oa_thor", "interleaved_deferred", [("split", "none"), ("direct", "interleaved")]),
        ("kaos", "deferred", [("direct-shadow", "ray"), ("cull", "none")]),
    ] {
        let watched = Watched::open(folder.join(format!("maps/{map}.glb")).to_str().unwrap());
        let picture = |texels| {
            let own = [("size", "64x36"), ("texels", texels)];
            watched.picture(technique, &support::watched::both(&changes, &own))
        };
        let plain = picture("1");
        for texels in ["auto", "16", "32"] {
            require_same(&watched.session.gpu, &picture(texels), &plain, &(map, texels));
        }
    }
}
