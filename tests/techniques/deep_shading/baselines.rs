//! Baselines of deep shading: on the same samples supersampling gives the lists' picture, exactly where a triangle has
//! one colour; multisampling to nearly the same; and what both shade is counted.

use super::visibilities;
use crate::support::boxes::{camera, rectangle};
use crate::support::difference::{require_same, rmse};
use crate::support::moving::{moving, unlit};
use crate::support::program::Program;
use crate::support::watched::{Changes, Watched, both};
use crate::support::{Feature, has, placing_steps};
use glam::{Mat4, Vec3};
use quincunx::gpu::commands::Submits;
use quincunx::picture::Picture;
use quincunx::scene::{Camera, Material, Projection, Scene};
use std::collections::BTreeMap;

const DEEP: &str = "deep_shading";
const SIZE: (&str, &str) = ("size", "161x91");
const SSAA: (&str, &str) = ("shading", "ssaa");
const MSAA: (&str, &str) = ("shading", "msaa");
const STOCHASTIC: (&str, &str) = ("visibility", "stochastic");

/// The fence's rotor turns by a quarter of a turn.
fn rotor() -> Scene {
    moving("fence:lights=6", [0.0, 0.1])
}

fn counters(watched: &Watched, changes: Changes<'_>) -> BTreeMap<&'static str, f64> {
    watched.render(DEEP, changes).measured_counters().unwrap()
}

#[test]
fn supersampled_colours_of_triangles_are_the_lists_to_the_bit() {
    let sets = [("size", "97x55"), ("spp", "4"), ("accumulate", "2")];
    let lens = both(&sets, &[("aperture", "0.1"), ("focus", "4"), ("camera", "rotor")]);
    let watched = Watched::with_scene(unlit(rotor(), false));
    for visibility in visibilities(SSAA.1) {
        let seen = both(&lens, &[("visibility", visibility)]);
        let supersampled = both(&seen, &[SSAA]);
        let [one, other] = [&supersampled, &seen].map(|changes| watched.picture(DEEP, changes));
        require_same(&watched.session.gpu, &one, &other, &visibility);
        let counted = counters(&watched, &supersampled);
        let deep = counters(&watched, &seen);
        assert_eq!(counted["samples_seen"], deep["samples_seen"], "{visibility}");
        assert!(counted["shader_invocations"] >= counted["samples_seen"], "{visibility}: {counted:?}");
        assert_eq!(counted.contains_key("sample_tests"), visibility == "stochastic");
        assert!(!counted.contains_key("lists"), "{counted:?}");
    }
}

/// Half floats keep 2^-12 of a colour at worst, as of the lists. Scenes without textures: a driver finds their levels in another
/// way where the shader does not say how fast coordinates change.
#[test]
fn one_sample_in_the_middle_is_forward_shading() {
    for spec in ["cornell", "lamps:objects=40,lights=20"] {
        let watched = Watched::open(spec);
        if !has(&watched.session.gpu.caps, Feature::ExactPositions) {
            return;
        }
        let forward = watched.picture("forward", &[SIZE]);
        let far = rmse(&watched.picture(DEEP, &[SIZE, SSAA, ("spp", "1"), ("tuples", "1")]), &forward);
        println!("{spec}: {far}");
        assert!(far > 0.0 && far < 1e-3, "{spec}: {far}");
    }
}

/// There a sample's place is its shading point, but where that lies beyond the triangle's edge, and textures have the levels of
/// a pixel by either. Those of the rasteriser's differences across 2 x 2 pixels differ a little from the triangle's own.
#[test]
fn one_sample_in_the_middle_has_the_textures_of_the_lists() {
    let watched = Watched::open("hall:triangles=8000");
    let common = [SIZE, ("spp", "1"), ("tuples", "1"), ("pixel-samples", "shared")];
    let deep = watched.picture(DEEP, &common);
    for visibility in visibilities(SSAA.1) {
        let supersampled = watched.picture(DEEP, &both(&common, &[SSAA, ("visibility", visibility)]));
        let far = rmse(&supersampled, &deep);
        println!("{visibility}: {far}");
        // Highlights on small balls are where their triangles are drawn: seen with 4 bits, 0.035.
        assert!(far < 0.01 * placing_steps(&watched.session.gpu.caps), "{visibility}: {far}");
    }
}

/// A pass with one sample a pixel shares nothing: the tests, depths and places are the same. The rasteriser says
/// nothing of either picture, so that each pixel is the same.
#[test]
fn multisampling_of_one_sample_is_supersampling() {
    let watched = Watched::with_scene(rotor());
    let common = [SIZE, ("camera", "rotor"), ("spp", "2"), ("aperture", "0.1"), ("focus", "4")];
    let supersampled = watched.picture(DEEP, &both(&common, &[SSAA, STOCHASTIC]));
    let multisampled = watched.picture(DEEP, &both(&common, &[MSAA, ("pass-samples", "1")]));
    require_same(&watched.session.gpu, &multisampled, &supersampled, &common);
}

/// Panes of one colour that face the camera, so that each has one depth, and one of which moves: nothing of what
/// multisampling shares is lost, in passes of one sample and of several.
#[test]
fn multisampled_panes_are_the_lists_to_the_bit() {
    let mut scene = Scene { name: "panes".to_owned(), ..Scene::default() };
    for (x_m, z_m, color) in [(0.0, 0.0, Vec3::X), (9.0, 3.0, Vec3::Y), (-7.0, 6.0, Vec3::Z), (2.0, 9.0, Vec3::ONE)] {
        let pane = Material { unlit: true, ..Material::diffuse("pane", 0.3 * color) };
        rectangle(&mut scene, Vec3::new(x_m, 0.5 * x_m, z_m), 8.0 * Vec3::X, 6.0 * Vec3::Y, pane);
    }
    scene.cameras.push(camera(20.0 * Vec3::Z, Vec3::ZERO, 1.2));
    scene.hash = "opening".to_owned();
    let mut close = Scene { hash: "closing".to_owned(), ..scene.clone() };
    close.draws[2].world_from_object = Mat4::from_translation(5.0 * Vec3::X);
    let watched = Watched::with_scene(scene.closing_as(close).unwrap());
    let common = [SIZE, ("aperture", "0.6"), ("focus", "17"), ("spp", "8"), ("accumulate", "2"), ("rig", "none")];
    let deep = watched.render(DEEP, &both(&common, &[STOCHASTIC]));
    let (picture, seen) = (deep.picture().unwrap(), deep.measured_counters().unwrap()["samples_seen"]);
    for pass_samples in ["1", "4"] {
        let multisampled = watched.render(DEEP, &both(&common, &[MSAA, ("pass-samples", pass_samples)]));
        require_same(&watched.session.gpu, &multisampled.picture().unwrap(), &picture, &pass_samples);
        assert_eq!(multisampled.measured_counters().unwrap()["samples_seen"], seen, "{pass_samples} samples a pass");
    }
}

/// As the lists' own test: four sets of as many samples halve the error of independent ones. What more samples cannot mend is
/// multisampling's one depth for all samples of a fragment: where boxes meet the floor, some see the wrong one of the two. Of
/// the 99 in 100 pixels that differ least half of the lists' own error at so many samples may be left: four samples are
/// shaded at the place of one, of smooth light. Light beyond white is cut: what is next to a lamp has no bound.
#[test]
fn blur_comes_to_what_path_tracing_sees() {
    let light = [("size", "64x64"), ("brdf", "lambert"), ("aperture", "0.15")];
    let traced = [("transport", "direct"), ("light-visibility", "off"), ("emissive", "off"), ("spp", "1024")];
    let watched = Watched::open("cornell");
    if !has(&watched.session.gpu.caps, Feature::ExactPositions) {
        return;
    }
    let white = |mut picture: Picture| {
        picture.pixels.iter_mut().flatten().for_each(|channel| *channel = channel.min(1.0));
        picture
    };
    let reference = white(watched.picture("path_traced", &both(&light, &traced)));
    let error = |shading, sets| {
        let changes = both(&light, &[shading, ("spp", "4"), ("accumulate", sets)]);
        rmse(&white(watched.picture(DEEP, &changes)), &reference)
    };
    let of = |shading| ["1", "4", "16", "64"].map(|sets| error(shading, sets));
    let (deep, supersampled) = (of(("shading", "deep")), of(SSAA));
    println!("4, 16, 64, 256 samples: lists {deep:?}, supersampled {supersampled:?}");
    for errors in [deep, supersampled] {
        assert!(errors.windows(2).all(|pair| pair[1] < 0.75 * pair[0]), "{errors:?}");
    }
    assert!(supersampled[3] < 1.1 * deep[3]);
    let many = both(&light, &[("spp", "4"), ("accumulate", "64")]);
    let [lists, multisampled] =
        [("shading", "deep"), MSAA].map(|shading| white(watched.picture(DEEP, &both(&many, &[shading]))).pixels);
    let mut squares: Vec<f64> = lists
        .iter()
        .zip(&multisampled)
        .map(|(a, b)| a.iter().zip(b).map(|(a, b)| f64::from(a - b).powi(2)).sum::<f64>() / 3.0)
        .collect();
    squares.sort_by(f64::total_cmp);
    let most = &squares[..squares.len() / 100 * 99];
    let far = (most.iter().sum::<f64>() / most.len() as f64).sqrt();
    println!("multisampled: {far} from the lists, {} at worst", squares[squares.len() - 1].sqrt());
    assert!(far < 0.5 * deep[3], "{far}, {deep:?}");
}

/// Two triangles on a quarter of the frame's width and height, a metre a pixel: drivers that cut off what lies beyond the frame
/// cut nothing into pieces.
fn wall() -> Scene {
    let mut scene = Scene { name: "wall".to_owned(), ..Scene::default() };
    let white = Material { unlit: true, ..Material::diffuse("white", Vec3::ONE) };
    rectangle(&mut scene, Vec3::ZERO, 8.0 * Vec3::X, 4.0 * Vec3::Y, white);
    let projection = Projection::Orthographic { x_mag: 32.0, y_mag: 16.0, z_near: 1.0, z_far: 40.0 };
    let world_from_view = Mat4::from_translation(20.0 * Vec3::Z);
    scene.cameras.push(Camera { name: "flat".to_owned(), world_from_view, projection });
    scene
}

/// A pixel has as many fragments as triangles that its samples see, in each pass: those along the wall's diagonal two, and no
/// inner edge of what is drawn around a triangle adds one.
#[test]
fn a_triangle_is_shaded_once_a_pixel_and_pass_or_once_a_sample() {
    let watched = Watched::with_scene(wall());
    let common = [("size", "64x32"), ("spp", "8")];
    let shaded = |changes: Changes<'_>| counters(&watched, &both(&common, changes))["shader_invocations"];
    let pixels = 16.0 * 8.0;
    assert_eq!(shaded(&[SSAA]), 8.0 * pixels);
    for (pass_samples, passes) in [("1", 8.0), ("4", 2.0)] {
        let (least, found) = (passes * pixels, shaded(&[MSAA, ("pass-samples", pass_samples)]));
        println!("{pass_samples} samples a pass: {found}, {least} without the diagonal");
        // It goes through 16 pixels.
        assert!(found >= least && found <= least + passes * 16.0, "{pass_samples}: {found}");
    }
}

/// Under blur a pixel's samples see ever more triangles, and lists hardly more (section 6.1).
#[test]
fn blur_costs_multisampling_more_than_it_costs_lists() {
    let watched = Watched::open("hall:triangles=8000");
    let rate = |shading: &str, aperture: &str| {
        let changes = [SIZE, ("spp", "8"), ("focus", "6"), ("shading", shading), ("aperture", aperture)];
        counters(&watched, &changes)["shaded_per_pixel"]
    };
    let [sharp, blurred] = ["0", "0.3"].map(|aperture| ["deep", "msaa", "ssaa"].map(|shading| rate(shading, aperture)));
    println!("deep, msaa, ssaa: {sharp:?} sharp, {blurred:?} blurred");
    let [deep, msaa, ssaa] = blurred;
    assert!(msaa >= deep && ssaa >= 8.0, "{blurred:?}");
    let growth = [0, 1].map(|index| blurred[index] / sharp[index]);
    assert!(growth[1] > growth[0], "{growth:?}");
}

/// Neither has more than the multisampled frame buffer (Clarberg & Munkberg 2014, section 6: 84.4 MB).
#[test]
fn memory_is_the_frame_buffer_s() {
    let program = Program::new();
    for shading in ["ssaa", "msaa"] {
        let arguments = [
            "memory",
            "--technique",
            DEEP,
            "--plan",
            "--size",
            "1280x720",
            "--spp",
            "8",
            "--shading",
            shading,
            "--json",
        ];
        let json = program.run(&arguments).fine().json();
        let groups: BTreeMap<String, u64> =
            serde_json::from_value(json["techniques"][0]["memory"]["groups"].clone()).unwrap();
        assert_eq!(groups["frame_buffer"], 88_473_600, "{shading}");
        for group in ["deep_shading_buffer", "auxiliary"] {
            assert!(!groups.contains_key(group), "{shading}: {groups:?}");
        }
    }
}

#[test]
fn settings_that_a_baseline_does_not_read_are_refused() {
    let watched = Watched::open("cornell");
    for (changes, said) in [
        (&[SSAA, ("lists", "none")][..], "--lists none with --shading ssaa"),
        (&[MSAA, ("compaction", "off")], "--compaction off with --shading msaa"),
        (&[MSAA, ("conservative", "vertex")], "--conservative vertex with --shading msaa"),
        (&[("conservative", "vertex")], "--conservative vertex with --shade-by compute"),
        (&[("zmax", "on")], "--zmax on with --shade-by compute"),
        (&[SSAA, ("guard-band", "0")], "--guard-band 0 with --shading ssaa"),
        (&[SSAA, ("pass-samples", "4")], "--pass-samples 4 with --shading ssaa"),
        (&[MSAA, ("visibility", "instancing")], "--visibility instancing with --shading msaa"),
        (&[MSAA, ("visibility", "repeat-frame")], "--visibility repeat-frame with --shading msaa"),
        (&[SSAA, ("visibility", "ray")], "--visibility ray with --shading ssaa"),
        (&[SSAA, ("layer-from", "vertex")], "--layer-from vertex with --shading ssaa"),
        (&[MSAA, ("polygon-from", "vertex")], "--polygon-from vertex with --shading msaa"),
        (&[("pass-samples", "8")], "--pass-samples 8 with --shading deep"),
        (&[("pass-samples", "1")], "--pass-samples 1 with --shading deep"),
        (&[MSAA, ("pass-samples", "4"), ("spp", "6")], "--pass-samples 4: --spp 6 is not a multiple of it"),
    ] {
        let made = watched.try_renderer(DEEP, changes, &[], Submits::One);
        let error = made.map(|_| ()).unwrap_err();
        assert_eq!(error.exit_code(), 2, "{changes:?}");
        assert!(error.to_string().contains(said), "{changes:?}: {error}");
    }
    for stage in ["visibility.spids", "count.lengths"] {
        let error = watched.try_renderer(DEEP, &[SIZE, SSAA], &[stage], Submits::One).map(|_| ()).unwrap_err();
        assert!(error.to_string().contains("--shading deep makes it"), "{error}");
    }
}
