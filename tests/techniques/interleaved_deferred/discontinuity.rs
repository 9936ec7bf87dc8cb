//! The discontinuity buffer, pixel by pixel: flags stand where normals turn, and where a neighbour lies off the pixel's
//! tangent plane by more than the threshold (Segovia 2006, section 4.5).

use crate::support::boxes::{camera, rectangle};
use crate::support::placing_steps;
use crate::support::seen::{self, Seen};
use crate::support::watched::{Watched, both};
use glam::{Quat, Vec3, vec3};
use quincunx::scene::{Material, Scene};
use quincunx::units::Extent;

const TECHNIQUE: &str = "interleaved_deferred";
/// What these tests read back.
const STAGES: [&str; 2] = ["gbuffer.normal", "discontinuity.flags"];

/// Flags by normals alone: a threshold of a kilometre leaves positions out. Bit 0 is +x, bit 1 +y, bit 2 +xy.
#[test]
fn flags_stand_where_normals_turn() {
    let watched = Watched::open("cornell");
    for extent in [Extent::new(160, 90), Extent::new(97, 53)] {
        let size = extent.to_string();
        let own = [("position-threshold", "1000"), ("normal-threshold", "0.1")];
        let renderer =
            watched.render_stages(TECHNIQUE, &both(&[("size", size.as_str()), ("vpls", "64")], &own), &STAGES);
        let normals = watched.rgb(&renderer, "gbuffer.normal");
        let flags = watched.integers(&renderer, "discontinuity.flags");
        let normal = |x: u32, y: u32| {
            let (x, y) = (x.min(extent.width - 1), y.min(extent.height - 1));
            Vec3::from_array(normals[(y * extent.width + x) as usize])
        };
        for y in 0..extent.height {
            for x in 0..extent.width {
                let own = normal(x, y);
                let differs = |other: Vec3| match (own == Vec3::ZERO, other == Vec3::ZERO) {
                    (false, false) => 1.0 - own.dot(other) > 0.1,
                    (own, other) => own != other,
                };
                let neighbours = [(1, 0), (0, 1), (1, 1)].map(|(dx, dy)| u32::from(differs(normal(x + dx, y + dy))));
                let expected = neighbours[0] | neighbours[1] << 1 | neighbours[2] << 2;
                assert_eq!(flags[(y * extent.width + x) as usize], expected, "{extent} ({x}, {y})");
            }
        }
    }
}

/// Metres.
const THRESHOLD: f32 = 0.05;
/// How far each terrace lies above the one before, in thresholds: below and above it on both sides, closer to it than any
/// storage of positions is off, and up to seven of them.
const STEPS: [f32; 12] = [0.0, 0.5, -0.8, 1.25, -2.0, 0.8, 7.0, -1.25, -0.5, 2.0, -7.0, 0.8];

/// Terraces of one normal, strips side by side, before a wall. Seen straight and, with `grazing`, from so low that
/// neighbours on one terrace are several thresholds apart.
fn terraces(grazing: bool) -> (Scene, Vec<f32>) {
    let turn = Quat::from_axis_angle(vec3(1.0, 2.0, -0.5).normalize(), 0.7);
    let mut scene = Scene { name: "terraces".to_owned(), hash: format!("terraces {grazing}"), ..Scene::default() };
    let mut heights = Vec::new();
    let mut height = 0.0;
    for (index, step) in STEPS.iter().enumerate() {
        height += step * THRESHOLD;
        heights.push(height);
        let center = vec3(0.3 * (index as f32 - 5.5), 0.0, height);
        let grey = Material::diffuse("terrace", Vec3::splat(0.5));
        rectangle(&mut scene, turn * center, turn * (0.15 * Vec3::X), turn * (1.5 * Vec3::Y), grey);
    }
    // What is seen beside and between them.
    heights.push(-2.0);
    let grey = Material::diffuse("wall", Vec3::splat(0.5));
    rectangle(&mut scene, turn * vec3(0.0, 0.0, -2.0), turn * (2.0 * Vec3::X), turn * (1.8 * Vec3::Y), grey);
    let eye = if grazing { vec3(-3.5, 0.4, 0.9) } else { vec3(0.1, 0.2, 3.5) };
    scene.cameras.push(camera(turn * eye, turn * vec3(0.0, 0.0, 0.0), if grazing { 0.6 } else { 1.2 }));
    (scene, heights)
}

/// All of one normal: flags stand where a neighbour's plane is farther off than the threshold, and nowhere else.
#[test]
fn flags_stand_where_surfaces_step() {
    for grazing in [false, true] {
        let (scene, heights) = terraces(grazing);
        let percent = format!("{}%", 100.0 * THRESHOLD / scene.bounds().diagonal());
        let watched = Watched::with_scene(scene);
        for (position, threshold) in
            [("unorm16", "0.05"), ("unorm16", &*percent), ("half", "0.05"), ("depth", "0.05"), ("float", "0.05")]
        {
            let extent = Extent::new(121, 67);
            let changes =
                [("size", "121x67"), ("vpls", "16"), ("position", position), ("position-threshold", threshold)];
            let renderer = watched.render_stages(TECHNIQUE, &changes, &STAGES);
            let flags = watched.integers(&renderer, "discontinuity.flags");
            let seen = seen::sources(&watched, &renderer.view);
            let height = |x: u32, y: u32| match seen[(y * extent.width + x) as usize] {
                Seen::Unclear => Err(()),
                Seen::Nothing => Ok(None),
                Seen::Surface(source) => Ok(Some(heights[source.draw as usize])),
            };
            let (mut flagged, mut level, mut small) = (0u32, 0u32, 0u32);
            for y in 0..extent.height {
                for x in 0..extent.width {
                    let Ok(own) = height(x, y) else { continue };
                    for (bit, [dx, dy]) in [[1, 0], [0, 1], [1, 1]].into_iter().enumerate() {
                        let neighbour = [(x + dx).min(extent.width - 1), (y + dy).min(extent.height - 1)];
                        let Ok(other) = height(neighbour[0], neighbour[1]) else { continue };
                        let expected = match (own, other) {
                            (Some(own), Some(other)) => (other - own).abs() > THRESHOLD,
                            (own, other) => own.is_some() != other.is_some(),
                        };
                        let found = flags[(y * extent.width + x) as usize] >> bit & 1 == 1;
                        let what = format!("grazing {grazing}, {position}, {threshold}");
                        assert_eq!(found, expected, "{what}: ({x}, {y}) at {own:?}, {neighbour:?} at {other:?}");
                        flagged += u32::from(expected);
                        level += u32::from(own == other);
                        small += u32::from(!expected && own != other);
                    }
                }
            }
            // Each kind is there, so none of them can be wrong unseen.
            let few = 200.0 / placing_steps(&watched.session.gpu.caps);
            assert!(flagged > 200 && level > 5000, "{flagged} flagged, {level} level");
            assert!(f64::from(small) > few, "{small} steps that are too small");
        }
    }
}

/// The same discontinuities with and without the thresholds at their ends.
#[test]
fn thresholds_switch_discontinuities_off() {
    let watched = Watched::open("cornell");
    let common = [("size", "97x53"), ("vpls", "64")];
    let flagged = |changes: &[(&str, &str)]| {
        let renderer = watched.render_stages(TECHNIQUE, &both(&common, changes), &STAGES);
        watched.integers(&renderer, "discontinuity.flags").iter().filter(|flag| **flag != 0).count()
    };
    let all = flagged(&[]);
    let normals = flagged(&[("position-threshold", "1000")]);
    let positions = flagged(&[("normal-threshold", "2")]);
    let edges = flagged(&[("position-threshold", "1000"), ("normal-threshold", "2")]);
    // What is left is where the frame shows no surface beside one.
    assert!(
        edges < normals && edges < positions && normals <= all && positions <= all,
        "{all} {normals} {positions} {edges}"
    );
}
