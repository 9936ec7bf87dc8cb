//! `--split subsample`: which pixels are shaded with which lights, and what lies between them (Segovia 2006, section 5.4).

use crate::support::watched::{Watched, both};
use glam::{DVec3, Vec3};
use quincunx::units::Extent;

const TECHNIQUE: &str = "interleaved_deferred";

/// Frames and patterns: whole patterns, parts of them on both sides, parts that end before their own middle, patterns
/// that no side divides, one larger than the frame, and none.
const FRAMES: [([u32; 2], [u32; 2]); 8] = [
    ([96, 48], [4, 4]),
    ([97, 53], [4, 4]),
    ([97, 53], [8, 6]),
    ([98, 51], [5, 7]),
    ([61, 40], [3, 2]),
    ([33, 17], [1, 3]),
    ([15, 9], [16, 16]),
    ([33, 17], [1, 1]),
];

/// The pixels of a side that represent the others: the middle of each stretch of `pattern` pixels, which is the right
/// or lower one of two; the frame's last where the middle lies beyond.
fn middles(side: u32, pattern: u32) -> Vec<u32> {
    (0..side).step_by(pattern as usize).map(|first| (first + pattern / 2).min(side - 1)).collect()
}

/// The places between which a pixel lies, and how far it is on the way from the first to the second; both the same before
/// the first and behind the last.
fn between(middles: &[u32], at: u32) -> (usize, usize, f64) {
    let behind = middles.partition_point(|middle| *middle <= at);
    if behind == 0 || behind == middles.len() {
        let end = behind.saturating_sub(1);
        return (end, end, 0.0);
    }
    let [low, high] = [middles[behind - 1], middles[behind]];
    (behind - 1, behind, f64::from(at - low) / f64::from(high - low))
}

fn at(values: &[[f32; 3]], extent: Extent, x: u32, y: u32) -> DVec3 {
    Vec3::from_array(values[(y * extent.width + x) as usize]).as_dvec3()
}

/// The pixel in the middle of each cell has the bits that all lights give it on a method that shades every pixel, which
/// `light_units` holds against the sum.
#[test]
fn every_light_shades_the_middle_of_each_cell() {
    let watched = Watched::open("cornell");
    for ([width, height], pattern) in FRAMES {
        let (size, text) = (format!("{width}x{height}"), format!("{}x{}", pattern[0], pattern[1]));
        let own: [&[(&str, &str)]; 3] = [
            &[("direct", "none")],
            &[("direct", "interleaved"), ("position", "depth")],
            &[("direct", "none"), ("texels", "1"), ("workgroup", "8x4")],
        ];
        for own in &own[..if width == 97 { 3 } else { 1 }] {
            let common = both(&[("size", size.as_str()), ("pattern", text.as_str()), ("vpls", "96")], own);
            let shaded = |split| {
                let changes = both(&common, &[("split", split)]);
                let renderer = watched.render_stages(TECHNIQUE, &changes, &["shade.irradiance"]);
                watched.rgb(&renderer, "shade.irradiance")
            };
            let (cells, every_pixel) = (shaded("subsample"), shaded("none"));
            let (columns, rows) = (middles(width, pattern[0]), middles(height, pattern[1]));
            let mut lit_count = 0;
            for y in 0..height {
                for x in 0..width {
                    let middle = [columns[(x / pattern[0]) as usize], rows[(y / pattern[1]) as usize]];
                    let found = cells[(y * width + x) as usize];
                    let expected = every_pixel[(middle[1] * width + middle[0]) as usize];
                    assert_eq!(found, expected, "{size} in {text} with {own:?}: ({x}, {y}) and its {middle:?}");
                    lit_count += usize::from(expected != [0.0; 3]);
                }
            }
            assert!(lit_count > 0, "{size} in {text} with {own:?} is dark");
        }
    }
}

/// Between four of them, and between a middle that the frame's edge holds back and its neighbour, irradiance is bilinear;
/// on a middle it is what was shaded there, and outside all of them it is the nearest one's.
#[test]
fn pixels_between_the_middles_are_interpolated() {
    let watched = Watched::open("cornell");
    for ([width, height], pattern) in FRAMES {
        let extent = Extent::new(width, height);
        let (size, text) = (extent.to_string(), format!("{}x{}", pattern[0], pattern[1]));
        let changes = [("size", size.as_str()), ("pattern", &text), ("vpls", "96"), ("split", "subsample")];
        let renderer = watched.render_stages(TECHNIQUE, &changes, &["shade.irradiance", "upscale.irradiance"]);
        let cells = watched.rgb(&renderer, "shade.irradiance");
        let upscaled = watched.rgb(&renderer, "upscale.irradiance");
        let (columns, rows) = (middles(width, pattern[0]), middles(height, pattern[1]));
        // A cell shows its value in all of its pixels, the middle one among them.
        let shaded = |column: usize, row: usize| at(&cells, extent, columns[column], rows[row]);
        for y in 0..height {
            let (above, below, down) = between(&rows, y);
            for x in 0..width {
                let (left, right, across) = between(&columns, x);
                let row = |row: usize| shaded(left, row) * (1.0 - across) + shaded(right, row) * across;
                let expected = row(above) * (1.0 - down) + row(below) * down;
                let found = at(&upscaled, extent, x, y);
                // Rounded to a half float once: 2^-11 of the value, or of subnormal ones half of 2^-24.
                let bound = expected * (2f64.powi(-11) + 1e-6) + 2f64.powi(-25);
                let difference = (found - expected).abs();
                assert!(difference.cmple(bound).all(), "{size} in {text}: ({x}, {y}): {found} for {expected}");
            }
        }
        assert!(upscaled.iter().any(|irradiance| irradiance[0] > 0.0), "{size} in {text} is dark");
    }
}

/// The composite takes what was interpolated: the picture of matt surfaces without emission is albedo / pi of it, and albedo of
/// the ambient light.
#[test]
fn the_picture_is_made_of_what_was_interpolated_and_of_ambient_light() {
    let mut scene = quincunx::scene::load("cornell", 1).unwrap();
    for material in &mut scene.materials {
        material.emissive = Vec3::ZERO;
    }
    scene.hash = "cornell without emission".to_owned();
    let watched = Watched::with_scene(scene);
    for ambient in [Vec3::ZERO, Vec3::new(0.125, 0.25, 0.5)] {
        let text = format!("{},{},{}", ambient.x, ambient.y, ambient.z);
        let changes = [
            ("size", "97x53"),
            ("pattern", "4x4"),
            ("vpls", "96"),
            ("split", "subsample"),
            ("direct", "none"),
            ("brdf", "lambert"),
            ("ambient", &text),
        ];
        let renderer = watched.render_stages(TECHNIQUE, &changes, &["gbuffer.color", "upscale.irradiance"]);
        let albedo = watched.rgb(&renderer, "gbuffer.color");
        let irradiance = watched.rgb(&renderer, "upscale.irradiance");
        let picture = renderer.picture().unwrap();
        for ((found, albedo), irradiance) in picture.pixels.iter().zip(&albedo).zip(&irradiance) {
            let arriving = Vec3::from_array(*irradiance) / std::f32::consts::PI + ambient;
            let expected = Vec3::from_array(*albedo) * arriving;
            let difference = (Vec3::from_array(*found) - expected).abs();
            assert!(difference.cmple(expected * 1e-6).all(), "{ambient}: {found:?} for {expected}");
        }
        assert!(picture.mean()[0] > 0.0);
    }
}
