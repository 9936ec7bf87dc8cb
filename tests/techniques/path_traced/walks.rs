//! Path tracing through every kind of tree and stack: the same picture, in as much memory as the plan says.

use crate::support::difference::require_same_paths;
use crate::support::shared_scenes;
use crate::support::watched::{Changes, Watched, both};
use quincunx::scene::{self, AlphaMode};

const NAME: &str = "path_traced";

/// Ways through the tree; a short stack with room for one begins at the root again nearly every turn.
const WAYS: [Changes<'_>; 11] = [
    &[("node-width", "2"), ("stack", "private")],
    &[("node-width", "2"), ("stack", "shared")],
    &[("node-width", "2"), ("stack", "short")],
    &[("node-width", "2"), ("stack", "short"), ("stack-entries", "1")],
    &[("node-width", "2"), ("node-layout", "van-emde-boas")],
    &[("node-width", "4"), ("stack", "private")],
    &[("node-width", "4"), ("stack", "shared")],
    &[("node-width", "4"), ("stack", "short")],
    &[("node-width", "4"), ("stack", "short"), ("stack-entries", "1")],
    &[("node-width", "4"), ("node-layout", "breadth-first")],
    &[("node-width", "4"), ("node-layout", "van-emde-boas"), ("workgroup", "8x8")],
];

/// Requires one picture of all ways.
fn require_one_picture(watched: &Watched, changes: Changes<'_>) {
    let expected = watched.picture(NAME, changes);
    for way in WAYS {
        require_same_paths(&watched.session.gpu, &watched.picture(NAME, &both(changes, way)), &expected, &way);
    }
}

/// Rays that MASK and BLEND surfaces stop or let through are decided by triangle and ray, not by when the walk comes there;
/// of two triangles at one distance the first in the tree's order is met.
#[test]
fn every_way_through_the_tree_gives_one_picture() {
    let scene = scene::load("hall:triangles=8000", 1).unwrap();
    let has = |alpha: fn(&AlphaMode) -> bool| scene.drawn_materials().any(|material| alpha(&material.alpha));
    assert!(has(|alpha| matches!(alpha, AlphaMode::Mask { .. })) && has(|alpha| *alpha == AlphaMode::Blend));
    require_one_picture(&Watched::with_scene(scene), &[("size", "64x36"), ("spp", "2")]);
}

#[test]
fn a_map_s_coincident_surfaces_are_one_picture_too() {
    let Some(folder) = shared_scenes() else { return };
    let watched = Watched::open(folder.join("maps/oa_thor.glb").to_str().unwrap());
    require_one_picture(&watched, &[("size", "64x36"), ("spp", "2"), ("rig", "always")]);
}

/// A tree that is a leaf, and one whose triangles are all the same.
#[test]
fn trees_of_no_depth_and_of_no_shape() {
    for count in [2, 3000] {
        let mut scene = scene::load("cornell", 1).unwrap();
        scene.draws.truncate(1);
        scene.meshes[scene.draws[0].mesh].indices = [0, 1, 2, 0, 2, 3].repeat(count / 2);
        scene.hash = format!("{count} triangles");
        require_one_picture(&Watched::with_scene(scene), &[("size", "32x32"), ("spp", "2"), ("rig", "always")]);
    }
}

#[test]
fn nodes_take_as_many_bytes_as_are_planned() {
    let watched = Watched::open("cornell");
    for (width, node_bytes) in [("2", 32), ("4", 112)] {
        let renderer = watched.render(NAME, &[("size", "16x16"), ("spp", "1"), ("node-width", width)]);
        let counters = renderer.measured_counters().unwrap();
        let bytes = node_bytes * counters["tree_nodes"] as u64;
        let planned = renderer.plan.resources.iter().find(|planned| planned.name == "path_traced.bvh.nodes").unwrap();
        let snapshot = watched.session.gpu.memory.snapshot();
        let held = snapshot.resources.iter().find(|entry| entry.name == planned.name).unwrap();
        assert_eq!((planned.bytes(), held.bytes), (bytes, bytes), "{width}");
        assert!(counters["stack_entries"] >= 2.0, "{counters:?}");
    }
}
