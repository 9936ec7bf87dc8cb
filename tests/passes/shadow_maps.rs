//! Shadow maps against shadow rays: the nearer the more texels a map has; dark where light cannot come, and the same bits
//! as unshadowed light where nothing is between; the plain ways give the same.

use crate::support;
use crate::support::boxes::{camera, closed_box, rectangle};
use crate::support::choices::words;
use crate::support::difference::require_same;
use crate::support::moving::moving;
use crate::support::watched::{Changes, Watched, both};
use glam::{Vec3, Vec4, vec3};
use quincunx::gpu::commands::Submits;
use quincunx::job::Job;
use quincunx::picture::Picture;
use quincunx::scene::{AlphaMode, ColorSpace, Image, Light, LightKind, Material, Sampler, Scene, Texture, Wrap};
use quincunx::techniques;

const FORWARD: &str = "forward";
/// One matt reflection, no light but the scene's.
const PLAIN: Changes<'_> = &[("size", "96x96"), ("rig", "none"), ("brdf", "lambert")];
const RAY: (&str, &str) = ("direct-shadow", "ray");
const MAP: (&str, &str) = ("direct-shadow", "map");
const NONE: (&str, &str) = ("direct-shadow", "none");

/// Part of the pixels in which two pictures differ by more than a twentieth of the brighter pixel and of a tenth of
/// the mean.
fn differing(a: &Picture, b: &Picture) -> f64 {
    let brightness = |pixel: &[f32; 3]| f64::from(pixel.iter().sum::<f32>()) / 3.0;
    let floor = b.pixels.iter().map(brightness).sum::<f64>() / b.pixels.len() as f64 / 10.0;
    let differs = |(a, b): (&[f32; 3], &[f32; 3])| {
        let [a, b] = [a, b].map(brightness);
        (a - b).abs() > 0.05 * (a.max(b) + floor)
    };
    a.pixels.iter().zip(&b.pixels).filter(|pair| differs(*pair)).count() as f64 / a.pixels.len() as f64
}

fn gray() -> Material {
    Material { double_sided: true, ..Material::diffuse("gray", Vec3::splat(0.5)) }
}

fn light(kind: LightKind, position: Vec3, direction: Vec3) -> Light {
    Light { name: String::new(), kind, intensity: Vec3::splat(20.0), position, direction, range: None, radius: 0.0 }
}

fn spot(degrees: f32, position: Vec3, direction: Vec3) -> Light {
    let outer_angle = degrees.to_radians();
    light(LightKind::Spot { inner_angle: 0.8 * outer_angle, outer_angle }, position, direction.normalize())
}

/// A floor of 8 x 8 m under a square of 1 m side at a height of 1 m, seen from above beside it.
fn table(top: Material, lights: Vec<Light>) -> Scene {
    let mut scene = Scene { name: "table".to_owned(), lights, ..Scene::default() };
    rectangle(&mut scene, Vec3::ZERO, 4.0 * Vec3::X, -4.0 * Vec3::Z, gray());
    rectangle(&mut scene, Vec3::Y, 0.5 * Vec3::X, -0.5 * Vec3::Z, top);
    scene.cameras.push(camera(vec3(0.0, 6.0, 5.0), Vec3::ZERO, 0.9));
    scene
}

/// The bounds are what was measured on lavapipe and half as much again. What stays is the terminator of coarse facets, which
/// rays show and texels blur, and edges that a pixel shows on the other side.
#[test]
fn larger_maps_come_nearer_to_rays() {
    for (scene, bounds) in [
        ("lamps:objects=20,lights=6", [0.11, 0.03, 0.01]),
        ("hall:triangles=8000", [0.41, 0.18, 0.076]),
        ("fence:lights=12", [0.11, 0.055, 0.021]),
    ] {
        let watched = Watched::open(scene);
        let common = [("size", "161x91"), ("sun", "on")];
        let rays = watched.picture(FORWARD, &both(&common, &[RAY]));
        let shares = ["32", "128", "512"]
            .map(|size| differing(&watched.picture(FORWARD, &both(&common, &[MAP, ("shadow-map-size", size)])), &rays));
        let unshadowed = differing(&watched.picture(FORWARD, &both(&common, &[NONE])), &rays);
        println!("{scene}: {shares:?} of the pixels differ, {unshadowed} without shadows");
        assert!(shares[0] > shares[1] && shares[1] > shares[2], "{scene}: {shares:?}");
        assert!(shares.iter().zip(bounds).all(|(share, bound)| *share < bound), "{scene}: {shares:?}");
        assert!(unshadowed > 4.0 * shares[2], "{scene}: {unshadowed} without shadows, {shares:?} with");
    }
}

/// Where nothing is between, light arrives to the bit (but for rounding, where each shader rounds for itself); where all of a filter's
/// texels are in shadow, none does.
#[test]
fn every_kind_of_light_casts_its_shadow_and_no_other() {
    let above = vec3(0.7, 3.0, 0.4);
    for (what, one) in [
        ("a directional light", light(LightKind::Directional, Vec3::ZERO, vec3(-0.4, -1.0, -0.2).normalize())),
        ("a point light", light(LightKind::Point, above, -Vec3::Y)),
        ("a spot", spot(50.0, above, -above)),
        ("a spot of 90 degrees", spot(90.0, above, -above)),
        ("a point light that ends", Light { range: Some(6.0), ..light(LightKind::Point, above, -Vec3::Y) }),
        ("a point light outside", light(LightKind::Point, vec3(6.0, 9.0, 1.0), -Vec3::Y)),
    ] {
        let watched = Watched::with_scene(table(gray(), vec![one]));
        let [plain, rays, maps] = [NONE, RAY, MAP].map(|shadow| watched.picture(FORWARD, &both(PLAIN, &[shadow])));
        let is_dark = |picture: &Picture, index: usize| picture.pixels[index] == [0.0; 3];
        let brightest = plain.pixels.iter().flatten().fold(0f32, |most, channel| most.max(*channel));
        let rounding = if watched.session.gpu.caps.identity.is_software() { 0.0 } else { 1e-5 * brightest };
        let is_same = |a: &[f32; 3], b: &[f32; 3]| (0..3).all(|side| (a[side] - b[side]).abs() <= rounding);
        let (mut lit, mut dark, mut between, mut wrong) = (0, 0, 0, 0);
        for index in (0..plain.pixels.len()).filter(|index| !is_dark(&plain, *index)) {
            let (is_shadow, is_light) = (is_dark(&maps, index), is_same(&maps.pixels[index], &plain.pixels[index]));
            lit += usize::from(is_light);
            dark += usize::from(is_shadow);
            between += usize::from(!is_light && !is_shadow);
            wrong += usize::from((is_light || is_shadow) && is_shadow != is_dark(&rays, index));
        }
        println!("{what}: {lit} lit, {dark} dark, {between} between, {wrong} not as by rays");
        assert!(lit > 1000 && dark > 60, "{what}: {lit} lit, {dark} dark");
        assert!(between < 60 && wrong < 20, "{what}: {between} between, {wrong} not as by rays");
        let differing = differing(&maps, &rays);
        assert!(differing < 0.005, "{what}: {differing}");
    }
}

/// A lamp in the middle of a room with plates around it whose shadows go over the edges between the faces of its cube.
#[test]
fn the_faces_of_a_cube_meet() {
    let mut scene = closed_box(&gray());
    scene.lights.push(light(LightKind::Point, vec3(0.05, -0.1, 0.02), -Vec3::Y));
    let plates = [vec3(0.3, 0.3, 0.02), vec3(-0.3, 0.28, 0.3), vec3(0.02, -0.4, -0.3), vec3(-0.35, -0.3, 0.3)];
    for center in plates {
        let u = center.any_orthonormal_vector();
        rectangle(&mut scene, center, 0.06 * u, 0.1 * center.normalize().cross(u), gray());
    }
    for target in [Vec3::X, -Vec3::X, Vec3::Y, -Vec3::Y, Vec3::Z, -Vec3::Z] {
        let eye = -0.9 * target + vec3(0.01, 0.02, 0.03);
        let mut seen = scene.clone();
        seen.cameras.push(camera(eye, eye + target, 1.6));
        let watched = Watched::with_scene(seen);
        let [rays, maps, plain] = [RAY, MAP, NONE].map(|shadow| watched.picture(FORWARD, &both(PLAIN, &[shadow])));
        let (differing, unshadowed) = (differing(&maps, &rays), differing(&plain, &rays));
        println!("towards {target}: {differing} differ, {unshadowed} without shadows");
        assert!(differing < 0.012 && unshadowed > 4.0 * differing, "{target}: {differing} {unshadowed}");
    }
}

/// A room inside of another, the walls between them half a metre thick, and lights outside. Exactly no light comes in where
/// walls are thicker than the texels that surfaces are pushed away by: those of the spot are 14 cm wide at 128.
#[test]
fn no_light_comes_through_a_thick_wall() {
    let mut scene = closed_box(&gray());
    for (out, u) in [(Vec3::X, Vec3::Y), (Vec3::Y, Vec3::Z), (Vec3::Z, Vec3::X)] {
        for out in [out, -out] {
            rectangle(&mut scene, 1.5 * out, 1.5 * u, 1.5 * out.cross(u), gray());
        }
    }
    scene.lights.push(light(LightKind::Point, vec3(2.2, 1.9, 1.7), -Vec3::Y));
    scene.lights.push(light(LightKind::Point, vec3(0.1, 1.6, 0.0), -Vec3::Y));
    scene.lights.push(spot(70.0, vec3(-2.0, 2.5, 0.3), vec3(1.0, -1.0, 0.0)));
    scene.lights.push(light(LightKind::Directional, Vec3::ZERO, vec3(0.3, -1.0, 0.9).normalize()));
    scene.cameras.push(camera(vec3(0.8, 0.8, 0.8), vec3(-1.0, -1.0, -1.0), 1.8));
    let watched = Watched::with_scene(scene);
    assert!(watched.picture(FORWARD, &both(PLAIN, &[NONE])).mean()[0] > 0.01, "it would be light without shadows");
    for size in ["128", "1024"] {
        for filter in ["nearest", "gather"] {
            let changes = both(PLAIN, &[MAP, ("shadow-map-size", size), ("shadow-filter", filter)]);
            let picture = watched.picture(FORWARD, &changes);
            let lit = picture.pixels.iter().filter(|pixel| **pixel != [0.0; 3]).count();
            assert_eq!(lit, 0, "pixels with light at {size}, {filter}");
        }
    }
}

/// A table top whose right half alpha cuts away, by a texture and by the colours of its corners: half the shadow.
#[test]
fn masked_surfaces_cast_the_shadow_of_what_is_left() {
    let lamp = || vec![light(LightKind::Point, vec3(0.0, 4.0, 0.0), -Vec3::Y)];
    let mask = AlphaMode::Mask { cutoff: 0.5 };
    let mut textured = table(Material { alpha: mask, base_color_texture: Some(0), ..gray() }, lamp());
    let image = Image { name: String::new(), width: 2, height: 1, rgba8: vec![255, 255, 255, 255, 255, 255, 255, 0] };
    textured.images.push(image.into());
    let edge = Wrap::ClampToEdge;
    let sampler = Sampler { wrap_u: edge, wrap_v: edge, mag_linear: false, min_linear: false, mip_linear: None };
    textured.textures.push(Texture { image: 0, sampler, color_space: ColorSpace::Srgb });
    let mut colored = table(Material { alpha: mask, ..gray() }, lamp());
    colored.meshes[1].colors = [1.0, 0.0, 0.0, 1.0].map(|alpha| Vec4::new(1.0, 1.0, 1.0, alpha)).to_vec();
    let shadow = |scene: Scene, changes: Changes<'_>| {
        let watched = Watched::with_scene(scene);
        let picture = |shadow| watched.picture(FORWARD, &both(PLAIN, &both(&[shadow], changes)));
        let (plain, maps) = (picture(NONE), picture(MAP));
        let dark = |index: &usize| maps.pixels[*index] == [0.0; 3] && plain.pixels[*index] != [0.0; 3];
        (0..plain.pixels.len()).filter(dark).map(|index| index % 96).collect::<Vec<_>>()
    };
    let whole = shadow(table(gray(), lamp()), &[]).len() as f64;
    for (what, scene) in [("a texture", textured), ("colours of corners", colored)] {
        let columns = shadow(scene, &[]);
        let part = columns.len() as f64 / whole;
        assert!((part - 0.5).abs() < 0.1, "{what} leaves {part} of the shadow");
        assert!(columns.iter().all(|column| *column <= 48), "{what}: the shadow of the half that is there");
    }
}

/// A pane that blends is lit through no other surface, and itself casts nothing.
#[test]
fn blended_surfaces_are_in_shadow_and_cast_none() {
    let lamp = vec![light(LightKind::Point, vec3(0.0, 4.0, 0.0), -Vec3::Y)];
    let glass = Material { alpha: AlphaMode::Blend, base_color: Vec4::new(0.8, 0.8, 0.8, 0.5), ..gray() };
    let alone = Watched::with_scene(table(glass.clone(), lamp.clone()));
    let [plain, maps] = [NONE, MAP].map(|shadow| alone.picture(FORWARD, &both(PLAIN, &[shadow])));
    require_same(&alone.session.gpu, &maps, &plain, &"glass casts nothing");
    let mut scene = table(glass, lamp);
    rectangle(&mut scene, vec3(0.25, 2.0, 0.0), 0.2 * Vec3::X, -0.2 * Vec3::Z, gray());
    let watched = Watched::with_scene(scene);
    for lists in words(FORWARD, "light-lists") {
        let picture = |shadow| watched.picture(FORWARD, &both(PLAIN, &[shadow, ("light-lists", lists)]));
        let (plain, rays, maps) = (picture(NONE), picture(RAY), picture(MAP));
        let (unshadowed, mapped) = (differing(&plain, &rays), differing(&maps, &rays));
        println!("{lists}: {mapped} differ, {unshadowed} without shadows");
        assert!(unshadowed > 0.005 && mapped < 0.005, "{lists}: {unshadowed} {mapped}");
    }
}

#[test]
fn leaving_casters_out_changes_no_pixel() {
    for (scene, changes) in [
        ("lamps:objects=20,lights=3", &[][..]),
        ("hall:triangles=8000", &[]),
        ("fence:alpha=mask,lights=9", &[]),
        ("cornell", &[("lights", "3")]),
    ] {
        let watched = Watched::open(scene);
        let common = [("size", "161x91"), ("shadow-map-size", "128"), MAP];
        let common = both(&common, changes);
        let [culled, all] = ["culled", "all"].map(|casters| {
            let renderer = watched.render(FORWARD, &both(&common, &[("shadow-casters", casters)]));
            (renderer.picture().unwrap().hash().unwrap(), renderer.counters["shadow_map_triangles_drawn"])
        });
        assert_eq!(culled.0, all.0, "{scene}");
        assert!(culled.1 < 0.9 * all.1, "{scene}: {} of {} triangles", culled.1, all.1);
    }
}

/// The device's filter weighs four comparisons with a few bits, the shader with floats: they differ in nothing else.
#[test]
fn four_comparisons_are_the_same_in_the_sampler_and_in_the_shader() {
    let watched = Watched::open("lamps:objects=20,lights=6");
    let common = [("size", "161x91"), ("shadow-map-size", "128"), MAP];
    let filtered = |filter| watched.render(FORWARD, &both(&common, &[("shadow-filter", filter)]));
    let has_filter = watched.session.gpu.caps.formats.float_depth_linear;
    let by_default = watched.render(FORWARD, &common);
    assert_eq!(by_default.resolved["shadow-filter"], if has_filter { "bilinear" } else { "gather" });
    let (gathered, nearest) = (filtered("gather").picture().unwrap(), filtered("nearest").picture().unwrap());
    let apart = differing(&gathered, &nearest);
    assert!(apart > 0.002, "one comparison is not four: {apart}");
    if !has_filter {
        let refused =
            watched.try_renderer(FORWARD, &both(&common, &[("shadow-filter", "bilinear")]), &[], Submits::One);
        assert_eq!(refused.err().expect("depth does not filter here").exit_code(), 3);
        return;
    }
    let most = support::difference::greatest_part(&filtered("bilinear").picture().unwrap(), &gathered);
    assert!(most < 0.02, "{most} of a pixel");
}

/// A submit a pass, bytes of their own, several samples, several runs, no pre-pass.
#[test]
fn submits_and_shared_bytes_change_no_pixel() {
    let watched = Watched::open("hall:triangles=8000");
    let common = [("size", "97x53"), ("shadow-map-size", "64"), MAP];
    for more in
        [&[][..], &[("msaa", "4")], &[("supersample", "2")], &[("depth-prepass", "off"), ("light-lists", "none")]]
    {
        let changes = both(&common, more);
        let hash = watched.hash(FORWARD, &changes);
        let apart = watched.render_as(FORWARD, &changes, &[], Submits::PerPass);
        assert_eq!(apart.picture().unwrap().hash().unwrap(), hash, "{more:?}");
        assert_eq!(watched.hash(FORWARD, &both(&changes, &[("alias", "off")])), hash, "{more:?}");
    }
}

/// Glass asks them after solid surfaces; in a set of samples of something that moves, compute shaders do or fragments.
#[test]
fn maps_that_are_drawn_once_are_those_of_every_frame() {
    let once = ("shadow-maps", "once");
    let require_equal = |watched: &Watched, technique: &str, common: Changes<'_>| {
        let renderer = watched.render(technique, &both(common, &[once]));
        let names: Vec<&str> = renderer.once_passes.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, [format!("{technique}.shadow_maps")], "{common:?}");
        assert!(renderer.passes().iter().all(|pass| !pass.name.ends_with("shadow_maps")), "{common:?}");
        let hash = renderer.picture().unwrap().hash().unwrap();
        assert_eq!(hash, watched.hash(technique, common), "{technique} with {common:?}");
    };
    let maps = [("size", "97x55"), MAP, ("shadow-map-size", "64")];
    let watched = Watched::open("hall:triangles=8000");
    require_equal(&watched, FORWARD, &both(&maps, &[("supersample", "2")]));
    let watched = Watched::with_scene(moving("chess:triangles=12000", [0.0, 0.2]));
    let few = both(&maps, &[("spp", "2"), ("tuples", "4"), ("accumulate", "2")]);
    for shading in ["deep", "indirect-gbuffer", "ssaa"] {
        require_equal(&watched, "deep_shading", &both(&few, &[("shading", shading)]));
    }
}

/// 17 point lights: 102 maps. They are a group of their own, of as many bytes as their texels.
#[test]
fn maps_are_counted_and_planned() {
    let watched = Watched::open("hall:triangles=8000");
    let renderer = watched.render(FORWARD, &[("size", "97x53"), ("shadow-map-size", "64"), MAP]);
    assert_eq!(renderer.counters["shadow_maps"], 102.0);
    let of_maps = renderer.plan.resources.iter().filter(|planned| planned.group == "shadow_maps");
    let bytes: Vec<(String, u64)> = of_maps.map(|planned| (planned.name.clone(), planned.bytes())).collect();
    assert_eq!(bytes[0], ("forward.shadow_maps.depth".to_owned(), 102 * 64 * 64 * 4));
    assert_eq!((&*bytes[1].0, bytes.len()), ("forward.shadow_maps.blocks", 3));
    assert_eq!(bytes[2], ("forward.shadow_maps.views".to_owned(), 102 * 64));
    let held = watched.session.gpu.memory.snapshot();
    for (name, planned) in &bytes {
        let entry = held.resources.iter().find(|entry| entry.name == *name).unwrap();
        assert_eq!(entry.bytes, *planned, "{name}");
    }
    assert!(renderer.passes().iter().any(|pass| pass.name == "forward.shadow_maps"));
    let without = watched.render(FORWARD, &[("size", "97x53")]);
    assert!(!without.counters.contains_key("shadow_maps"));
    assert!(without.plan.resources.iter().all(|planned| planned.group != "shadow_maps"));
}

#[test]
fn techniques_without_maps_refuse_them() {
    let takes_maps = [FORWARD, "interleaved_sampling", "deep_shading"];
    for technique in techniques::ALL.iter().filter(|technique| !takes_maps.contains(&technique.name())) {
        let error = Job::new("cornell", *technique).set("direct-shadow", "map").unwrap_err();
        assert_eq!(error.exit_code(), 2, "{}: {error}", technique.name());
    }
}
