//! `--trace host`: the estimate of the host's threads against that of the shaders, whatever the number of threads.

use super::{CORNELL, EXTENT, NAME};
use crate::support::boxes::{camera, point_light, rectangle};
use crate::support::program::Program;
use crate::support::shared_scenes;
use crate::support::watched::{Changes, Watched, both};
use glam::{Mat4, Vec3, vec3};
use quincunx::gpu::commands::Submits;
use quincunx::gpu::timing::Clock;
use quincunx::scene::{self, AlphaMode, ColorSpace, Image, Material, Projection, Sampler, Scene, Texture};
use quincunx::session::Renderer;

const COMPONENTS: [&str; 4] = ["id", "ss", "pm", "ao"];
/// Each component has something to estimate, and each pixel of a tile of four a subset in each iteration.
const ALL: [(&str, &str); 4] =
    [("components", "id,ss,pm,ao"), ("medium", "0.2,0.05,0.4"), ("ambient", "0.1"), ("id-max", "4")];
/// A half float's last place, twice: what rounding turns is one step of it, and drivers may cut where others round.
const HALF_STEPS: f32 = 1e-3;

/// A frame by the host and one by the device, whose stages of these names can be read.
fn host_and_device(watched: &Watched, changes: Changes<'_>, stages: &[String]) -> [Renderer; 2] {
    let stages: Vec<&str> = stages.iter().map(String::as_str).collect();
    ["host", "device"].map(|trace| watched.render_stages(NAME, &both(changes, &[("trace", trace)]), &stages))
}

/// Texels whose value differs by more than the steps of a half float.
fn differing(host: &[[f32; 3]], device: &[[f32; 3]]) -> usize {
    let is_off = |(host, device): &(&[f32; 3], &[f32; 3])| {
        let (host, device) = (Vec3::from_array(**host), Vec3::from_array(**device));
        (host - device).abs().max_element() > HALF_STEPS * device.max_element() + 1e-6
    };
    host.iter().zip(device).filter(is_off).count()
}

fn share(count: usize) -> f64 {
    count as f64 / EXTENT.pixel_count() as f64
}

/// What stands for it under a bound of software drivers where each shader rounds for itself: on an H200 79 of 5141 values of the
/// first setting are others and 153 of the second one's, of the rays as few as on processors.
fn rounded_share(watched: &Watched, count: usize) -> f64 {
    if watched.session.gpu.caps.identity.is_software() { share(count) } else { share(count) / 4.0 }
}

/// Every component in every mode, in three sizes of tiles. A ray that grazes an edge, or begins on another side of one, may
/// be stopped on one side and not on the other: it makes another value, and in a tile that it guides other iterations of all
/// pixels. Such rays are few.
#[test]
fn the_host_estimates_what_the_device_does() {
    let watched = Watched::open("cornell");
    for tile in ["2x2", "3x3", "4x2"] {
        for mode in ["adaptive", "max", "igi"] {
            let what = |of: &str| COMPONENTS.map(|key| of.replace("KEY", key));
            let mut stages = [what("irradiance.KEY"), what("rays.KEY")].concat();
            if mode != "igi" {
                stages.extend(what("guidance.KEY.iterations"));
            }
            let changes = both(&both(&CORNELL, &ALL), &[("tile", tile), ("mode", mode)]);
            let renderers = host_and_device(&watched, &changes, &stages);
            for key in COMPONENTS {
                let name = format!("{tile} {mode} {key}");
                let [host, device] =
                    renderers.each_ref().map(|renderer| watched.rgb(renderer, &format!("irradiance.{key}")));
                assert!(device.iter().any(|texel| *texel != [0.0; 3]), "{name}: nothing is estimated");
                let stage = |stage: String| renderers.each_ref().map(|renderer| watched.integers(renderer, &stage));
                let [host_rays, device_rays] = stage(format!("rays.{key}"));
                let other_rays: u32 =
                    host_rays.iter().zip(&device_rays).map(|(host, device)| host.abs_diff(*device)).sum();
                let other_rays = f64::from(other_rays) / f64::from(device_rays.iter().sum::<u32>());
                let iterations = if mode == "igi" {
                    0
                } else {
                    let [host, device] = stage(format!("guidance.{key}.iterations"));
                    host.iter().zip(&device).filter(|(host, device)| host != device).count()
                };
                let values = differing(&host, &device);
                println!("{name}: {values} values, {other_rays} of the rays and {iterations} iterations are others");
                assert!(rounded_share(&watched, values) < 0.01, "{name}: {values} values are others");
                // A virtual light in the plane of a surface may be before or behind it, and gives it nothing.
                assert!(other_rays < 0.01, "{name}: {other_rays} of the rays are others");
                assert!(share(iterations) < 0.01, "{name}: {iterations} pixels have other iterations");
            }
            let [host, device] = renderers.each_ref().map(|renderer| renderer.measured_counters().unwrap());
            for key in COMPONENTS {
                for what in ["rays", "iterations", "tiles_refined"] {
                    let [host, device] = [&host, &device].map(|counters| counters[&*format!("{what}_{key}")]);
                    assert!((host - device).abs() <= 0.02 * device, "{tile} {mode} {what}_{key}: {host} {device}");
                }
            }
        }
    }
}

/// Pixels of reduced components, positions as every storage rounds them, several initial iterations, the paper's guidance.
#[test]
fn other_settings_mean_the_same_to_both() {
    let watched = Watched::open("cornell");
    for own in [
        &[("id-scale", "2"), ("tile", "3x3")][..],
        &[("id-scale", "3"), ("tile", "2x2"), ("position", "unorm16")],
        &[("position", "half"), ("tile", "3x2")],
        &[("position", "depth"), ("tile", "2x3")],
        &[("base", "3"), ("ss-guidance", "mean"), ("tile", "5x3")],
        &[("light-radius", "0.2"), ("tile", "3x3")],
        &[("until-error", "0.1"), ("tile", "3x2")],
        &[("id-choice", "contribution"), ("tile", "3x3")],
    ] {
        let stages = COMPONENTS.map(|key| format!("irradiance.{key}"));
        let renderers = host_and_device(&watched, &both(&both(&CORNELL, &ALL), own), &stages);
        for stage in &stages {
            let [host, device] = renderers.each_ref().map(|renderer| watched.rgb(renderer, stage));
            let values = differing(&host, &device);
            println!("{own:?} {stage}: {values} are others");
            // Read back from the depth buffer, positions are off by more than interpolated ones.
            let bound = if own.contains(&("position", "depth")) { 0.03 } else { 0.015 };
            assert!(rounded_share(&watched, values) < bound, "{own:?} {stage}: {values} are others");
        }
    }
}

/// A screen of which every other square is a hole, mirrored by its draw and seen from behind, before a wall: what rays see
/// through it, and that its side is turned to the eye.
#[test]
fn holes_and_backs_are_seen_as_the_device_sees_them() {
    let mut scene = Scene { name: "screen".to_owned(), hash: "screen".to_owned(), ..Scene::default() };
    rectangle(&mut scene, vec3(0.0, 0.0, -1.0), 3.0 * Vec3::X, 3.0 * Vec3::Y, Material::diffuse("wall", Vec3::ONE));
    let squares: Vec<u8> =
        (0..64).flat_map(|at| [255, 255, 255, if (at / 8 + at) % 2 == 0 { 255 } else { 0 }]).collect();
    scene.images.push(Image { name: String::new(), width: 8, height: 8, rgba8: squares }.into());
    let sampler = Sampler { mag_linear: false, ..Sampler::default() };
    scene.textures.push(Texture { image: 0, sampler, color_space: ColorSpace::Srgb });
    let alpha = AlphaMode::Mask { cutoff: 0.5 };
    let grey = Material::diffuse("screen", Vec3::splat(0.5));
    let screen = Material { base_color_texture: Some(0), alpha, double_sided: true, ..grey };
    rectangle(&mut scene, Vec3::ZERO, Vec3::X, -Vec3::Y, screen);
    scene.draws[1].world_from_object = Mat4::from_rotation_y(0.4) * Mat4::from_scale(vec3(-1.0, 1.0, 1.0));
    scene.lights.push(point_light(vec3(1.0, 0.5, 2.5), 9.0));
    scene.cameras.push(camera(vec3(0.2, 0.3, 3.0), Vec3::ZERO, 0.8));
    let watched = Watched::with_scene(scene);
    let own = [("components", "ss,ao"), ("ambient", "0.2"), ("size", "97x53"), ("position", "float")];
    let stages = ["irradiance.ss", "irradiance.ao"].map(str::to_owned);
    let renderers = host_and_device(&watched, &own, &stages);
    for stage in &stages {
        let [host, device] = renderers.each_ref().map(|renderer| watched.rgb(renderer, stage));
        let values = differing(&host, &device);
        println!("{stage}: {values} are others");
        assert!(share(values) < 0.01, "{stage}: {values} are others");
    }
}

/// What is behind the estimates is the device's, and blended surfaces with it: pictures agree as the estimates do. The walls
/// have normal maps, of which the device shows the mean of many texels: bumps in which light is lost or caught.
#[test]
fn glass_is_that_of_the_device() {
    let watched = Watched::open("fence:lights=6");
    let picture = |trace, own: Changes<'_>| {
        let changes = both(&[("size", "97x53"), ("trace", trace), ("position", "float")], own);
        watched.picture(NAME, &changes)
    };
    for own in [&[][..], &[("components", "ss")]] {
        let (host, device) = (picture("host", own), picture("device", own));
        let mean = |pixels: &[[f32; 3]]| pixels.as_flattened().iter().sum::<f32>() / pixels.len() as f32;
        let [host_mean, device_mean] = [&host, &device].map(|picture| mean(&picture.pixels));
        let apart = host.pixels.iter().zip(&device.pixels).filter(|(host, device)| {
            (0..3).any(|channel| (host[channel] - device[channel]).abs() > 0.1 * device[channel] + 0.01)
        });
        let apart = share(apart.count());
        println!("{own:?}: means {host_mean} and {device_mean}, {apart} apart");
        assert!((host_mean / device_mean - 1.0).abs() < 0.03, "{own:?}: {host_mean} and {device_mean}");
        assert!(apart < 0.03, "{own:?}: {apart}");
    }
}

/// The host's part is done anew in each frame, and its passes are told with their times; those of the device that it stands
/// for are not there.
#[test]
fn each_frame_has_the_host_s_passes() {
    let watched = Watched::open("cornell");
    let changes = both(&both(&CORNELL, &ALL), &[("trace", "host"), ("tile", "2x2")]);
    let renderer = watched.try_renderer(NAME, &changes, &[], Submits::PerPass).unwrap();
    let names = ["hit", "sample.id", "sample.ss", "sample.pm", "sample.ao"].map(|name| format!("{NAME}.{name}"));
    let mut hashes = Vec::new();
    for _ in 0..2 {
        let time = renderer.frame().unwrap();
        let told: Vec<&str> = time.host.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(told, names);
        let host_ns: u64 = time.host.iter().map(|(_, ns)| ns).sum();
        assert!(time.host.iter().all(|(_, ns)| *ns > 0));
        assert_eq!(time.figure_ns(Clock::Wall), host_ns + time.wall_ns);
        assert_eq!(time.figure_ns(Clock::Timestamps), host_ns + time.device_ns.unwrap_or(time.wall_ns));
        hashes.push(renderer.picture().unwrap().hash().unwrap());
    }
    assert_eq!(hashes[0], hashes[1]);
    let passes: Vec<&str> = renderer.passes().iter().map(|pass| &pass.name[NAME.len() + 1..]).collect();
    let uploads = COMPONENTS.map(|key| format!("upload.{key}"));
    let before: Vec<&str> = ["gbuffer"].into_iter().chain(uploads.iter().map(String::as_str)).collect();
    assert_eq!(passes[..5], before);
    assert_eq!(passes[5], "discontinuity");
    assert!(!renderer.measured_counters().unwrap().contains_key("lanes_idle_id"), "the host has no lanes");
}

/// Threads share no sum: with one or four of them, and once more, the same bytes.
#[test]
fn the_number_of_threads_changes_no_byte() {
    let program = Program::new();
    let stages = "irradiance.id,irradiance.ss,irradiance.pm,irradiance.ao,rays.id,guidance.ss,guidance.pm.iterations";
    let hashes = ["1", "4", "4"].map(|threads| {
        let mut arguments = vec!["render", "cornell", "--technique", NAME, "--trace", "host", "--size", "97x53"];
        arguments.extend(["--emissive", "on", "--components", "id,ss,pm,ao", "--medium", "0.2,0.05,0.4"]);
        arguments.extend(["--ambient", "0.1", "-o", "it.png", "--aov", stages, "--report", "it.json"]);
        program.run_with(&arguments, &[("RAYON_NUM_THREADS", threads)]).fine();
        let text = std::fs::read_to_string(program.path("it.json")).unwrap();
        let report: serde_json::Value = serde_json::from_str(&text).unwrap();
        let host_passes = report["passes"].as_array().unwrap().iter().filter(|pass| pass["where"] == "host");
        assert_eq!(host_passes.filter(|pass| pass["ms"]["median"].as_f64().unwrap() > 0.0).count(), 5);
        let of_stages: Vec<String> =
            report["aovs"].as_array().unwrap().iter().map(|aov| aov["hash"].to_string()).collect();
        assert_eq!(of_stages.len(), 7);
        (report["image"]["hash"].to_string(), of_stages)
    });
    assert_eq!(hashes[0], hashes[1]);
    assert_eq!(hashes[1], hashes[2]);
}

/// Ctrl-C in the middle of what would take the host minutes.
#[cfg(target_os = "linux")]
#[test]
fn an_interrupt_ends_the_host_s_work() {
    let program = Program::new();
    let started = std::time::Instant::now();
    let mut arguments = vec!["render", "cornell", "--technique", NAME, "--trace", "host", "--size", "1920x1080"];
    arguments.extend(["--emissive", "on", "--mode", "max", "--id-scale", "1", "--vpls", "65536", "-o", "it.png"]);
    // The device and the scene are there by then.
    let (code, said) = program.interrupted(&arguments, || started.elapsed().as_secs() >= 4);
    assert_eq!(code, Some(130), "{said}");
    assert!(said.contains("interrupted"), "{said}");
    assert!(!std::path::Path::new(&program.path("it.png")).exists());
}

/// A normal map whose texels are larger than pixels: there the finest level is what the device reads too. Without the map
/// the light is another.
#[test]
fn a_normal_map_turns_the_host_s_normals_as_the_device_s() {
    let Some(folder) = shared_scenes() else { return };
    let file = folder.join("samples/DamagedHelmet/DamagedHelmet.gltf");
    let close = |has_map: bool| {
        let mut scene = scene::load(file.to_str().unwrap(), 1).unwrap();
        let (center, diagonal) = (scene.bounds().center(), scene.bounds().diagonal());
        let mut close = camera(center + diagonal * Vec3::new(0.3, 0.2, 1.0), center, 0.03);
        close.projection = Projection::Perspective { y_fov: 0.03, aspect: None, z_near: 0.01, z_far: None };
        scene.cameras = vec![close];
        if !has_map {
            scene.hash.push_str(" without maps");
            scene.materials.iter_mut().for_each(|material: &mut Material| material.normal_texture = None);
        }
        scene
    };
    let stages = ["irradiance.ss", "irradiance.ao"].map(str::to_owned);
    let own = [("size", "97x53"), ("components", "ss,ao"), ("ambient", "0.2"), ("mode", "max"), ("position", "float")];
    let both_of = |scene: Scene| {
        let watched = Watched::with_scene(scene);
        let renderers = host_and_device(&watched, &own, &stages);
        stages.each_ref().map(|stage| renderers.each_ref().map(|renderer| watched.rgb(renderer, stage)))
    };
    let (mapped, plain) = (both_of(close(true)), both_of(close(false)));
    for ((stage, [host, device]), [plain, _]) in stages.iter().zip(&mapped).zip(&plain) {
        let apart = |one: &[[f32; 3]], other: &[[f32; 3]]| {
            let off = |(a, b): (&[f32; 3], &[f32; 3])| (Vec3::from_array(*a) - Vec3::from_array(*b)).length();
            let sum = |values: &[[f32; 3]]| values.iter().map(|value| Vec3::from_array(*value).length()).sum::<f32>();
            one.iter().zip(other).map(off).sum::<f32>() / sum(other)
        };
        let (rounding, of_map) = (apart(host, device), apart(plain, device));
        println!("{stage}: {} are others, {rounding} apart, without the map {of_map}", differing(host, device));
        assert!(rounding < 0.01 && rounding < 0.2 * of_map, "{stage}: {rounding}, without the map {of_map}");
    }
}
