//! The highlight of inferred lighting (Kircher 2009, section 2.2), against the BRDF's formula at each pixel.

use crate::support::boxes::{camera, point_light, rectangle};
use crate::support::watched::{Changes, Watched, both};
use glam::{Vec3, vec3};
use quincunx::scene::{Light, Material, Projection, Scene};
use quincunx::settings::Brdf;
use quincunx::shading::brdf::{self, Surface};

const NAME: &str = "inferred_lighting";
const SIZE: [u32; 2] = [96, 54];
const EYE: Vec3 = vec3(0.0, 1.0, 6.0);
const AT_FRAME_SIZE: Changes<'static> =
    &[("size", "96x54"), ("light-size", "96x54"), ("light-cutoff", "0"), ("direct-shadow", "none")];

/// A floor, seen so flatly that Fresnel's factor is many times that of normal incidence, and lamps beyond it. Its roughness is
/// one that 8 bits have.
fn floor(base_color: Vec3, metallic: f32, lamps: [Vec3; 3]) -> Scene {
    let mut scene = Scene { name: "floor".to_owned(), ..Scene::default() };
    let material = Material { metallic, roughness: 102.0 / 255.0, ..Material::diffuse("floor", base_color) };
    rectangle(&mut scene, Vec3::ZERO, 30.0 * Vec3::X, -30.0 * Vec3::Z, material);
    scene.cameras.push(camera(EYE, vec3(0.0, 0.2, -4.0), 0.7));
    for (x, intensity) in [-2.5, 0.3, 2.0].into_iter().zip(lamps) {
        scene.lights.push(Light { intensity, ..point_light(vec3(x, 1.5, -4.0 - x), 0.0) });
    }
    scene
}

/// Where the pixel's middle meets the floor.
fn place(scene: &Scene, pixel: usize) -> Option<Vec3> {
    let camera = &scene.cameras[0];
    let Projection::Perspective { y_fov, .. } = camera.projection else { panic!("an eye") };
    let [width, height] = SIZE.map(|side| side as f32);
    let [x, y] = [pixel as u32 % SIZE[0], pixel as u32 / SIZE[0]].map(|at| at as f32 + 0.5);
    let tangent = (0.5 * y_fov).tan() * 2.0 / height;
    let along = vec3((x - 0.5 * width) * tangent, (0.5 * height - y) * tangent, -1.0);
    let direction = camera.world_from_view.transform_vector3(along);
    let place = EYE - direction * (EYE.y / direction.y);
    // Not the far rows, of which a pixel is metres, nor those beside the floor.
    (direction.y < 0.0 && place.z > -12.0 && place.x.abs() < 25.0).then_some(place)
}

/// Radiance of a place towards the eye by `brdf`: normal, light, eye.
fn radiance(scene: &Scene, place: Vec3, brdf: impl Fn(Vec3, Vec3) -> Vec3) -> Vec3 {
    let to_eye = (EYE - place).normalize();
    let from = |light: &Light| {
        let away = light.position - place;
        let to_light = away.normalize();
        light.intensity * (to_light.y / away.length_squared()) * brdf(to_light, to_eye)
    };
    scene.lights.iter().map(from).sum()
}

/// The part of the brightest channel, at most over the floor's pixels, by which a picture is off what `brdf` gives.
fn most_off(watched: &Watched, changes: Changes<'_>, brdf: impl Fn(Vec3, Vec3) -> Vec3) -> f32 {
    let scene = &watched.session.scene;
    let picture = watched.picture(NAME, &both(AT_FRAME_SIZE, changes));
    let mut count = 0;
    let mut most = 0f32;
    for (pixel, found) in picture.pixels.iter().enumerate() {
        if let Some(place) = place(scene, pixel) {
            let expected = radiance(scene, place, &brdf);
            most = most.max((Vec3::from_array(*found) - expected).abs().max_element() / expected.max_element());
            count += 1;
        }
    }
    assert!(count > 2000, "{count} pixels show the floor");
    most
}

fn surface(scene: &Scene) -> Surface {
    let Material { base_color, metallic, roughness, dielectric_f0, .. } = scene.materials[0];
    Surface { base_color: base_color.truncate(), metallic, roughness, dielectric_f0 }
}

/// Numbers with a common exponent are off by 2^-9 of the brightest channel, and a gray floor has no other; half floats and
/// 16 bits of fixed point by less; normals and depths add some, most where a lobe is steep.
#[test]
fn gray_surfaces_under_white_lamps_have_every_light_s_fresnel_factor_in_every_encoding() {
    for kind in [Brdf::Ggx, Brdf::BlinnPhong] {
        let watched = Watched::with_scene(floor(Vec3::splat(0.3), 0.0, [15.0, 40.0, 8.0].map(Vec3::splat)));
        let surface = surface(&watched.session.scene);
        let common = [("brdf", kind.name())];
        let exact = |to_light: Vec3, to_eye: Vec3| brdf::evaluate(kind, &surface, Vec3::Y, to_light, to_eye);
        for way in [
            &[("highlight", "rgb")][..],
            &[("highlight", "rgb"), ("volumes", "scissor")],
            &[("highlight", "rgb"), ("packing", "fixed")],
            &[("highlight", "split")],
            &[("highlight", "split"), ("extras", "on"), ("volumes", "both")],
            &[("highlight", "intensity")],
            &[("highlight", "intensity"), ("l-buffer", "half"), ("volumes", "scissor")],
            &[("highlight", "rgb"), ("l-buffer", "half"), ("volumes", "quad")],
            &[("highlight", "split"), ("l-buffer", "half"), ("volumes", "stencil")],
            &[("light-fetch", "sampler")],
            &[("l-buffer", "fixed"), ("light-range", "200")],
        ] {
            let most = most_off(&watched, &both(&common, way), exact);
            println!("{}, {way:?}: {most:.5} of the radiance", kind.name());
            // A step of fixed point is 200 / 65534 lux, and the darkest place has 0.1.
            let bound = if way[0].1 == "fixed" { 0.04 } else { 0.006 };
            assert!(most < bound, "{}, {way:?}: {most} of the radiance", kind.name());
        }
        // The paper's number: the factor of normal incidence, for the light that is scattered too.
        let f0 = surface.dielectric_f0;
        let head_on = |to_light: Vec3, to_eye: Vec3| {
            let diffuse = surface.albedo() / std::f32::consts::PI;
            let mirror = Surface { base_color: Vec3::ONE, metallic: 1.0, ..surface };
            (1.0 - f0) * diffuse + f0 * brdf::evaluate(kind, &mirror, Vec3::Y, to_light, to_eye)
        };
        let paper = [("highlight", "intensity"), ("fresnel", "normal")];
        let most = most_off(&watched, &both(&common, &paper), head_on);
        println!("{}, {paper:?}: {most:.5} of the radiance", kind.name());
        assert!(most < 0.006, "{}: {most}", kind.name());
        let off = most_off(&watched, &both(&common, &paper), exact);
        assert!(off > 0.1, "{}: normal incidence is another factor: {off}", kind.name());
    }
}

/// F0 of a metal has 5 bits a channel in the light pass, which divides by it: half a step of a root of 0.5 is 3 % of F0, and
/// that of the grazing part alone. One number and two have the colour of the light that is scattered, which metal does not do:
/// lamps of several colours mix.
#[test]
fn only_three_channels_mirror_lamps_in_their_own_colours() {
    let lamps = [vec3(20.0, 2.0, 1.0), vec3(4.0, 40.0, 6.0), vec3(1.0, 2.0, 30.0)];
    for (base_color, metallic) in [(vec3(0.9, 0.6, 0.3), 1.0), (vec3(0.6, 0.5, 0.4), 0.0)] {
        let watched = Watched::with_scene(floor(base_color, metallic, lamps));
        let surface = surface(&watched.session.scene);
        let exact = |to_light: Vec3, to_eye: Vec3| brdf::evaluate(Brdf::Ggx, &surface, Vec3::Y, to_light, to_eye);
        for packing in ["words", "rgba8", "fixed"] {
            let most = most_off(&watched, &[("highlight", "rgb"), ("packing", packing)], exact);
            println!("metallic {metallic}, {packing}: {most:.5} of the radiance");
            assert!(most < 0.02, "metallic {metallic}, {packing}: {most}");
        }
        for way in ["split", "intensity"] {
            let most = most_off(&watched, &[("highlight", way)], exact);
            println!("metallic {metallic}, {way}: {most:.5} of the radiance");
            assert!(most > 0.1, "metallic {metallic}, {way}: {most}");
        }
    }
}

/// What there is no room for is refused, with what has the room.
#[test]
fn a_highlight_that_the_buffers_have_no_room_for_is_refused() {
    let watched = Watched::with_scene(floor(Vec3::splat(0.3), 0.0, [Vec3::ONE; 3]));
    for (changes, instead) in [
        (&[("highlight", "rgb"), ("extras", "off")][..], "--highlight split"),
        (&[("highlight", "intensity"), ("extras", "off")], "--fresnel normal"),
        (&[("l-buffer", "fixed"), ("extras", "off")], "--fresnel normal"),
        (&[("highlight", "rgb"), ("l-buffer", "fixed")], "--highlight intensity"),
        (&[("highlight", "split"), ("light-fetch", "sampler")], "--highlight intensity"),
    ] {
        let submits = quincunx::gpu::commands::Submits::One;
        let error = watched.try_renderer(NAME, changes, &[], submits).err().expect("there is no room");
        assert_eq!(error.exit_code(), 2, "{changes:?}");
        assert!(format!("{error:?}").contains(instead), "{changes:?}: {error:?}");
    }
    for changes in [
        &[("extras", "off")][..],
        &[("extras", "off"), ("l-buffer", "fixed"), ("fresnel", "normal")],
        &[("extras", "off"), ("l-buffer", "fixed"), ("brdf", "lambert")],
    ] {
        watched.picture(NAME, &both(AT_FRAME_SIZE, changes));
    }
}
