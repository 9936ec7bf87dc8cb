//! Split then gather is the identity on the device, seen in the stages that a frame leaves (Segovia 2006, figure 3).

mod support;

use quincunx::gpu::commands::Submits;
use quincunx::techniques::interleaved_deferred::mapping::mapping;
use quincunx::units::Extent;
use support::watched::Watched;

const TECHNIQUE: &str = "interleaved_deferred";
/// What these tests read back.
const STAGES: &[&str] = &["gbuffer.normal", "split.normal", "shade.irradiance", "gather.irradiance"];

/// A picture of sub-buffers side by side, back in frame order: each place says which pixel it shows.
fn back_in_frame_order(side_by_side: &[[f32; 3]], extent: Extent, pattern: [u32; 2]) -> Vec<[f32; 3]> {
    let mut pixels = vec![[f32::NAN; 3]; extent.pixel_count() as usize];
    for (shown, [x, y]) in side_by_side.iter().zip(mapping(extent, pattern, pattern).side_by_side()) {
        pixels[(y * extent.width + x) as usize] = *shown;
    }
    pixels
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
        let (size, text) = (extent.to_string(), format!("{}x{}", pattern[0], pattern[1]));
        let changes = [("size", size.as_str()), ("pattern", text.as_str()), ("vpls", "256")];
        let renderer = watched.render_stages(TECHNIQUE, &changes, STAGES);
        let stage = |name: &str| watched.rgb(&renderer, name);
        let what = format!("{extent} in {text}");
        assert_eq!(back_in_frame_order(&stage("split.normal"), extent, pattern), stage("gbuffer.normal"), "{what}");
        let gathered = stage("gather.irradiance");
        assert_eq!(back_in_frame_order(&stage("shade.irradiance"), extent, pattern), gathered, "{what}");
        assert!(gathered.iter().any(|irradiance| irradiance[0] > 0.0), "{what}: it is dark");
    }
}

#[test]
fn both_roads_shade_the_same_irradiance() {
    let watched = Watched::open("cornell");
    let common = [("size", "97x53"), ("pattern", "5x7"), ("vpls", "128")];
    let gathered = watched.rgb(&watched.render_stages(TECHNIQUE, &common, STAGES), "gather.irradiance");
    let branch = watched.render_stages(TECHNIQUE, &support::watched::both(&common, &[("split", "branch")]), STAGES);
    assert_eq!(watched.rgb(&branch, "shade.irradiance"), gathered);
}

#[test]
fn a_stage_that_the_settings_leave_out_is_refused() {
    let watched = Watched::open("cornell");
    let common = [("size", "33x17"), ("vpls", "64")];
    let stages = quincunx::techniques::find(TECHNIQUE).unwrap().aovs();
    let filtered = ["discontinuity.flags", "filter.irradiance"];
    let split = ["split.normal", "gather.irradiance"];
    for (change, missing) in [
        (("split", "none"), [split, filtered].concat()),
        (("split", "subsample"), [split, filtered].concat()),
        (("split", "branch"), split.to_vec()),
        (("split", "indirect"), split.to_vec()),
        (("split", "remap"), split.to_vec()),
        (("filter", "none"), filtered.to_vec()),
        (("pattern", "1x1"), filtered.to_vec()),
        (("pattern", "2x2"), vec![]),
    ] {
        let changes = support::watched::both(&common, &[change]);
        let renderer = watched.render_stages(TECHNIQUE, &changes, stages);
        for name in stages {
            match renderer.aov(name) {
                Ok(_) => assert!(!missing.contains(name), "{change:?} made {name}"),
                Err(error) => {
                    assert!(missing.contains(name), "{change:?}: {error}");
                    assert_eq!(error.exit_code(), 2);
                    assert!(error.message().contains(&format!("--aov {name}")), "{error}");
                }
            }
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
