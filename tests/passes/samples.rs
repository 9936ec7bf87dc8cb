//! `--msaa` with `--sample-shading`: where a surface is shaded, and how often; with `--sample-format`: what samples hold.

use crate::support::square::{FOUR_PLACES, matt, square};
use crate::support::watched::{Changes, Watched, both};
use crate::support::{self, Feature};
use glam::{Vec2, Vec3, Vec4};
use quincunx::metrics;
use quincunx::scene::{AlphaMode, Light, LightKind, Material, Scene};

const TECHNIQUES: [&str; 2] = ["forward", "inferred_lighting"];
const MANY: [(&str, &str); 2] = [("msaa", "4"), ("sample-shading", "on")];
const ONCE: [(&str, &str); 1] = [("msaa", "4")];
const EXTENT: (usize, usize) = (8, 8);
const SIZE: (&str, &str) = ("size", "8x8");
const MIDDLE: Vec2 = Vec2::splat(0.5);
const CUTOFF: f32 = 0.5;

/// What the square shows at a place of the picture, parts of it: both grow across it.
fn grey_at(place: Vec2) -> f32 {
    0.2 + 0.8 * place.x
}

fn alpha_at(place: Vec2) -> f32 {
    0.1 + 0.7 * place.x + 0.2 * place.y
}

/// Sends its colour, over black.
fn ramp(alpha: AlphaMode) -> Scene {
    let mut scene = square(Material { unlit: true, dielectric_f0: 0.0, alpha, ..matt(Vec4::ONE) });
    let color = |uv: &Vec2| Vec3::splat(grey_at(*uv)).extend(alpha_at(*uv));
    scene.meshes[0].colors = scene.meshes[0].uvs.iter().map(color).collect();
    scene
}

/// The mean of what is seen at these places of each pixel.
fn expected(alpha: AlphaMode, places: &[Vec2]) -> Vec<f32> {
    let seen = |place: Vec2| match alpha {
        AlphaMode::Blend => grey_at(place) * alpha_at(place),
        _ if alpha_at(place) < CUTOFF => 0.0,
        _ => grey_at(place),
    };
    let (width, height) = EXTENT;
    let whole = Vec2::new(width as f32, height as f32);
    let pixels = (0..width * height).map(|index| Vec2::new((index % width) as f32, (index / width) as f32));
    pixels
        .map(|pixel| places.iter().map(|place| seen((pixel + *place) / whole)).sum::<f32>() / places.len() as f32)
        .collect()
}

#[test]
fn each_sample_is_shaded_at_its_place() {
    for alpha in [AlphaMode::Mask { cutoff: CUTOFF }, AlphaMode::Blend] {
        let watched = Watched::with_scene(ramp(alpha));
        if !support::has(&watched.session.gpu.caps, Feature::SampleShading) {
            return;
        }
        let apart = expected(alpha, &FOUR_PLACES);
        assert!(apart.iter().zip(expected(alpha, &[MIDDLE])).any(|(a, b)| (a - b).abs() > 0.0005), "{alpha:?}");
        for technique in TECHNIQUES {
            for prepass in ["on", "off"] {
                for (samples, places) in [(&MANY[..], &FOUR_PLACES[..]), (&ONCE, &[MIDDLE])] {
                    let changes = both(&[SIZE, ("depth-prepass", prepass)], samples);
                    let picture = watched.picture(technique, &changes);
                    for (index, (found, expected)) in picture.pixels.iter().zip(expected(alpha, places)).enumerate() {
                        // A pixel of both triangles is shaded for each, at a place of the driver's choice.
                        if samples == ONCE && index % EXTENT.0 + index / EXTENT.0 == EXTENT.0 - 1 {
                            continue;
                        }
                        let off = (found[0] - expected).abs();
                        assert!(
                            off < 1e-4,
                            "{technique}, {alpha:?}, {changes:?}, pixel {index}: {found:?} for {expected}"
                        );
                    }
                }
            }
        }
    }
}

/// Where a floor or a wall recedes, what is shaded elsewhere than in the middle of a pixel lies on it still: a place behind it would see
/// no light.
#[test]
fn samples_lie_on_their_triangles() {
    let watched = Watched::open("hall:triangles=5000");
    if !support::has(&watched.session.gpu.caps, Feature::SampleShading) {
        return;
    }
    for shadows in ["ray", "map"] {
        let shared = [("size", "161x97"), ("direct-shadow", shadows)];
        let picture = |changes: Changes<'_>| watched.picture("forward", &both(&shared, changes));
        let reference = picture(&[("supersample", "4")]);
        for (changes, most) in [(&ONCE[..], 0.08), (&MANY, 0.05)] {
            let flip =
                metrics::compare(&picture(changes), &reference, metrics::DEFAULT_THRESHOLD).unwrap().metrics.flip;
            println!("{shadows}, {changes:?}: FLIP {flip}");
            assert!(flip < most, "{shadows}, {changes:?}: {flip}");
        }
    }
}

/// The square under a light near its middle.
fn lit() -> Watched {
    let mut scene = square(matt(Vec4::ONE));
    scene.lights = vec![Light {
        name: String::new(),
        kind: LightKind::Point,
        intensity: Vec3::splat(9.0),
        position: Vec3::new(0.2, 0.3, 0.4),
        direction: Vec3::NEG_Z,
        range: None,
        radius: 0.0,
    }];
    Watched::with_scene(scene)
}

#[test]
fn lights_are_counted_as_often_as_they_are_evaluated() {
    let watched = lit();
    if !support::has(&watched.session.gpu.caps, Feature::SampleShading) {
        return;
    }
    let evaluated = |changes: Changes<'_>| {
        let counters = watched.render("forward", &both(&[SIZE], changes)).measured_counters().unwrap();
        ["light_evaluations", "light_evaluations_culled"].map(|key| counters[key])
    };
    let pixels = (EXTENT.0 * EXTENT.1) as f64;
    assert_eq!(evaluated(&ONCE), [pixels, 0.0]);
    assert_eq!(evaluated(&MANY), [4.0 * pixels, 0.0]);
}

/// Pixels have middles of the light buffer's texels in them, where light changes its slope.
#[test]
fn the_light_buffer_is_read_at_each_sample_s_place() {
    const SIDE: usize = 5;
    const SCALE: f32 = SIDE as f32 / EXTENT.0 as f32;
    let watched = lit();
    if !support::has(&watched.session.gpu.caps, Feature::SampleShading) {
        return;
    }
    let common = [SIZE, ("light-size", "5x5"), ("brdf", "lambert"), ("l-buffer", "float")];
    let stage = "light.l_buffer.irradiance";
    for (samples, places) in [(&MANY[..], &FOUR_PLACES[..]), (&ONCE, &[MIDDLE])] {
        let renderer = watched.render_stages("inferred_lighting", &both(&common, samples), &[stage]);
        let light = watched.rgb(&renderer, stage);
        // The AOV shows each texel at the pixels whose middles it holds.
        let shown = |texel: usize| ((texel as f32 + 0.5) / SCALE) as usize;
        let texel = |x: usize, y: usize| light[shown(y) * EXTENT.0 + shown(x)][0];
        let irradiance = |place: Vec2| {
            let at = place * SCALE - 0.5;
            let (first, part) = (at.floor(), at - at.floor());
            let inside = |texel: f32| (texel as i32).clamp(0, SIDE as i32 - 1) as usize;
            let [left, right, above, below] = [first.x, first.x + 1.0, first.y, first.y + 1.0].map(inside);
            let row = |y: usize| texel(left, y) * (1.0 - part.x) + texel(right, y) * part.x;
            row(above) * (1.0 - part.y) + row(below) * part.y
        };
        let mean = |pixel: Vec2, places: &[Vec2]| {
            let sum: f32 = places.iter().map(|place| irradiance(pixel + *place)).sum();
            sum / places.len() as f32 / std::f32::consts::PI
        };
        let mut most_apart = 0f32;
        let picture = renderer.picture().unwrap();
        for (index, found) in picture.pixels.iter().enumerate() {
            let (x, y) = (index % EXTENT.0, index / EXTENT.0);
            if x + y == EXTENT.0 - 1 {
                continue;
            }
            let pixel = Vec2::new(x as f32, y as f32);
            let expected = mean(pixel, places);
            most_apart = most_apart.max((mean(pixel, &FOUR_PLACES) / mean(pixel, &[MIDDLE]) - 1.0).abs());
            assert!((found[0] / expected - 1.0).abs() < 1e-4, "{samples:?}, pixel {x} {y}: {found:?} for {expected}");
        }
        assert!(most_apart > 0.01, "{most_apart}: too little to tell one from the other");
    }
}

const HALVES: [(&str, &str); 2] = [("msaa", "4"), ("sample-format", "half")];

/// A half float has 11 bits, which drivers round or cut.
#[test]
fn samples_of_half_the_bytes_are_within_a_step_of_half_floats() {
    let watched = lit();
    for (technique, samples) in
        [("forward", "forward.material.color"), ("inferred_lighting", "inferred_lighting.material.samples")]
    {
        let render = |changes: Changes<'_>| {
            let renderer = watched.render(technique, &both(&[SIZE], changes));
            let planned = renderer.plan.resources.iter().find(|planned| planned.name == samples).unwrap();
            (renderer.picture().unwrap().pixels, planned.bytes())
        };
        let ((floats, bytes), (halves, half_bytes)) = (render(&ONCE), render(&HALVES));
        assert_eq!(half_bytes * 2, bytes, "{technique}");
        assert_ne!(floats, halves, "{technique}");
        for (float, half) in floats.as_flattened().iter().zip(halves.as_flattened()) {
            assert!((float - half).abs() <= float / 1024.0, "{technique}: {half} for {float}");
        }
    }
}

/// Layers of 65504 add up to no more, and so never to a NaN below a layer that lets nothing through.
#[test]
fn what_is_brighter_than_a_half_float_holds_is_the_greatest() {
    for (alpha, coverage) in [(AlphaMode::Opaque, 1.0), (AlphaMode::Blend, 0.5), (AlphaMode::Blend, 1.0)] {
        let base_color = Vec4::new(0.0, 0.0, 0.0, coverage);
        let mut scene = square(Material { alpha, emissive: Vec3::new(1e6, 3.0, 0.5), ..matt(base_color) });
        let pane = scene.draws[0];
        scene.draws.push(pane);
        let watched = Watched::with_scene(scene);
        let covered = 1.0 - (1.0 - coverage) * (1.0 - coverage);
        for technique in TECHNIQUES {
            for found in watched.picture(technique, &both(&[SIZE, ("ambient", "0")], &HALVES)).pixels {
                let expected = [65504.0, 3.0, 0.5].map(|channel| channel * covered);
                let apart = found.iter().zip(expected).map(|(found, expected)| (found / expected - 1.0).abs());
                assert!(apart.fold(0.0, f32::max) < 1e-3, "{technique}, {alpha:?}: {found:?} for {expected:?}");
            }
        }
    }
}

/// One place stands for all of a pixel that has an edge of light, of a texel or of a hole.
#[test]
fn a_picture_shaded_by_samples_is_nearer_to_that_of_many_places() {
    let size = ("size", "200x112");
    let watched = Watched::open("fence:lights=20");
    if !support::has(&watched.session.gpu.caps, Feature::SampleShading) {
        return;
    }
    let reference = watched.picture("forward", &[size, ("supersample", "8")]);
    let [once, many] = [&ONCE[..], &MANY].map(|samples| {
        let picture = watched.picture("forward", &both(&[size], samples));
        metrics::compare(&picture, &reference, metrics::DEFAULT_THRESHOLD).unwrap().metrics.flip
    });
    println!("FLIP {once:.4} shaded once a pixel, {many:.4} once a sample");
    assert!(many < 0.85 * once, "{once} {many}");
}
