//! Stochastic rasterisation sees the very samples of interleaved rasterisation: what differs lies on edges, which the rasteriser
//! places to a 256th of a layer's pixel and the shader's test to a float. Lists and strays come to the same bits as without them.

mod support;

use quincunx::scene::{self, AnimationChoice};
use support::watched::{Changes, Watched, both};

const DEEP: &str = "deep_shading";
const SIZE: (&str, &str) = ("size", "161x91");
const STOCHASTIC: (&str, &str) = ("visibility", "stochastic");
/// A sample a pixel, so that the stage has all of them.
const SAMPLES: [(&str, &str); 3] = [SIZE, ("spp", "1"), ("tuples", "16")];

/// The fence's rotor turns by a quarter of a turn.
fn rotor(spec: &str) -> Watched {
    Watched::with_scene(scene::open(spec, 1, &AnimationChoice::All).unwrap().exposed([0.0, 0.1]).unwrap())
}

/// The triangles that samples see.
fn seen(watched: &Watched, changes: Changes<'_>) -> Vec<u32> {
    let stage = "visibility.spids";
    watched.integers(&watched.render_stages(DEEP, &both(&SAMPLES, changes), &[stage]), stage)
}

/// Samples that see another triangle are at most `most` of all, and most samples see one.
#[track_caller]
fn require_agreement(watched: &Watched, changes: Changes<'_>, most: f64) {
    let interleaved = seen(watched, changes);
    let stochastic = seen(watched, &both(changes, &[STOCHASTIC]));
    let other = interleaved.iter().zip(&stochastic).filter(|(a, b)| a != b).count() as f64 / interleaved.len() as f64;
    let hit = stochastic.iter().filter(|id| **id != u32::MAX).count() as f64 / stochastic.len() as f64;
    println!("{changes:?}: {other} see another triangle, {hit} see one");
    assert!(hit > 0.3, "{changes:?}: {hit}");
    assert!(other <= most, "{changes:?}: {other} differ");
}

/// An edge is up to 1/512 of a layer's pixel elsewhere, along x and along y, so that a layer's pixel with an edge through it
/// differs in one of some 300 cases; where a few edges go through each, that is one in a hundred.
const MOST_OTHERS: f64 = 0.01;

#[test]
fn both_see_the_same_samples_sharp_and_under_a_lens() {
    let watched = Watched::open("cornell");
    require_agreement(&watched, &[], MOST_OTHERS);
    require_agreement(&watched, &[("aperture", "0.2")], MOST_OTHERS);
    let watched = Watched::open("hall:triangles=8000");
    require_agreement(&watched, &[], MOST_OTHERS);
    require_agreement(&watched, &[("aperture", "0.3"), ("focus", "6")], MOST_OTHERS);
}

#[test]
fn both_see_the_same_samples_while_things_move_with_holes_and_glass() {
    for spec in ["fence:lights=6", "fence:lights=6,alpha=mask"] {
        let watched = rotor(spec);
        let camera = [("camera", "rotor")];
        require_agreement(&watched, &camera, MOST_OTHERS);
        require_agreement(&watched, &both(&camera, &[("aperture", "0.1"), ("focus", "4")]), MOST_OTHERS);
    }
}

#[test]
fn lists_come_to_the_bits_of_every_sample_by_itself() {
    let blurred = [SIZE, STOCHASTIC, ("spp", "2"), ("tuples", "8")];
    let watched = Watched::open("hall:triangles=8000");
    // The second brings samples in from outside shading space.
    for lens in [
        [("aperture", "0.3"), ("focus", "6"), ("guard-band", "64")],
        [("aperture", "2"), ("focus", "2"), ("guard-band", "0")],
    ] {
        require_one_picture(&watched, &both(&blurred, &lens));
    }
    require_one_picture(&rotor("fence:lights=6"), &both(&blurred, &[("camera", "rotor"), ("accumulate", "2")]));
}

#[track_caller]
fn require_one_picture(watched: &Watched, changes: Changes<'_>) {
    let alone = watched.hash(DEEP, &both(changes, &[("lists", "none")]));
    for road in [&[][..], &[("compaction", "off"), ("zmax", "off")]] {
        let renderer = watched.render(DEEP, &both(changes, road));
        assert_eq!(renderer.picture().unwrap().hash().unwrap(), alone, "{road:?} with {changes:?}");
        assert_eq!(renderer.measured_counters().unwrap()["samples_without_colour"], 0.0, "{road:?} with {changes:?}");
    }
}

/// Polygons grow with blur and triangles do not (section 4.2, table 3); the rasteriser's own tests are nobody's to count.
#[test]
fn tests_grow_with_the_aperture() {
    let watched = Watched::open("cornell");
    let common = both(&[SIZE, ("spp", "4")], &[STOCHASTIC]);
    let counted: Vec<[f64; 2]> = ["0", "0.1", "0.2", "0.4"]
        .iter()
        .map(|aperture| {
            let counters =
                watched.render(DEEP, &both(&common, &[("aperture", *aperture)])).measured_counters().unwrap();
            ["sample_tests", "sample_tests_hit"].map(|key| counters[key])
        })
        .collect();
    println!("tests and hits: {counted:?}");
    // A sharp triangle's polygon is the triangle.
    let [tests, hits] = counted[0];
    assert!(hits > 0.0 && tests < 1.1 * hits, "{counted:?}");
    assert!(counted.windows(2).all(|pair| pair[1][0] > 1.02 * pair[0][0]), "{counted:?}");
    assert!(counted.iter().all(|[_, now]| (now / hits - 1.0).abs() < 0.2), "{counted:?}");
    let interleaved = watched.render(DEEP, &[SIZE, ("spp", "4"), ("aperture", "0.4")]).measured_counters().unwrap();
    assert!(!interleaved.contains_key("sample_tests"), "{interleaved:?}");
}
