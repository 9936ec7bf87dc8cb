//! Methods that must agree, bit for bit on software drivers: a technique at its degenerate setting, culling on and off,
//! one submit and many.

use super::interleaved_deferred::{copies, splits, splits_in_blocks};
use crate::support;
use crate::support::choices::{Way, changes, ways, words, words_but};
use crate::support::difference::require_same;
use crate::support::watched::{Changes, Watched, both};
use quincunx::gpu::commands::Submits;
use quincunx::memory::Strategy;
use std::collections::BTreeMap;

const INTERLEAVED: &str = "interleaved_deferred";

/// The same picture from every method that must give it, whose shaders differ; returns the first one's hash.
#[track_caller]
fn require_one_picture(watched: &Watched, technique: &str, common: Changes<'_>, variants: &[Changes<'_>]) -> String {
    let first = watched.picture(technique, &both(common, variants[0]));
    for variant in &variants[1..] {
        let found = watched.picture(technique, &both(common, variant));
        require_same(&watched.session.gpu, &found, &first, &(technique, common, variant));
    }
    first.hash().unwrap()
}

/// The same bits from everything that leaves the shaders as they are.
#[track_caller]
fn require_one_hash(watched: &Watched, technique: &str, common: Changes<'_>, variants: &[Changes<'_>]) -> String {
    let mut hashes = BTreeMap::new();
    for variant in variants {
        let hash = watched.hash(technique, &both(common, variant));
        hashes.entry(hash).or_insert_with(Vec::new).push(*variant);
    }
    assert_eq!(hashes.len(), 1, "{technique} with {common:?}: {hashes:#?}");
    hashes.into_keys().next().unwrap()
}

fn require_every_method_is_branch(size: &str, patterns: &[&str]) {
    let watched = Watched::open("cornell");
    let splits = splits();
    let mut seen = Vec::new();
    for pattern in patterns {
        let common = [("vpls", "64"), ("size", size), ("filter", "none"), ("pattern", pattern)];
        seen.push(require_one_picture(&watched, INTERLEAVED, &common, &changes(&splits)));
    }
    // Plain deferred shading of the same lights is the pattern of one pixel.
    let plain: [Changes<'_>; 2] =
        [&[("split", "none")], &[("split", "branch"), ("filter", "none"), ("pattern", "1x1")]];
    assert_eq!(require_one_picture(&watched, INTERLEAVED, &[("vpls", "64"), ("size", size)], &plain[..]), seen[0]);
    // Hashes that never differ would prove nothing.
    let distinct: std::collections::BTreeSet<_> = seen.iter().collect();
    assert_eq!(distinct.len(), patterns.len(), "{size}: {seen:?}");
}

#[test]
fn every_method_is_branch_for_every_pattern() {
    require_every_method_is_branch("192x108", &["1x1", "2x2", "3x2", "4x4", "5x7", "8x6", "8x8"]);
}

/// The frame is divided by none of the patterns but the first, and by no SIMD width.
#[test]
fn every_method_is_branch_for_every_pattern_where_nothing_divides_the_frame() {
    require_every_method_is_branch("191x107", &["1x1", "3x2", "5x7", "8x8"]);
}

#[test]
fn every_method_is_branch_behind_every_filter() {
    let watched = Watched::open("cornell");
    let (splits, filters) = (splits(), words(INTERLEAVED, "filter"));
    let mut hashes = Vec::new();
    for filter in &filters {
        let common = [("vpls", "64"), ("size", "161x91"), ("pattern", "4x4"), ("filter", filter)];
        hashes.push(require_one_picture(&watched, INTERLEAVED, &common, &changes(&splits)));
    }
    hashes.sort();
    hashes.dedup();
    assert_eq!(hashes.len(), filters.len(), "a filter that changes nothing was left out");
}

#[test]
fn passes_fused_change_no_pixel() {
    let watched = Watched::open("cornell");
    let splits = splits();
    for filter in [
        [("size", "161x91"), ("pattern", "4x4"), ("kernel", "5"), ("discontinuity", "directional")],
        [("size", "97x53"), ("pattern", "3x2"), ("kernel", "17"), ("discontinuity", "any")],
    ] {
        for split in &splits {
            let common = both(&both(&[("vpls", "64")], &filter), split);
            require_one_picture(&watched, INTERLEAVED, &common, &[&[("fuse", "off")], &[("fuse", "on")]]);
        }
    }
    // What the composite shades beside walking its columns.
    for lit in [&[("cull", "tiled")][..], &[("direct-shadow", "ray")], &[("texels", "1")], &[("size", "7x5")]] {
        let common = both(&[("vpls", "64"), ("size", "97x53")], lit);
        require_one_picture(&watched, INTERLEAVED, &common, &[&[("fuse", "off")], &[("fuse", "on")]]);
    }
}

#[test]
fn fused_passes_are_fewer() {
    let watched = Watched::open("cornell");
    let names = |changes: Changes<'_>| -> Vec<String> {
        let renderer = watched.render(INTERLEAVED, &both(&[("size", "64x36")], changes));
        renderer.passes().iter().map(|pass| pass.name.replace("interleaved_deferred.", "")).collect()
    };
    let all = ["gbuffer", "split", "shade", "gather", "discontinuity", "filter", "composite"];
    assert_eq!(names(&[]), all);
    assert_eq!(names(&[("fuse", "on")]), ["gbuffer", "split", "discontinuity", "shade", "gather", "composite"]);
    // Rows are filtered by a pass of their own where no single compute shader pulls each pixel.
    assert_eq!(names(&[("fuse", "on"), ("copy", "push")]), all);
    assert_eq!(names(&[("fuse", "on"), ("filter", "none")]), ["gbuffer", "split", "shade", "gather", "composite"]);
}

#[test]
fn shared_bytes_change_no_pixel_with_any_method() {
    let watched = Watched::open("cornell");
    for split in splits() {
        let common = both(&[("vpls", "64"), ("size", "97x53"), ("pattern", "3x2")], &split);
        require_one_hash(&watched, INTERLEAVED, &common, &[&[("alias", "off")], &[("alias", "greedy")]]);
    }
}

#[test]
fn blocks_of_any_shape_change_no_pixel() {
    let watched = Watched::open("cornell");
    let splits = splits_in_blocks();
    for (pattern, size) in [("3x2", "161x91"), ("5x7", "97x64")] {
        let common = [("vpls", "64"), ("size", size), ("pattern", pattern)];
        let branch = watched.picture(INTERLEAVED, &both(&common, &[("split", "branch")]));
        // Rounded to whole patterns; smaller than the pattern; odd sub-blocks; flat, tall, larger than the frame.
        for block in ["1", "7", "40x4", "3x37", "16x16", "200"] {
            for split in &splits {
                let tile = split[0].1 == "tile";
                if tile && block == "200" {
                    // It does not fit into workgroup memory, and is refused.
                    continue;
                }
                let changes = both(&both(&common, split), &[("block", block)]);
                require_same(&watched.session.gpu, &watched.picture(INTERLEAVED, &changes), &branch, &changes);
            }
        }
    }
}

#[test]
fn the_pattern_of_one_pixel_is_plain_deferred_shading() {
    let watched = Watched::open("cornell");
    let mut ways: Vec<Way> = splits().iter().map(|split| both(split, &[("pattern", "1x1")])).collect();
    ways.push(vec![("split", "none")]);
    ways.push(vec![("pattern", "1x1"), ("filter", "none")]);
    for size in ["192x108", "193x109"] {
        require_one_picture(&watched, INTERLEAVED, &[("vpls", "64"), ("size", size)], &changes(&ways));
    }
}

#[test]
fn every_way_of_holding_positions_splits_the_same() {
    let watched = Watched::open("cornell");
    let (splits, positions) = (splits(), words(INTERLEAVED, "position"));
    let mut hashes = Vec::new();
    for position in &positions {
        let common = [("vpls", "64"), ("size", "161x91"), ("pattern", "3x2"), ("position", position)];
        hashes.push(require_one_picture(&watched, INTERLEAVED, &common, &changes(&splits)));
    }
    hashes.sort();
    hashes.dedup();
    assert_eq!(hashes.len(), positions.len(), "positions round differently, so their pictures differ");
}

#[test]
fn lights_joined_to_the_subsets_split_the_same() {
    let watched = Watched::open("lamps:objects=10,lights=24");
    let splits = splits();
    for (pattern, shadow) in [("2x2", "none"), ("4x4", "ray"), ("5x7", "none")] {
        let common = [
            ("vpls", "64"),
            ("size", "161x90"),
            ("direct", "interleaved"),
            ("pattern", pattern),
            ("direct-shadow", shadow),
        ];
        require_one_picture(&watched, INTERLEAVED, &common, &changes(&splits));
    }
    let one: [Changes<'_>; 2] = [&[("split", "none")], &[("pattern", "1x1")]];
    require_one_picture(&watched, INTERLEAVED, &[("vpls", "64"), ("size", "161x90"), ("direct", "interleaved")], &one);
}

/// Clusters of sub-buffers share a subset of the punctual lights, by every method.
#[test]
fn clusters_split_the_same() {
    let watched = Watched::open("lamps:objects=10,lights=24");
    let splits = splits();
    let mut seen = Vec::new();
    for (pattern, direct_patterns) in [("4x4", ["auto", "1x1", "2x2"]), ("8x6", ["8x6", "4x3", "2x3"])] {
        for direct_pattern in direct_patterns {
            let common = [
                ("vpls", "64"),
                ("size", "161x90"),
                ("direct", "interleaved"),
                ("pattern", pattern),
                ("direct-pattern", direct_pattern),
            ];
            seen.push(require_one_picture(&watched, INTERLEAVED, &common, &changes(&splits)));
        }
    }
    let distinct: std::collections::BTreeSet<_> = seen.iter().collect();
    assert_eq!(distinct.len(), seen.len(), "a direct pattern that changes nothing: {seen:?}");
    // One pattern for all lights, said or not.
    let own = [("split", "branch"), ("direct", "interleaved"), ("pattern", "8x6")];
    let common = both(&[("vpls", "64"), ("size", "161x90")], &own);
    let said: [Changes<'_>; 2] = [&[], &[("direct-pattern", "8x6")]];
    assert_eq!(require_one_hash(&watched, INTERLEAVED, &common, &said), seen[3]);
    // What sums every light, or joins none, does not read it: a pattern that does not divide is no contradiction.
    for own in [[("split", "none"), ("direct", "interleaved")], [("split", "subsample"), ("direct", "interleaved")]] {
        let unread: [Changes<'_>; 2] = [&[], &[("direct-pattern", "3x2")]];
        require_one_hash(&watched, INTERLEAVED, &both(&own, &[("vpls", "64"), ("size", "161x90")]), &unread);
    }
    let unread: [Changes<'_>; 3] = [&[], &[("direct-pattern", "1x1")], &[("direct-pattern", "3x2")]];
    require_one_hash(&watched, INTERLEAVED, &[("vpls", "64"), ("size", "161x90"), ("direct", "full")], &unread);
}

#[test]
fn culling_changes_no_pixel() {
    let watched = Watched::open("lamps:objects=40,lights=60");
    let culls = ways("deferred", &["cull", "cull-by"]);
    let culls = changes(&culls);
    for size in ["320x180", "323x177"] {
        for position in words("deferred", "position") {
            require_one_picture(&watched, "deferred", &[("size", size), ("position", position)], &culls);
        }
        require_one_picture(&watched, "deferred", &[("size", size), ("direct-shadow", "ray")], &culls);
        require_one_picture(&watched, INTERLEAVED, &[("size", size), ("vpls", "32")], &culls);
    }
}

/// More lights than a workgroup has threads, tiles at two edges that are cut off, and some without a surface.
#[test]
fn an_invocation_and_a_workgroup_list_the_same_lights() {
    let watched = Watched::open("lamps:objects=40,lights=150");
    for (technique, tiled) in [("deferred", ("cull", "tiled")), ("inferred_lighting", ("volumes", "tiled"))] {
        let counted = words(technique, "cull-by").into_iter().map(|by| {
            let changes = [tiled, ("cull-by", by), ("size", "323x177"), ("light-cutoff", "0.1")];
            let renderer = watched.render(technique, &changes);
            assert_eq!(renderer.resolved["cull-by"], by);
            let counters = renderer.measured_counters().unwrap();
            ["light_evaluations", "light_evaluations_culled"].map(|name| counters[name])
        });
        let counted: Vec<[f64; 2]> = counted.collect();
        assert!(counted.iter().all(|counts| counts == &counted[0]), "{technique}: {counted:?}");
        assert!(counted[0].into_iter().all(|count| count > 0.0), "{technique}: {counted:?}");
    }
}

#[test]
fn culling_changes_no_pixel_of_a_map() {
    let Some(folder) = support::shared_scenes() else { return };
    let watched = Watched::open(folder.join("maps/kaos.glb").to_str().unwrap());
    let culls: [Changes<'_>; 2] = [&[("cull", "none")], &[("cull", "tiled")]];
    let common = [("size", "323x177"), ("vpls", "32"), ("lights", "40")];
    require_one_picture(&watched, INTERLEAVED, &common, &culls);
    // The last way of each split, and the default.
    let splits = splits();
    let mut last: Vec<Changes<'_>> =
        splits.chunk_by(|one, next| one[0] == next[0]).filter_map(|ways| ways.last()).map(Vec::as_slice).collect();
    last.push(&[]);
    require_one_picture(&watched, INTERLEAVED, &common, &last);
}

/// The depth buffer holds positions: lists of lights, the split and the filter sample it, and BLEND surfaces test it
/// last.
#[test]
fn every_method_is_branch_under_blended_surfaces() {
    let watched = Watched::open("hall:triangles=8000");
    let common = [("size", "161x91"), ("vpls", "32"), ("position", "depth"), ("cull", "tiled")];
    require_one_picture(&watched, INTERLEAVED, &common, &changes(&splits()));
    let renderer = watched.render(INTERLEAVED, &common);
    assert!(renderer.counters["blended_draws"] > 0.0);
}

#[test]
fn every_method_is_branch_where_rays_stop_virtual_lights() {
    let watched = Watched::open("hall:triangles=8000");
    let common = [("size", "97x55"), ("vpls", "32"), ("position", "float"), ("filter", "none")];
    let splits = splits();
    let free = require_one_picture(&watched, INTERLEAVED, &common, &changes(&splits[..1]));
    let shadowed = both(&common, &[("vpl-shadow", "ray")]);
    assert_ne!(require_one_picture(&watched, INTERLEAVED, &shadowed, &changes(&splits)), free);
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
    let modes = ways("deferred", &["alias"]);
    let modes = changes(&modes);
    require_one_hash(&watched, "deferred", &[("size", "161x91"), ("cull", "tiled")], &modes);
    for split in splits() {
        for filter in words(INTERLEAVED, "filter") {
            let common = [("size", "97x53"), ("vpls", "64"), ("pattern", "3x2"), ("filter", filter)];
            require_one_hash(&watched, INTERLEAVED, &both(&common, &split), &modes);
        }
    }
}

#[test]
fn more_texels_a_thread_change_no_pixel() {
    let watched = Watched::open("lamps:objects=10,lights=24");
    let counts = [vec![Way::new()], ways("deferred", &["texels"])].concat();
    let counts = changes(&counts);
    let interleaved = [("size", "161x91"), ("vpls", "64"), ("pattern", "5x7"), ("kernel", "7")];
    for own in
        [&[][..], &[("split", "none")], &[("split", "subsample")], &[("split", "remap"), ("direct", "interleaved")]]
    {
        require_one_picture(&watched, INTERLEAVED, &both(&interleaved, own), &counts);
    }
    for own in [&[][..], &[("cull", "tiled")], &[("direct-shadow", "ray")]] {
        require_one_picture(&watched, "deferred", &both(&[("size", "161x91")], own), &counts);
    }
}

#[test]
fn the_shape_of_workgroups_changes_no_pixel() {
    let watched = Watched::open("cornell");
    let shapes = ["64x1", "8x8", "1x1", "16x4", "1x64", "7x3", "128x1"].map(|shape| [("workgroup", shape)]);
    let shapes: Vec<Changes<'_>> = shapes.iter().map(|shape| &shape[..]).collect();
    for filter in words_but(INTERLEAVED, "filter", &["none"]) {
        let common = [("size", "161x91"), ("vpls", "64"), ("pattern", "3x2"), ("filter", filter)];
        require_one_hash(&watched, INTERLEAVED, &common, &shapes);
    }
    // Odd shapes where a thread carries two texels, one, or a part of a block.
    for split in copies() {
        let common = both(&[("size", "97x53"), ("vpls", "64"), ("pattern", "3x2")], &split);
        require_one_hash(&watched, INTERLEAVED, &common, &[shapes[0], shapes[4], shapes[5]]);
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
    let common = [("size", "97x53"), ("vpls", "64")];
    let together = watched.hash(INTERLEAVED, &common);
    for split in splits() {
        let apart = watched.render_as(INTERLEAVED, &both(&common, &split), &[], Submits::PerPass);
        assert_eq!(apart.picture().unwrap().hash().unwrap(), together, "{split:?}");
    }
}
