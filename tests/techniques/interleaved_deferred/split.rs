//! Split then gather is the identity on the device, seen in the stages that a frame leaves (Segovia 2006, figure 3).

use super::{copies, splits_in_blocks};
use crate::support::choices::{is_possible, words};
use crate::support::difference::require_same;
use crate::support::watched::{Changes, Watched, both};
use quincunx::gpu::commands::Submits;
use quincunx::techniques::interleaved_deferred::mapping::mapping;
use quincunx::units::Extent;

const TECHNIQUE: &str = "interleaved_deferred";
/// What these tests read back.
const STAGES: &[&str] = &["gbuffer.normal", "split.normal", "shade.irradiance", "gather.irradiance"];

/// A picture of sub-buffers side by side, back in frame order: each place says which pixel it shows.
pub fn back_in_frame_order(side_by_side: &[[f32; 3]], extent: Extent, pattern: [u32; 2]) -> Vec<[f32; 3]> {
    let mut pixels = vec![[f32::NAN; 3]; extent.pixel_count() as usize];
    for (shown, [x, y]) in side_by_side.iter().zip(mapping(extent, pattern, pattern).side_by_side()) {
        pixels[(y * extent.width + x) as usize] = *shown;
    }
    pixels
}

/// Splits, gathers and compares; `changes` beside size and pattern.
fn require_identity(watched: &Watched, extent: Extent, pattern: [u32; 2], changes: Changes<'_>) {
    let (size, text) = (extent.to_string(), format!("{}x{}", pattern[0], pattern[1]));
    let common = [("size", size.as_str()), ("pattern", text.as_str()), ("vpls", "256")];
    let renderer = watched.render_stages(TECHNIQUE, &both(&common, changes), STAGES);
    let stage = |name: &str| watched.rgb(&renderer, name);
    let what = format!("{extent} in {text} with {changes:?}");
    assert_eq!(back_in_frame_order(&stage("split.normal"), extent, pattern), stage("gbuffer.normal"), "{what}");
    let gathered = stage("gather.irradiance");
    assert_eq!(back_in_frame_order(&stage("shade.irradiance"), extent, pattern), gathered, "{what}");
    assert!(gathered.iter().any(|irradiance| irradiance[0] > 0.0), "{what}: it is dark");
}

#[test]
fn every_sub_buffer_comes_back_where_it_was() {
    let watched = Watched::open("cornell");
    for (extent, pattern) in [
        (Extent::new(160, 90), [1, 1]),
        (Extent::new(160, 90), [4, 4]),
        (Extent::new(161, 91), [4, 4]),
        (Extent::new(161, 91), [5, 7]),
        (Extent::new(97, 53), [8, 6]),
        (Extent::new(63, 64), [2, 1]),
        (Extent::new(63, 41), [1, 3]),
        // A pattern larger than the frame: most sub-buffers hold nothing but padding.
        (Extent::new(9, 7), [16, 16]),
        (Extent::new(1, 1), [2, 2]),
    ] {
        require_identity(&watched, extent, pattern, &[]);
    }
}

#[test]
fn every_copy_brings_every_sub_buffer_back() {
    let watched = Watched::open("cornell");
    let copies = copies();
    for (extent, pattern) in [
        (Extent::new(160, 90), [1, 1]),
        (Extent::new(161, 91), [5, 7]),
        (Extent::new(97, 53), [8, 6]),
        (Extent::new(63, 41), [1, 3]),
        (Extent::new(9, 7), [16, 16]),
        (Extent::new(1, 1), [2, 2]),
    ] {
        for copies in &copies {
            require_identity(&watched, extent, pattern, copies);
        }
    }
}

#[test]
fn every_block_brings_every_sub_buffer_back() {
    let watched = Watched::open("cornell");
    let copies = splits_in_blocks();
    for (extent, pattern) in [(Extent::new(97, 53), [3, 2]), (Extent::new(65, 40), [4, 4])] {
        // Smaller than the pattern, odd sub-blocks, flat, tall, larger than the frame where that is possible.
        for block in ["1", "9x3", "48x2", "5x33", "300"] {
            // A tile as large does not fit into workgroup memory, and is refused.
            for copies in copies.iter().filter(|copies| copies[0].1 != "tile" || block != "300") {
                require_identity(&watched, extent, pattern, &both(copies, &[("block", block)]));
            }
        }
    }
}

#[test]
fn both_methods_shade_the_same_irradiance() {
    let watched = Watched::open("cornell");
    let common = [("size", "97x53"), ("pattern", "5x7"), ("vpls", "128")];
    let gathered = watched.rgb(&watched.render_stages(TECHNIQUE, &common, STAGES), "gather.irradiance");
    let branch = watched.render_stages(TECHNIQUE, &both(&common, &[("split", "branch")]), &["shade.irradiance"]);
    assert_eq!(watched.rgb(&branch, "shade.irradiance"), gathered);
}

#[test]
fn a_stage_that_the_settings_leave_out_is_refused() {
    let watched = Watched::open("cornell");
    let common = [("size", "33x17"), ("vpls", "64"), ("vpl-shadow", "ray"), ("sub-buffer-color", "on")];
    let stages = quincunx::techniques::find(TECHNIQUE).unwrap().aovs();
    let filtered = ["discontinuity.flags", "filter.irradiance"];
    let split = ["split.normal", "split.color", "gather.irradiance"];
    let upscaled = ["upscale.irradiance"];
    // What copies reads --storage.
    let copies = |word| is_possible(TECHNIQUE, &[("split", word), ("storage", "image")]);
    let left_out_by = |word| match word {
        "none" => [&split[..], &filtered, &upscaled].concat(),
        "subsample" => [&split[..], &filtered].concat(),
        _ if copies(word) => upscaled.to_vec(),
        _ => [&split[..], &upscaled].concat(),
    };
    let by_split = words(TECHNIQUE, "split").into_iter().map(|word| (("split", word), left_out_by(word)));
    let by_others = [
        (("filter", "none"), [&filtered[..], &upscaled].concat()),
        (("pattern", "1x1"), [&filtered[..], &upscaled].concat()),
        (("pattern", "2x2"), upscaled.to_vec()),
        (("sub-buffer-color", "off"), [&upscaled[..], &["split.color"]].concat()),
        (("vpl-shadow", "none"), [&upscaled[..], &["vpl_shadow.hidden"]].concat()),
    ];
    for (change, missing) in by_split.chain(by_others) {
        let changes = both(&common, &[change]);
        let (without, with): (Vec<&str>, Vec<&str>) = stages.iter().partition(|name| missing.contains(name));
        let renderer = watched.render_stages(TECHNIQUE, &changes, &with);
        for name in with {
            renderer.aov(name).unwrap_or_else(|error| panic!("{change:?}: {error}"));
        }
        for name in without {
            // Before a frame, and before pipelines are made.
            let refused = watched.try_renderer(TECHNIQUE, &changes, &[name], Submits::One);
            let error = refused.map(|_| ()).expect_err(&format!("{change:?} made {name}"));
            assert_eq!(error.exit_code(), 2);
            assert!(error.message().contains(&format!("--aov {name}")), "{error}");
            // What is named as the reason is what was set, or the split that interpolates nothing.
            let (key, text) =
                if upscaled.contains(&name) && change.0 != "split" { ("split", "one-pass") } else { change };
            assert!(error.message().contains(&format!("--{key} {text}")), "{error}");
        }
    }
}

#[test]
fn fewer_lights_than_subsets_are_refused() {
    let watched = Watched::open("cornell");
    let refused = watched.try_renderer(TECHNIQUE, &[("vpls", "15"), ("size", "8x8")], &[], Submits::One).err().unwrap();
    assert_eq!(refused.exit_code(), 2);
    assert!(refused.message().contains("15 lights for the 16 subsets"), "{refused}");
    let renderer = watched.render(TECHNIQUE, &[("vpls", "16"), ("size", "8x8")]);
    assert!(renderer.picture().unwrap().mean()[0] > 0.0);
}

/// A cluster without a punctual light is none where its subsets have virtual ones.
#[test]
fn clusters_need_no_light_of_their_own_where_their_subsets_have_virtual_ones() {
    let watched = Watched::open("lamps:objects=10,lights=2");
    let joined = [("size", "8x8"), ("direct", "interleaved"), ("pattern", "4x4")];
    let with = |vpls, direct_pattern| both(&joined, &[("vpls", vpls), ("direct-pattern", direct_pattern)]);
    let lights = watched.render(TECHNIQUE, &with("16", "2x2")).counters["lights"];
    assert!(lights > 0.0 && lights < 4.0, "{lights} lights leave none of four clusters empty");
    // The first of its cluster's places that has no virtual light is the ninth.
    let text = refused(&watched, &with("8", "2x2"));
    for words in ["for the 16 subsets of --pattern 4x4", "--vpls 16 or more", "smaller --pattern or --direct-pattern"] {
        assert!(text.contains(words), "{text}");
    }
    // Every subset has all of them.
    watched.render(TECHNIQUE, &with("1", "1x1"));
    for (direct_pattern, axis) in [("3x2", "--direct-pattern 3x2"), ("2x3", "--direct-pattern 2x3"), ("8x4", "8x4")] {
        let text = refused(&watched, &with("16", direct_pattern));
        for words in [axis, "with --pattern 4x4", "I of 1, 2, 4 and J of 1, 2, 4", "auto is 4x4"] {
            assert!(text.contains(words), "{text}");
        }
    }
}

/// The message of a request that is refused as a bad one.
fn refused(watched: &Watched, changes: Changes<'_>) -> String {
    let error = watched.try_renderer(TECHNIQUE, changes, &[], Submits::One).err();
    let error = error.unwrap_or_else(|| panic!("{changes:?} was taken"));
    assert_eq!(error.exit_code(), 2, "{changes:?}: {error}");
    error.to_string()
}

#[test]
fn contradictions_are_refused_with_what_would_work() {
    let watched = Watched::open("cornell");
    let size = ("size", "33x17");
    for (changes, words) in [
        (
            &[size, ("split", "fragment"), ("storage", "buffer")][..],
            &["--split fragment with --storage buffer", "draw into images", "--storage image or auto"][..],
        ),
        (&[size, ("split", "layered"), ("storage", "buffer")], &["--split layered with --storage buffer", "layers"]),
        (&[size, ("split", "tile"), ("copy", "push")], &["--split tile with --copy push", "--copy pull"]),
        (&[size, ("split", "fragment"), ("copy", "push")], &["--split fragment with --copy push", "--copy pull"]),
        (
            &[size, ("split", "stencil"), ("pattern", "32x16"), ("vpls", "512")],
            &["512 subsets of --pattern 32x16", "256", "--split depth"],
        ),
    ] {
        let text = refused(&watched, changes);
        for word in words {
            assert!(text.contains(word), "{changes:?} does not say {word}: {text}");
        }
    }
    // What is not read does not contradict.
    watched.render(TECHNIQUE, &[size, ("split", "branch"), ("storage", "buffer"), ("copy", "push"), ("block", "1024")]);
    // As many subsets as the stencil can distinguish, and more by depth.
    let stencil = [size, ("pattern", "16x16"), ("vpls", "256")];
    let [stencil, branch] =
        ["stencil", "branch"].map(|method| watched.picture(TECHNIQUE, &both(&stencil, &[("split", method)])));
    require_same(&watched.session.gpu, &stencil, &branch, &"stencil");
    let depth = [("size", "65x64"), ("pattern", "64x64"), ("vpls", "4096")];
    let [depth, branch] =
        ["depth", "branch"].map(|method| watched.picture(TECHNIQUE, &both(&depth, &[("split", method)])));
    require_same(&watched.session.gpu, &depth, &branch, &"depth");
}

#[test]
fn what_the_device_cannot_hold_is_refused_with_the_numbers() {
    let watched = Watched::open("cornell");
    let limits = &watched.session.gpu.caps.limits;
    let shared = limits.max_shared_memory_bytes;
    // Position and normal take 16 B a texel.
    let side = ((shared / 16) as f64).sqrt() as u32 / 4 * 4;
    let fits = format!("{side}");
    watched.render(TECHNIQUE, &[("size", "33x17"), ("split", "tile"), ("block", &fits)]);
    if side < 1020 {
        let block = format!("{}", side + 4);
        let text = refused(&watched, &[("size", "33x17"), ("split", "tile"), ("block", &block)]);
        for word in [format!("blocks of {block}x{block}"), "workgroup memory".to_owned(), "--block".to_owned()] {
            assert!(text.contains(&word), "{text}");
        }
    }
    if limits.max_image_layers < 4096 {
        let text =
            refused(&watched, &[("size", "33x17"), ("split", "layered"), ("pattern", "64x64"), ("vpls", "4096")]);
        assert!(text.contains(&format!("allows {} layers", limits.max_image_layers)), "{text}");
    }
    if limits.max_image_side_px <= 16384 {
        let wide = [("size", "16384x2"), ("vpls", "961"), ("pattern", "31x31"), ("storage", "image")];
        let text = refused(&watched, &wide);
        assert!(text.contains(&format!("allows {} a side", limits.max_image_side_px)), "{text}");
    }
}
