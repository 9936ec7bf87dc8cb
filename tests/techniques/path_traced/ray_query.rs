//! Ray queries: `path_traced --rays query` beside `--rays tree`, where the driver has them, and the refusal where not.

use crate::support;
use crate::support::Feature;
use crate::support::boxes::{camera, closed_box, panel, point_light, rectangle};
use crate::support::program::Program;
use crate::support::watched::{Changes, Watched, both};
use glam::{Mat4, Vec3, vec3};
use quincunx::picture::Picture;
use quincunx::scene::{AlphaMode, ColorSpace, Image, Material, Sampler, Scene, Texture};

const NAME: &str = "path_traced";
/// Pixels that may differ in any bit: those whose paths hold a ray that grazes an edge, which the driver may see on the other
/// side. Lavapipe of Mesa 25.0.7: none of cornell, of the room below under any of its settings, of AlphaBlendModeTest and of
/// the map kaos, and 1 of 6,144 of the hall with 4 paths a pixel.
const EDGE_PART: f64 = 0.002;

/// Whether there are ray queries to be tested.
fn has_ray_query() -> bool {
    support::has(&support::driver(), Feature::RayQuery)
}

/// The picture by ray queries, after a look at what it was made with.
fn queried(watched: &Watched, changes: Changes<'_>) -> Picture {
    let renderer = watched.render(NAME, &both(changes, &[("rays", "query")]));
    let held: Vec<String> =
        watched.session.gpu.memory.snapshot().resources.into_iter().map(|resource| resource.name).collect();
    for (name, is_held) in [
        ("path_traced.structure.bottom", true),
        ("path_traced.structure.top", true),
        ("path_traced.structure.bottom.scratch", false),
        ("path_traced.structure.bottom.input", false),
        ("path_traced.bvh.nodes", false),
    ] {
        assert_eq!(held.iter().any(|held| held == name), is_held, "{name}: {held:?}");
    }
    renderer.picture().unwrap()
}

fn require_same_but_for_edges(watched: &Watched, changes: Changes<'_>, what: &str) {
    let (found, expected) = (queried(watched, changes), watched.picture(NAME, changes));
    assert!(expected.mean().into_iter().all(|channel| channel > 1e-3), "{what}: nothing to compare");
    let pairs = found.pixels.iter().zip(&expected.pixels);
    let differing = pairs.filter(|(found, expected)| found != expected).count();
    println!("{what} {changes:?}: {differing} of {} pixels differ", found.pixels.len());
    assert!(differing as f64 <= EDGE_PART * found.pixels.len() as f64, "{what} {changes:?}: {differing} pixels differ");
}

/// A closed room of single-sided walls, seen from outside through their backs. In it: a shining panel, a pane of BLEND, a
/// screen of MASK with the holes of a picture, and squares whose draw mirrors them, seen from both sides. Not `is_tested`:
/// pane and screen are opaque.
fn room(is_tested: bool) -> Scene {
    let mut scene = closed_box(&Material::diffuse("wall", vec3(0.7, 0.6, 0.5)));
    scene.images.push(checkered().into());
    scene.textures.push(Texture { image: 0, sampler: Sampler::default(), color_space: ColorSpace::Srgb });
    let mut screen = Material {
        alpha: AlphaMode::Mask { cutoff: 0.5 },
        base_color_texture: Some(0),
        double_sided: true,
        ..Material::diffuse("screen", vec3(0.2, 0.7, 0.3))
    };
    let mut pane = Material { alpha: AlphaMode::Blend, double_sided: true, ..Material::diffuse("pane", Vec3::ONE) };
    pane.base_color.w = 0.4;
    if !is_tested {
        [&mut pane, &mut screen].into_iter().for_each(|material| material.alpha = AlphaMode::Opaque);
    }
    rectangle(&mut scene, 0.95 * Vec3::Y, 0.4 * Vec3::X, 0.4 * Vec3::Z, panel(vec3(6.0, 5.0, 4.0)));
    rectangle(&mut scene, vec3(-0.3, -0.4, 0.2), 0.4 * Vec3::X, 0.5 * Vec3::Y, screen);
    rectangle(&mut scene, vec3(0.4, -0.1, 0.4), vec3(0.4, 0.0, 0.2), 0.6 * Vec3::Y, pane);
    for (x, sign) in [(-0.6, 1.0), (0.6, -1.0)] {
        rectangle(&mut scene, Vec3::ZERO, 0.3 * Vec3::X, sign * 0.3 * Vec3::Y, Material::diffuse("mirrored", Vec3::X));
        let draw = scene.draws.last_mut().unwrap();
        draw.world_from_object = Mat4::from_translation(vec3(x, 0.4, -0.5)) * Mat4::from_scale(vec3(-1.0, 1.0, 1.0));
    }
    scene.lights.push(point_light(vec3(0.5, 0.6, 0.5), 0.5));
    scene.cameras.push(camera(vec3(1.5, 1.0, 4.0), Vec3::ZERO, 0.7));
    scene
}

/// Squares of alpha 255 and 0.
fn checkered() -> Image {
    let texel = |at: u32| [255, 255, 255, if (at % 8 + at / 8).is_multiple_of(2) { 255 } else { 0 }];
    Image { name: "holes".to_owned(), width: 8, height: 8, rgba8: (0..64).flat_map(texel).collect() }
}

#[test]
fn pictures_are_the_tree_s_but_for_rays_that_graze_edges() {
    if !has_ray_query() {
        return;
    }
    let common = [("size", "96x64"), ("spp", "4")];
    require_same_but_for_edges(&Watched::open("cornell"), &common, "cornell");
    require_same_but_for_edges(&Watched::open("hall:triangles=8000"), &common, "hall");
}

/// Alpha, backs and mirrored draws are decided in the shader, for paths, shadow rays, light walks and in a medium.
#[test]
fn alpha_and_backs_are_asked_about_as_in_the_tree() {
    if !has_ray_query() {
        return;
    }
    let common = [("size", "64x48"), ("spp", "4"), ("background", "0.1")];
    require_same_but_for_edges(&Watched::with_scene(room(false)), &common, "the opaque room");
    let watched = Watched::with_scene(room(true));
    let settings: [Changes<'_>; 4] = [
        &[],
        &[("emissive", "on"), ("aperture", "0.1"), ("focus", "3")],
        &[("vpl-visibility", "off"), ("transport", "one-bounce")],
        &[("medium", "0.1,0.05,0.3")],
    ];
    for changes in settings {
        require_same_but_for_edges(&watched, &both(&common, changes), "the room");
    }
}

#[test]
fn real_scenes_are_the_tree_s_but_for_rays_that_graze_edges() {
    if !has_ray_query() {
        return;
    }
    let Some(folder) = support::shared_scenes() else { return };
    for (file, size) in [("maps/kaos.glb", "96x54"), ("samples/AlphaBlendModeTest/AlphaBlendModeTest.gltf", "96x54")] {
        let watched = Watched::open(folder.join(file).to_str().unwrap());
        require_same_but_for_edges(&watched, &[("size", size), ("spp", "2"), ("rig", "always")], file);
    }
}

#[test]
fn a_device_without_ray_queries_says_what_works() {
    let program = Program::new();
    let query = ["render", "cornell", "--technique", "path_traced", "--size", "8x8", "--spp", "1", "--rays", "query"];
    let driver = support::driver();
    let lack = "--rays query needs VK_KHR_ray_query with VK_KHR_acceleration_structure";
    let listed = program.run(&["devices"]).fine().out;
    assert_eq!(listed.contains(lack), !driver.features.ray_query, "{listed}");
    if driver.features.ray_query {
        program.run(&query).fine();
    } else {
        program.fails(&query, 3, &[lack, driver.identity.driver_text(), "--rays tree"]);
    }
}

/// Structures stand still.
#[test]
fn what_moves_while_a_shutter_is_open_is_refused() {
    if !has_ray_query() {
        return;
    }
    let opening = Scene { hash: "opening".to_owned(), ..room(true) };
    let mut closing = Scene { hash: "closing".to_owned(), ..opening.clone() };
    closing.draws[7].world_from_object = Mat4::from_translation(0.1 * Vec3::X);
    let watched = Watched::with_scene(opening.closing_as(closing).unwrap());
    let made = |rays| {
        let changes = [("size", "8x8"), ("spp", "1"), ("rays", rays)];
        watched.try_renderer(NAME, &changes, &[], quincunx::gpu::commands::Submits::One).map(|_| ())
    };
    made("tree").unwrap();
    let error = made("query").unwrap_err();
    assert_eq!(error.exit_code(), 2);
    assert!(error.to_string().contains("--shutter") && error.to_string().contains("--rays tree"), "{error}");
}
