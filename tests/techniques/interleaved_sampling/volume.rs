//! Volumes by slices (section 3.3): planes are where they are said to be, add up as they should, meet surfaces where those are,
//! and come to what a fine march along rays finds.

use super::NAME;
use crate::support::boxes::{camera, panel, rectangle};
use crate::support::difference::rmse;
use crate::support::watched::{Changes, Watched, both};
use glam::{Mat3, Vec3, vec3};
use quincunx::picture::Picture;
use quincunx::sampling::pcg::Pcg32;
use quincunx::scene::{self, Projection, Scene};
use quincunx::techniques::patterns;
use quincunx::volume::{Volume, Voxels};
use std::fs;
use std::sync::Arc;
use tempfile::TempDir;

/// Colour and extinction grow with the value: `[r, g, b]` times value, and `EXTINCTION` times value over the longest side.
const COLOR: [f32; 3] = [1.0, 0.5, 0.25];
const EXTINCTION: f32 = 6.0;

/// The file of that transfer function, in a folder that ends with the test.
fn transfer() -> (TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("linear.txt");
    fs::write(&path, format!("# linear\n0 0 0 0 0\n1 1 0.5 0.25 {EXTINCTION}\n")).unwrap();
    (folder, path.display().to_string())
}

/// Values of 0 to 1 on a grid, independent of each other, which a byte, a word and a float hold alike.
fn noise(size: [u32; 3]) -> Volume {
    let mut random = Pcg32::new(3, 7);
    let values: Vec<f32> = (0..size.iter().product()).map(|_| random.below(256) as f32 / 255.0).collect();
    volume(size, values)
}

fn volume(size: [u32; 3], values: Vec<f32>) -> Volume {
    let name = format!("test {size:?} {:?}", values.first());
    Volume { hash: name.clone(), name, size, spacing: [1.0; 3], voxels: Voxels::F32(values), range: [0.0, 1.0] }
}

/// The value at a place in voxels: the sum over the eight around it.
fn value_at(volume: &Volume, place: Vec3) -> f32 {
    let Voxels::F32(values) = &volume.voxels else { panic!("the test's volumes are floats") };
    let [width, height, _] = volume.size.map(|size| size as usize);
    let low = place.floor().min(Vec3::from(volume.size.map(|size| size as f32 - 2.0))).max(Vec3::ZERO);
    let part = place - low;
    let mut sum = 0.0;
    for corner in 0..8usize {
        let one = [corner & 1, corner >> 1 & 1, corner >> 2 & 1];
        let weight = |axis: usize| if one[axis] == 1 { part[axis] } else { 1.0 - part[axis] };
        let at = [0, 1, 2].map(|axis| low[axis] as usize + one[axis]);
        sum += weight(0) * weight(1) * weight(2) * values[(at[2] * height + at[1]) * width + at[0]];
    }
    sum
}

/// A wall that shines behind where volumes of these tests stand, and a camera that looks past the box's middle.
fn before_a_wall(is_perspective: bool) -> Scene {
    let mut scene = Scene { name: "wall".to_owned(), hash: format!("wall {is_perspective}"), ..Scene::default() };
    rectangle(&mut scene, vec3(0.0, 0.0, -2.0), 4.0 * Vec3::X, 4.0 * Vec3::Y, panel(vec3(0.2, 0.3, 0.4)));
    let mut camera = camera(vec3(0.5, 0.3, 2.0), vec3(0.05, 0.02, 0.0), 0.6);
    if !is_perspective {
        camera.projection = Projection::Orthographic { x_mag: 0.6, y_mag: 0.6, z_near: 0.1, z_far: 9.0 };
    }
    scene.cameras.push(camera);
    scene
}

/// Where the box of `PLACED` stands.
const PLACED: Changes<'static> =
    &[("volume-length", "1"), ("volume-at", "0.1,0,0.05"), ("volume-turn", "30"), ("rig", "none"), ("background", "0")];

/// What planes of a step's worth each show at a pixel of a square picture of `side` pixels, by the formula: back to front
/// over the wall.
fn sliced(volume: &Volume, scene: &Scene, [x, y]: [u32; 2], side: u32, planes: u32, offset: f32) -> Vec3 {
    let camera = &scene.cameras[0];
    let axes = Mat3::from_mat4(camera.world_from_view);
    let (eye, forward) = (camera.world_from_view.w_axis.truncate(), -axes.z_axis);
    let ndc = |at: u32| (at as f32 + 0.5) / side as f32 * 2.0 - 1.0;
    let (origin, direction) = match camera.projection {
        Projection::Perspective { y_fov, .. } => {
            let reach = (0.5 * y_fov).tan();
            (eye, (forward + axes * vec3(ndc(x) * reach, -ndc(y) * reach, 0.0)).normalize())
        }
        Projection::Orthographic { x_mag, y_mag, .. } => {
            (eye + axes * vec3(ndc(x) * x_mag, -ndc(y) * y_mag, 0.0), forward)
        }
    };
    let last = Vec3::from(volume.size.map(|size| (size - 1) as f32));
    let sides = last / last.max_element();
    let turned = Mat3::from_rotation_y(30f32.to_radians());
    let middle = vec3(0.1, 0.0, 0.05);
    let corners = (0..8).map(|corner| {
        let one = vec3((corner & 1) as f32, (corner >> 1 & 1) as f32, (corner >> 2 & 1) as f32);
        (middle + turned * ((one - 0.5) * sides) - eye).dot(forward)
    });
    let (first, end) = corners.fold((f32::MAX, f32::MIN), |(low, high), depth| (low.min(depth), high.max(depth)));
    let step = (end - first) / planes as f32;
    let cosine = direction.dot(forward);
    let mut seen = vec3(0.2, 0.3, 0.4);
    for plane in (0..planes).rev() {
        let depth = first + (plane as f32 + offset) * step;
        let at = origin + direction * ((depth - (origin - eye).dot(forward)) / cosine);
        let place = (turned.transpose() * (at - middle) / sides + 0.5) * last;
        if place.min_element() < 0.0 || (last - place).min_element() < 0.0 {
            continue;
        }
        let value = value_at(volume, place);
        let hidden = 1.0 - (-EXTINCTION * value * step / cosine).exp();
        seen = seen * (1.0 - hidden) + hidden * value * Vec3::from(COLOR);
    }
    seen
}

/// Pixels that are further apart than `bound`, in any channel.
fn apart(a: &Picture, b: &[Vec3], bound: f32) -> usize {
    a.pixels.iter().zip(b).filter(|(a, b)| (Vec3::from(**a) - **b).abs().max_element() > bound).count()
}

/// Each pixel is the sum over planes whose places a few lines compute: those of the member that its pattern gives it, through a
/// turned box, by a camera of either kind, with voxels of any width.
#[test]
fn pixels_are_the_sums_over_their_members_planes() {
    let (_folder, transfer) = transfer();
    let (side, planes) = (41u32, 13u32);
    for (is_perspective, basis) in [(true, "1x1"), (true, "2x2"), (false, "2x2")] {
        let field = noise([5, 4, 6]);
        let scene = before_a_wall(is_perspective);
        let pattern = patterns::open(&format!("basis:basis={basis},samples=1,effect=volume")).unwrap().pattern;
        let pixels = (0..side).flat_map(|y| (0..side).map(move |x| [x, y]));
        let expected: Vec<Vec3> = pixels
            .map(|pixel| {
                let of_pixel = pattern.samples_of(pixel);
                assert_eq!(of_pixel.len(), 1, "a pixel has a member");
                let offset = if basis == "1x1" { 0.5 } else { of_pixel[0].further[0] };
                sliced(&field, &scene, pixel, side, planes, offset)
            })
            .collect();
        let Voxels::F32(values) = &field.voxels else { unreachable!() };
        let bytes: Vec<u8> = values.iter().map(|value| (255.0 * value).round() as u8).collect();
        let words: Vec<u16> = bytes.iter().map(|byte| 257 * u16::from(*byte)).collect();
        let widths = [
            (Voxels::U8(bytes), [0.0, 255.0]),
            (Voxels::U16(words), [0.0, 65535.0]),
            (field.voxels.clone(), [0.0, 1.0]),
        ];
        for (voxels, range) in widths {
            let held = Volume { voxels, range, hash: format!("{range:?}"), ..field.clone() };
            let watched = Watched::with_scene(scene.clone().holding(&Arc::new(held)));
            let size = format!("{side}x{side}");
            let planes = planes.to_string();
            let own = [
                ("size", size.as_str()),
                ("effect", "volume"),
                ("basis", basis),
                ("samples", "1"),
                ("planes", &planes),
                ("transfer", &transfer),
            ];
            let picture = watched.picture(NAME, &both(PLACED, &own));
            let far = apart(&picture, &expected, 2e-3);
            println!("{is_perspective} {basis} {range:?}: {far} of {} pixels apart", expected.len());
            // Where a plane ends in a pixel, rounding decides whether it is in the sum.
            assert!(far <= 8, "{far}");
            let wall = apart(&picture, &vec![vec3(0.2, 0.3, 0.4); expected.len()], 0.02);
            assert!(wall > 500, "the volume covers {wall} pixels");
        }
    }
}

/// A field of one value is Beer's law, whatever the planes: where a ray passes both faces that planes are parallel to.
#[test]
fn a_field_of_one_value_is_beers_law() {
    let (_folder, transfer) = transfer();
    let mut scene = before_a_wall(true);
    scene.cameras[0] = camera(vec3(0.0, 0.0, 3.0), Vec3::ZERO, 0.3);
    let watched = Watched::with_scene(scene.holding(&Arc::new(volume([3; 3], vec![0.5; 27]))));
    for (planes, summation) in [("1", "plain"), ("7", "plain"), ("60", "plain"), ("60", "hierarchical")] {
        let own = [
            ("size", "21x21"),
            ("effect", "volume"),
            ("planes", planes),
            ("summation", summation),
            ("transfer", &transfer),
            ("volume-length", "1"),
            ("volume-at", "0,0,0"),
            ("volume-density", "0.75"),
            ("basis", "2x2"),
            ("samples", "1"),
            ("rig", "none"),
        ];
        let picture = watched.picture(NAME, &own);
        // The ray through the middle is a metre long in the box.
        let passed = (-0.5 * 0.75 * EXTINCTION).exp();
        let expected = vec3(0.2, 0.3, 0.4) * passed + (1.0 - passed) * 0.5 * Vec3::from(COLOR);
        let middle = Vec3::from(picture.pixels[10 * 21 + 10]);
        assert!((middle - expected).abs().max_element() < 1e-4, "{planes} {summation}: {middle} and {expected}");
    }
}

/// Slices come to the march as planes grow, in proportion to their distance, with a surface within the volume, seen from without
/// and from within; and the march does not depend on its steps any more.
#[test]
fn slices_come_to_the_march() {
    let (_folder, transfer) = transfer();
    let field = Arc::new(noise([6, 6, 6]));
    for (eye, y_fov) in [(vec3(0.5, 0.3, 2.0), 0.6), (vec3(0.1, 0.05, 0.3), 1.0)] {
        let mut scene = before_a_wall(true);
        // It stands at a slant in the left half.
        rectangle(&mut scene, vec3(-0.3, 0.0, 0.0), vec3(0.4, 0.0, 0.2), 0.3 * Vec3::Y, panel(vec3(0.9, 0.2, 0.1)));
        scene.cameras[0] = camera(eye, vec3(0.05, 0.02, 0.0), y_fov);
        let watched = Watched::with_scene(scene.holding(&field));
        let shared = both(PLACED, &[("size", "64x64"), ("transfer", transfer.as_str()), ("volume-density", "0.5")]);
        let paths = |steps: &str| {
            let own = [("transport", "direct"), ("pixel", "middle"), ("spp", "1"), ("volume-steps", steps)];
            watched.picture("path_traced", &both(&shared, &own))
        };
        let reference = paths("16");
        let fine = rmse(&reference, &paths("32"));
        let errors = ["15", "60", "240"].map(|planes| {
            let own = [("effect", "volume"), ("basis", "2x2"), ("samples", "1"), ("planes", planes)];
            rmse(&watched.picture(NAME, &both(&shared, &own)), &reference)
        });
        println!("{eye}: {errors:?}, the march's own steps {fine}");
        assert!(fine < 0.1 * errors[2], "{fine}");
        assert!(errors.windows(2).all(|pair| pair[1] < 0.4 * pair[0]) && errors[2] < 0.004, "{errors:?}");
        let without = watched.picture(NAME, &[("size", "64x64"), ("effect", "aa")]);
        assert!(rmse(&without, &reference) > 20.0 * errors[2], "the volume is seen");
    }
}

/// Whatever moves, wherever the lens and the lights: a volume joins the other effects.
#[test]
fn volumes_join_the_other_effects() {
    let (_folder, transfer) = transfer();
    let scene = crate::support::moving::moving("cornell:motion=on", [0.0, 0.6]).holding(&Arc::new(noise([4, 4, 4])));
    let watched = Watched::with_scene(scene);
    let shared = [
        ("size", "40x40"),
        ("transfer", transfer.as_str()),
        ("volume-length", "2"),
        ("volume-density", "0.5"),
        ("shutter", "0,0.6"),
        ("aperture", "0.2"),
        ("focus", "3"),
        ("emissive", "on"),
    ];
    let paths = [("transport", "direct"), ("ambient-visibility", "off"), ("spp", "512")];
    let reference = watched.picture("path_traced", &both(&shared, &paths));
    let errors = ["2", "32"].map(|samples| {
        let own = [
            ("effect", "aa,motion,defocus,soft-shadow,volume"),
            ("direct-shadow", "ray"),
            ("planes", "40"),
            ("samples", samples),
        ];
        rmse(&watched.picture(NAME, &both(&shared, &own)), &reference)
    });
    println!("{errors:?}");
    assert!(errors[1] < 0.5 * errors[0], "{errors:?}");
}

/// 8 bits round at every plane: what is lost grows with planes, from less than a step of the picture to several at 120
/// (section 3.3). Halves lose less, and less again where planes add up in groups.
#[test]
fn eight_bits_lose_more_with_every_plane() {
    let (_folder, transfer) = transfer();
    let scene = scene::load("specimen", 1).unwrap().holding(&Arc::new(noise([8, 8, 8])));
    let watched = Watched::with_scene(scene);
    let picture = |planes: &str, depth: &str, summation: &str| {
        let own = [
            ("size", "64x64"),
            ("effect", "volume"),
            ("transfer", &transfer),
            ("planes", planes),
            ("depth", depth),
            ("summation", summation),
            ("basis", "2x2"),
            ("samples", "1"),
        ];
        watched.picture(NAME, &own)
    };
    let lost = |planes: &str, depth: &str, summation: &str| {
        255.0 * rmse(&picture(planes, depth, summation), &picture(planes, "float", "plain"))
    };
    let eight = ["20", "60", "120"].map(|planes| lost(planes, "8", "plain"));
    let [half, grouped] = ["plain", "hierarchical"].map(|summation| lost("120", "half", summation));
    let eight_grouped = lost("120", "8", "hierarchical");
    println!("of 255 steps: 8 bits {eight:?}, {eight_grouped} in groups; halves {half}, {grouped} in groups");
    assert!(eight[1] > 1.5 * eight[0] && eight[2] > 1.5 * eight[1] && eight[2] > 1.0, "{eight:?}");
    assert!(half < 0.5 * eight[2] && grouped < half, "{half}, {grouped}");
    assert!(lost("120", "float", "hierarchical") < 1e-3, "an order of floats");
}

/// A volume that is not there, or cannot be drawn, ends with what would work.
#[test]
fn what_cannot_be_sliced_is_refused() {
    let refused = |scene: Scene, technique: &str, changes: Changes<'_>, words: &[&str]| {
        let watched = Watched::with_scene(scene);
        let error = watched.try_renderer(technique, changes, &[], quincunx::gpu::commands::Submits::One).err().unwrap();
        let text = error.to_string();
        assert!(error.exit_code() == 2 && words.iter().all(|word| text.contains(word)), "{text}");
    };
    let load = |spec: &str| scene::load(spec, 1).unwrap();
    let field = Arc::new(noise([3, 3, 3]));
    let sliced = ("effect", "volume");
    refused(load("specimen"), NAME, &[sliced], &["--volume none", "--volume head"]);
    refused(load("fence").holding(&field), NAME, &[sliced], &["BLEND"]);
    refused(
        load("specimen").holding(&field),
        NAME,
        &[sliced, ("volume-window", "3,2")],
        &["--volume-window 3,2", "0 to 1"],
    );
    refused(load("specimen").holding(&field), NAME, &[sliced, ("transfer", "/nowhere")], &["/nowhere"]);
    refused(load("specimen").holding(&field), "path_traced", &[("medium", "0.1,0,0")], &["--medium", "--volume"]);
}
