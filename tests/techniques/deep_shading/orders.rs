//! Every order of draws, and every way to come by vertices, sees the same samples, and lists them alike.

use super::turning;
use crate::support::difference::require_same;
use crate::support::watched::{Changes, Watched, both};
use crate::support::{Feature, has};
use quincunx::picture::Picture;
use std::collections::BTreeMap;

const DEEP: &str = "deep_shading";
const SIZE: (&str, &str) = ("size", "161x91");
const FETCHED: (&str, &str) = ("vertices", "fetched");

/// Ways to draw the samples on this driver, by the stage that says the layer: vertex shaders, and geometry shaders.
fn orders(watched: &Watched) -> [Vec<Changes<'static>>; 2] {
    let caps = &watched.session.gpu.caps;
    let mut orders = [vec![&[FETCHED][..]], vec![]];
    if caps.features.layer_from_vertex_shader {
        orders[0].extend([
            &[("visibility", "repeat-draw"), ("layer-from", "vertex")][..],
            &[("visibility", "instancing"), ("layer-from", "vertex")],
            &[("visibility", "instancing"), ("layer-from", "vertex"), FETCHED],
        ]);
    }
    if has(caps, Feature::GeometryShader) {
        orders[1].extend([
            &[("visibility", "repeat-draw"), ("layer-from", "geometry")][..],
            &[("visibility", "instancing"), ("layer-from", "geometry")],
            &[("visibility", "instancing"), ("layer-from", "geometry"), FETCHED],
            &[("visibility", "replicate")],
        ]);
    }
    orders
}

/// A picture, the lists' lengths, and what was counted.
type Seen = (Picture, Vec<u32>, BTreeMap<&'static str, f64>);

fn seen(watched: &Watched, changes: Changes<'_>) -> Seen {
    let renderer = watched.render_stages(DEEP, changes, &["count.lengths"]);
    let lengths = watched.integers(&renderer, "count.lengths");
    let mut counters = renderer.measured_counters().unwrap();
    // Who is the quicker of two threads writes one node less, and which entries lie beside each other goes by that too.
    for chance in ["nodes_written", "light_evaluations", "light_evaluations_culled"] {
        counters.remove(chance);
    }
    (renderer.picture().unwrap(), lengths, counters)
}

/// Without the lengths in the message: there are tens of thousands.
#[track_caller]
fn require_same_lists(watched: &Watched, one: &Seen, other: &Seen, changes: Changes<'_>) {
    require_same(&watched.session.gpu, &one.0, &other.0, &changes);
    assert_eq!(one.2, other.2, "{changes:?}");
    assert!(one.1 == other.1, "lengths of lists, {changes:?}");
}

/// The same bits where vertex shaders place triangles. After geometry shaders lavapipe was seen to differ in one pixel of a
/// picture: there all orders are one among themselves and with every sample shaded by itself, and one sample in ten
/// thousand may be another than by repeated frames.
#[track_caller]
fn require_one_order(watched: &Watched, common: Changes<'_>) {
    let frame = seen(watched, common);
    let [vertex, geometry] = orders(watched);
    for order in vertex {
        require_same_lists(watched, &seen(watched, &both(common, order)), &frame, &both(common, order));
    }
    let Some(first) = geometry.first().map(|order| seen(watched, &both(common, order))) else { return };
    for order in &geometry[1..] {
        require_same_lists(watched, &seen(watched, &both(common, order)), &first, &both(common, order));
    }
    for order in geometry {
        let alone = both(&both(common, order), &[("lists", "none")]);
        require_same(&watched.session.gpu, &watched.picture(DEEP, &alone), &first.0, &(order, "without lists", common));
    }
    let others = first.1.iter().zip(&frame.1).filter(|(one, other)| one != other).count();
    println!("{others} of {} lists are longer or shorter, {common:?}", frame.1.len());
    assert!(others as f64 <= 1e-4 * frame.2["samples_seen"], "{others} lists with {common:?}");
    assert!((first.2["samples_seen"] - frame.2["samples_seen"]).abs() <= 1e-4 * frame.2["samples_seen"]);
    assert_eq!(first.2["samples_without_colour"], 0.0);
}

/// Sizes that the table of tuples does not divide, and one that it does; tuples that one geometry shader can take, and not.
#[test]
fn tuples_see_the_same_in_every_order_of_draws() {
    let watched = Watched::open("cornell");
    require_one_order(&watched, &[SIZE, ("spp", "2"), ("tuples", "12")]);
    require_one_order(&watched, &[("size", "64x32"), ("spp", "8"), ("aperture", "0.15")]);
    require_one_order(&watched, &[("size", "33x17"), ("spp", "1"), ("tuples", "1")]);
}

#[test]
fn tuples_see_the_same_in_every_order_under_a_lens() {
    let watched = Watched::open("hall:triangles=8000");
    require_one_order(&watched, &[SIZE, ("spp", "4"), ("aperture", "3"), ("focus", "2"), ("guard-band", "0")]);
}

#[test]
fn tuples_see_the_same_in_every_order_while_things_move_with_holes_and_glass() {
    for spec in ["fence:lights=6", "fence:lights=6,alpha=mask"] {
        let watched = Watched::with_scene(turning(spec));
        require_one_order(&watched, &[SIZE, ("camera", "rotor"), ("spp", "4"), ("accumulate", "2")]);
    }
}
