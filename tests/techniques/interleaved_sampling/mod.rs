//! Interleaved sampling: pixels are the means of what their pattern's samples see, its ends are forward shading and
//! accumulation, and it converges to paths, through a lens too (Keller and Heidrich 2001).

use crate::support::boxes::{panel, rectangle};
use crate::support::difference::{require_same, rmse};
use crate::support::program::Program;
use crate::support::watched::{Watched, both};
use glam::{Mat4, Vec3};
use quincunx::caps::Ability;
use quincunx::choice::Choice;
use quincunx::sampling::sampler::Sampler;
use quincunx::scene::{Camera, Projection, Scene};
use quincunx::techniques::patterns;
use quincunx::units::Extent;
use std::time::{Duration, Instant};

mod aliasing;
mod drawings;
mod effects;
mod volume;

const NAME: &str = "interleaved_sampling";

/// One sample in the middle of every pixel is what forward shading draws: to the bit, with textures, holes, glass and lists
/// of lights too.
#[test]
fn one_sample_is_forward_shading() {
    for (scene, changes) in [
        ("cornell", &[("direct-shadow", "ray")][..]),
        ("lamps:objects=40,lights=60", &[("direct-shadow", "map")]),
        ("fence", &[]),
    ] {
        let watched = Watched::open(scene);
        let changes = both(changes, &[("size", "161x91")]);
        let own = both(&changes, &[("basis", "1x1"), ("samples", "1")]);
        require_same(&watched.session.gpu, &watched.picture(NAME, &own), &watched.picture("forward", &changes), &scene);
    }
}

/// A shining rectangle over a part of a frame of `extent`, one pixel a metre, its upper left corner at (0, 0) and what is
/// inside `[left, top, right, bottom]`, px.
fn card(extent: Extent, [left, top, right, bottom]: [f32; 4]) -> Scene {
    let name = format!("card {left},{top},{right},{bottom}");
    let mut scene = Scene { name: name.clone(), hash: name, ..Scene::default() };
    let center = Vec3::new((left + right) / 2.0, -(top + bottom) / 2.0, 0.0);
    let (u, v) = ((right - left) / 2.0 * Vec3::X, (bottom - top) / 2.0 * Vec3::Y);
    rectangle(&mut scene, center, u, v, panel(Vec3::ONE));
    let [width, height] = [extent.width as f32, extent.height as f32];
    scene.cameras.push(Camera {
        name: "above".to_owned(),
        world_from_view: Mat4::from_translation(Vec3::new(width / 2.0, -height / 2.0, 5.0)),
        projection: Projection::Orthographic { x_mag: width / 2.0, y_mag: height / 2.0, z_near: 1.0, z_far: 9.0 },
    });
    scene
}

/// A pixel is the mean over the samples of the pattern that lie in it, of whether each is inside: whatever spreads them, over
/// whole pixels or not, more than one a pixel or fewer. Of pixels without a sample the stage says so.
#[test]
fn pixels_are_the_means_of_their_samples() {
    let extent = Extent::new(37, 23);
    let sides = [7.3f32, 4.6, 29.8, 17.9];
    let watched = Watched::with_scene(card(extent, sides));
    let mut partly = 0;
    let sizes = [("1x1", "4"), ("2x2", "4"), ("3x2", "2.5"), ("2.5x1.75", "3"), ("4x3", "0.5"), ("frame", "1")];
    let mut drawn = vec![("stipple", "free"), ("tuples", "free"), ("layers", "sixteenths"), ("tuples", "sixteenths")];
    if Ability::SampleLocations.is_there(&watched.session.gpu.caps) {
        drawn.push(("sample-locations", "sixteenths"));
    }
    let drawn = drawn.into_iter().map(|(members, places)| (Sampler::Relaxed, members, places));
    for (sampler, members, places) in Sampler::ALL.iter().map(|sampler| (*sampler, "layers", "free")).chain(drawn) {
        for (basis, samples) in sizes {
            if basis.contains('.') && (members == "tuples" || places == "sixteenths") {
                continue;
            }
            // What counts by pixels has a whole number for each.
            let is_whole = !basis.contains('.') && !samples.contains('.');
            if sampler.counts_by_pixels() && !is_whole {
                continue;
            }
            let own = [
                ("size", "37x23"),
                ("basis", basis),
                ("samples", samples),
                ("sampler", sampler.name()),
                ("members", members),
                ("places", places),
                ("background", "0"),
                ("rig", "none"),
            ];
            let renderer = watched.render_stages(NAME, &own, &["combine.sums.samples"]);
            let counts = watched.integers(&renderer, "combine.sums.samples");
            let picture = renderer.picture().unwrap();
            let spec_basis = if basis == "frame" { "37x23" } else { basis };
            let spec = format!("basis:basis={spec_basis},samples={samples},sampler={},places={places}", sampler.name());
            let pattern = patterns::open(&spec).unwrap().pattern;
            let (mut near, mut off) = (0, 0);
            for (index, found) in (0u32..).zip(&picture.pixels) {
                let pixel = [index % extent.width, index / extent.width];
                let own = pattern.samples_of(pixel);
                assert_eq!(counts[index as usize], own.len() as u32, "{spec} at {pixel:?}");
                let places = own.iter().map(|sample| [0, 1].map(|i| pixel[i] as f32 + sample.place_px[i]));
                // The rasteriser moves corners by parts of a texel, which are several pixels' parts of a member.
                let is_near_edge = |place: &[f32; 2]| (0..4).any(|side| (place[side % 2] - sides[side]).abs() < 0.05);
                if own.is_empty() || places.clone().any(|place| is_near_edge(&place)) {
                    near += 1;
                    continue;
                }
                let is_inside = |place: &[f32; 2]| {
                    place[0] > sides[0] && place[0] < sides[2] && place[1] > sides[1] && place[1] < sides[3]
                };
                let expected = places.filter(is_inside).count() as f32 / own.len() as f32;
                partly += u32::from(expected > 0.0 && expected < 1.0);
                off += u32::from((found[0] - expected).abs() > 1e-5);
            }
            assert_eq!(off, 0, "{spec}");
            assert!(near < 700, "{spec}: {near}");
        }
    }
    assert!(partly > 600, "{partly}");
}

/// Edges come to those of paths as samples grow, and through a lens what is out of focus does: at the rate of samples that
/// are evenly spread.
#[test]
fn it_converges_to_paths() {
    let watched = Watched::open("cornell");
    let shared = [("size", "36x27"), ("background", "0"), ("direct-shadow", "ray"), ("brdf", "lambert")];
    for (effect, lens) in [("aa", &[][..]), ("aa,defocus", &[("aperture", "0.25"), ("focus", "3")])] {
        let shared = both(&shared, lens);
        let paths = [("transport", "direct"), ("light-visibility", "on"), ("emissive", "off"), ("spp", "2048")];
        let paths = both(&both(&shared, &paths), &[("ambient-visibility", "off")]);
        let paths: Vec<_> = paths.into_iter().filter(|(key, _)| *key != "direct-shadow").collect();
        let reference = watched.picture("path_traced", &paths);
        let error = |samples: &str| {
            let own = [("effect", effect), ("basis", "2x2"), ("samples", samples)];
            rmse(&watched.picture(NAME, &both(&shared, &own)), &reference)
        };
        let errors = ["1", "4", "16"].map(error);
        let exponent = (errors[2] / errors[0]).log2() / 4.0;
        println!("{effect}: {errors:?}, exponent {exponent}");
        assert!(exponent < -0.5, "{effect}: {errors:?}, exponent {exponent}");
    }
}

/// Between two members there is no picture: pixels of those to come have no sample.
#[test]
#[cfg(target_os = "linux")]
fn ctrl_c_leaves_no_half_of_a_picture() {
    let program = Program::new();
    let begin =
        ["render", "cornell", "--technique", NAME, "--size", "250x250", "--basis", "frame", "--sampler", "random"];
    let started = Instant::now();
    // 62,500 members take longer than this, and the first of them less.
    let arguments = [&begin[..], &["--samples", "1", "-o", "half.png", "--report", "half.json"]].concat();
    let (code, said) = program.interrupted(&arguments, || started.elapsed() > Duration::from_secs(5));
    assert_eq!((code, program.files()), (Some(130), Vec::new()), "{said}");
}

#[test]
fn what_cannot_be_is_refused_with_what_can() {
    for (changes, words) in [
        (&[("basis", "2")][..], "--basis 2: it must be NxM, or frame"),
        (&[("basis", "2x2.125")], "at most two decimal places"),
        (&[("basis", "0.5x2")], "from 1 to 16384 pixels"),
        (&[("basis", "frame"), ("size", "640x360")], "921600 members"),
        (&[("members", "tuples"), ("basis", "2.5x2")], "--members tuples with --basis 2.5x2: a member's samples lie"),
        (&[("places", "sixteenths"), ("basis", "2.5x2")], "--places sixteenths with --basis 2.5x2: bases begin"),
        (&[("sampler", "ign"), ("basis", "2.5x2")], "--sampler ign: it gives every pixel the same number"),
        (&[("sampler", "blue-errors"), ("samples", "0.5")], "--sampler blue-errors"),
        (&[("effect", "defocus")], "--effect defocus with --aperture 0"),
        (&[("effect", "defocus"), ("aperture", "0.1"), ("basis", "2.5x2")], "without aa among --effect"),
        (&[("effect", "motion")], "--effect motion with --shutter none"),
        (&[("shutter", "0,1")], "all samples are of one moment"),
        (&[("effect", "soft-shadow")], "--effect soft-shadow with --direct-shadow sun"),
        (&[("light-radius", "0.1")], "--light-radius 0.1 with --effect aa: lights are points"),
        (
            &[("effect", "soft-shadow"), ("direct-shadow", "map"), ("shadow-maps", "once"), ("light-radius", "0.1")],
            "--shadow-maps once: each member",
        ),
        (&[("aperture", "0.1")], "--aperture 0.1 with --effect aa: nothing is spread over the lens"),
    ] {
        let mut job = quincunx::job::Job::new("cornell", quincunx::techniques::find(NAME).unwrap());
        let set = changes.iter().try_for_each(|(key, value)| job.set(key, value));
        let run = set.and_then(|()| job.run_on(&crate::support::watched::watched_device()).map(|_| ()));
        let error = run.err().unwrap_or_else(|| panic!("{changes:?} is possible"));
        assert_eq!(error.exit_code(), 2, "{error}");
        assert!(error.to_string().contains(words), "{changes:?}: {error}");
    }
}
