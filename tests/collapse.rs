//! Roads that must agree bit for bit: a technique at its degenerate setting, culling on and off, one submit and many.

mod support;

use quincunx::gpu::commands::Submits;
use quincunx::memory::Strategy;
use std::collections::BTreeMap;
use support::watched::{Changes, Watched, both};

const INTERLEAVED: &str = "interleaved_deferred";
const PATTERNS: [&str; 7] = ["1x1", "2x2", "3x2", "4x4", "5x7", "8x6", "8x8"];
/// The second is divided by none of the patterns, and by no SIMD width.
const SIZES: [&str; 2] = ["640x360", "641x359"];

/// Every road of `--split` that must give the picture of `branch`.
const ROADS: [Changes<'_>; 4] =
    [&[("split", "branch")], &[("split", "indirect")], &[("split", "remap")], &[("split", "one-pass")]];

/// The same picture from every road that must give it.
fn require_one_hash(watched: &Watched, technique: &str, common: Changes<'_>, variants: &[Changes<'_>]) -> String {
    let mut hashes = BTreeMap::new();
    for variant in variants {
        let hash = watched.hash(technique, &both(common, variant));
        hashes.entry(hash).or_insert_with(Vec::new).push(*variant);
    }
    assert_eq!(hashes.len(), 1, "{technique} with {common:?}: {hashes:#?}");
    hashes.into_keys().next().unwrap()
}

#[test]
fn every_road_is_branch_for_every_pattern_and_size() {
    let watched = Watched::open("cornell");
    for size in SIZES {
        let mut seen = Vec::new();
        for filter in ["none", "gauss"] {
            for pattern in PATTERNS {
                let common = [("vpls", "64"), ("size", size), ("filter", filter), ("pattern", pattern)];
                seen.push((pattern, require_one_hash(&watched, INTERLEAVED, &common, &ROADS)));
            }
        }
        // Hashes that never differ would prove nothing: only 1x1 is not filtered.
        let distinct: std::collections::BTreeSet<_> = seen.iter().map(|(_, hash)| hash).collect();
        assert_eq!(distinct.len(), 2 * PATTERNS.len() - 1, "{size}: {seen:?}");
    }
}

#[test]
fn the_pattern_of_one_pixel_is_plain_deferred_shading() {
    let watched = Watched::open("cornell");
    let roads: [Changes<'_>; 5] = [
        &[("split", "none")],
        &[("split", "branch"), ("pattern", "1x1")],
        &[("split", "remap"), ("pattern", "1x1")],
        &[("split", "one-pass"), ("pattern", "1x1")],
        &[("split", "one-pass"), ("pattern", "1x1"), ("filter", "none")],
    ];
    for size in SIZES {
        require_one_hash(&watched, INTERLEAVED, &[("vpls", "64"), ("size", size)], &roads);
    }
}

#[test]
fn every_way_of_holding_positions_splits_the_same() {
    let watched = Watched::open("cornell");
    let mut hashes = Vec::new();
    for position in ["half", "unorm16", "depth", "float"] {
        for size in SIZES {
            let common = [("vpls", "64"), ("size", size), ("pattern", "3x2"), ("position", position)];
            hashes.push(require_one_hash(&watched, INTERLEAVED, &common, &ROADS));
        }
    }
    hashes.sort();
    hashes.dedup();
    assert_eq!(hashes.len(), 8, "positions round differently, so their pictures differ");
}

#[test]
fn lights_joined_to_the_subsets_split_the_same() {
    let watched = Watched::open("lamps:objects=10,lights=24");
    for (pattern, shadow) in [("2x2", "none"), ("4x4", "ray"), ("5x7", "none")] {
        let common = [
            ("vpls", "64"),
            ("size", "161x90"),
            ("direct", "interleaved"),
            ("pattern", pattern),
            ("direct-shadow", shadow),
        ];
        require_one_hash(&watched, INTERLEAVED, &common, &ROADS);
    }
    let one: [Changes<'_>; 2] = [&[("split", "none")], &[("pattern", "1x1")]];
    require_one_hash(&watched, INTERLEAVED, &[("vpls", "64"), ("size", "161x90"), ("direct", "interleaved")], &one);
}

#[test]
fn culling_changes_no_pixel() {
    let watched = Watched::open("lamps:objects=40,lights=60");
    let culls: [Changes<'_>; 2] = [&[("cull", "none")], &[("cull", "tiled")]];
    for size in ["320x180", "323x177"] {
        for position in ["half", "unorm16", "depth", "float"] {
            require_one_hash(&watched, "deferred", &[("size", size), ("position", position)], &culls);
        }
        require_one_hash(&watched, "deferred", &[("size", size), ("direct-shadow", "ray")], &culls);
        require_one_hash(&watched, INTERLEAVED, &[("size", size), ("vpls", "32")], &culls);
    }
}

#[test]
fn culling_changes_no_pixel_of_a_map() {
    let Some(folder) = support::shared_scenes() else { return };
    let watched = Watched::open(folder.join("maps/kaos.glb").to_str().unwrap());
    let culls: [Changes<'_>; 2] = [&[("cull", "none")], &[("cull", "tiled")]];
    let common = [("size", "323x177"), ("vpls", "32"), ("lights", "40")];
    require_one_hash(&watched, INTERLEAVED, &common, &culls);
    require_one_hash(&watched, INTERLEAVED, &common, &ROADS);
}

#[test]
fn the_same_request_gives_the_same_bytes() {
    let size = ("size", "321x181");
    for (technique, scene, changes) in
        [(INTERLEAVED, "cornell", &[size, ("vpls", "64")][..]), ("deferred", "lamps:objects=20,lights=20", &[size])]
    {
        let watched = Watched::open(scene);
        let renderer = watched.render(technique, changes);
        let first = renderer.picture().unwrap().hash().unwrap();
        renderer.frame().unwrap();
        assert_eq!(renderer.picture().unwrap().hash().unwrap(), first, "{technique}: the second frame");
        let again = Watched::open(scene).hash(technique, changes);
        assert_eq!(again, first, "{technique}: another session");
    }
}

#[test]
fn where_resources_lie_changes_no_pixel() {
    let changes = [("size", "321x181"), ("vpls", "64")];
    let [linear, dedicated] = [Strategy::Linear, Strategy::Dedicated]
        .map(|strategy| Watched::with_strategy(strategy, "cornell").hash(INTERLEAVED, &changes));
    assert_eq!(linear, dedicated);
}

#[test]
fn shared_bytes_change_no_pixel() {
    let watched = Watched::open("lamps:objects=10,lights=24");
    let modes: [Changes<'_>; 3] = [&[("alias", "off")], &[("alias", "greedy")], &[("alias", "optimal")]];
    require_one_hash(&watched, "deferred", &[("size", "161x91"), ("cull", "tiled")], &modes);
    for road in ROADS {
        for filter in ["none", "gauss", "gauss-fast"] {
            let common = [("size", "161x91"), ("vpls", "64"), ("pattern", "3x2"), ("filter", filter)];
            require_one_hash(&watched, INTERLEAVED, &both(&common, road), &modes);
        }
    }
}

#[test]
fn more_texels_a_thread_change_no_pixel() {
    let watched = Watched::open("lamps:objects=10,lights=24");
    let counts: Vec<_> = ["auto", "1", "2", "4", "8", "16"].map(|count| [("texels", count)]).into();
    let counts: Vec<Changes<'_>> = counts.iter().map(|count| &count[..]).collect();
    let interleaved = [("size", "161x91"), ("vpls", "64"), ("pattern", "5x7"), ("kernel", "7")];
    for own in
        [&[][..], &[("split", "none")], &[("split", "subsample")], &[("split", "remap"), ("direct", "interleaved")]]
    {
        require_one_hash(&watched, INTERLEAVED, &both(&interleaved, own), &counts);
    }
    for own in [&[][..], &[("cull", "tiled")], &[("direct-shadow", "ray")]] {
        require_one_hash(&watched, "deferred", &both(&[("size", "161x91")], own), &counts);
    }
}

#[test]
fn the_shape_of_workgroups_changes_no_pixel() {
    let watched = Watched::open("cornell");
    let shapes = ["64x1", "8x8", "1x1", "16x4", "1x64", "7x3", "128x1"].map(|shape| [("workgroup", shape)]);
    let shapes: Vec<Changes<'_>> = shapes.iter().map(|shape| &shape[..]).collect();
    for filter in ["gauss", "gauss-fast"] {
        let common = [("size", "161x91"), ("vpls", "64"), ("pattern", "3x2"), ("filter", filter)];
        require_one_hash(&watched, INTERLEAVED, &common, &shapes);
    }
    require_one_hash(&watched, "deferred", &[("size", "161x91")], &shapes);
}

#[test]
fn a_submit_for_each_pass_changes_no_pixel() {
    let watched = Watched::open("cornell");
    for changes in [&[("size", "161x91"), ("vpls", "64")][..], &[("size", "161x91"), ("split", "none")]] {
        let together = watched.hash(INTERLEAVED, changes);
        let apart = watched.render_as(INTERLEAVED, changes, &[], Submits::PerPass);
        assert_eq!(apart.picture().unwrap().hash().unwrap(), together, "{changes:?}");
    }
}
