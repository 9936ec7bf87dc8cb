//! The shaders of path tracing against their twins in Rust: where samples lie, what textures say there.

use crate::support;
use crate::support::boxes::rectangle;
use crate::support::watched::{Changes, Watched};
use glam::{Affine2, Vec2, Vec3, Vec4};
use quincunx::sampling::sobol;
use quincunx::scene::{
    Camera, ColorSpace, Image, Material, Placement, Projection, Sampler, Scene, Texture, TextureSlot, Wrap, mipmaps,
};
use quincunx::shading::material::{self, MeshPoint};

const SIDE: u32 = 16;

/// A square that fills the picture and is seen in the colours that it has.
fn unlit_square(change: impl FnOnce(&mut Scene)) -> Scene {
    let mut scene = Scene { name: "square".to_owned(), ..Scene::default() };
    let material = Material { unlit: true, ..Material::diffuse("unlit", Vec3::ONE) };
    rectangle(&mut scene, Vec3::ZERO, Vec3::X, Vec3::Y, material);
    let projection = Projection::Orthographic { x_mag: 1.0, y_mag: 1.0, z_near: 0.5, z_far: 2.0 };
    let world_from_view = glam::Mat4::from_translation(Vec3::Z);
    scene.cameras.push(Camera { name: "front".to_owned(), world_from_view, projection });
    change(&mut scene);
    scene
}

/// Where sample `index` lies on the picture, in pixels.
fn place(pixel: u32, index: u32, seed: u32) -> Vec2 {
    let [x, y] = [pixel % SIDE, pixel / SIDE];
    let offset = sobol::pair(index, sobol::pair_seed(sobol::pixel_seed([x, y], seed), 0));
    Vec2::new(x as f32, y as f32) + Vec2::from_array(offset)
}

fn rendered(watched: &Watched, changes: Changes<'_>) -> Vec<Vec3> {
    let all = support::watched::both(&[("size", "16x16"), ("rig", "none")], changes);
    watched.picture("path_traced", &all).pixels.into_iter().map(Vec3::from_array).collect()
}

/// Colours that run along both sides show where in its pixel a sample lies: to a 4000th of the pixel, which a single wrong
/// bit of the hashes would miss.
#[test]
fn samples_lie_where_the_host_s_numbers_say() {
    let watched = Watched::with_scene(unlit_square(|scene| {
        // Corners run from the lower left one on.
        scene.meshes[0].colors =
            [(0.0, 1.0), (1.0, 1.0), (1.0, 0.0), (0.0, 0.0)].map(|(x, y)| Vec4::new(x, y, 0.0, 1.0)).to_vec();
    }));
    for (spp, seed) in [(1, 1), (2, 1), (7, 1), (64, 1), (1, 2), (3, 77)] {
        let found = rendered(&watched, &[("spp", &format!("{spp}")), ("seed", &format!("{seed}"))]);
        for (pixel, found) in found.iter().enumerate() {
            let sum: Vec2 = (0..spp).map(|index| place(pixel as u32, index, seed)).sum();
            let off = found.truncate() * SIDE as f32 - sum / spp as f32;
            assert!(off.abs().max_element() < 2.5e-4, "{spp} samples, seed {seed}, pixel {pixel}: {off} px off");
        }
    }
}

/// Two pictures of odd sizes, in both colour spaces, through every kind of sampler, turned, scaled and moved.
#[test]
fn textures_say_what_they_say_on_the_host() {
    let image = |width: u32, height: u32, step: u32| {
        let rgba8 = (0..4 * width * height).map(|at| (at * step % 251) as u8).collect();
        Image { name: String::new(), width, height, rgba8 }.into()
    };
    let wraps = [Wrap::Repeat, Wrap::MirroredRepeat, Wrap::ClampToEdge];
    for (index, mag_linear) in [true, false].into_iter().cycle().take(6).enumerate() {
        let (wrap_u, wrap_v) = (wraps[index % 3], wraps[(index + 1 + index / 3) % 3]);
        let color_space = if index < 3 { ColorSpace::Srgb } else { ColorSpace::Linear };
        let scene = unlit_square(|scene| {
            scene.images = vec![image(3, 5, 7), image(7, 4, 31)];
            let sampler = Sampler { wrap_u, wrap_v, mag_linear, ..Sampler::default() };
            let texture = |image: usize| Texture { image, sampler, color_space };
            scene.textures = vec![texture(0), texture(1)];
            let material = &mut scene.materials[0];
            // The first texture is there to be passed over: the unlit colour does not read it.
            material.emissive_texture = Some(0);
            material.base_color_texture = Some(1);
            let picture_from_uv =
                Affine2::from_scale_angle_translation(Vec2::new(2.7, -3.1), 0.4, Vec2::new(-0.8, 1.3));
            material.placements[TextureSlot::BaseColor as usize] = Placement { uv_set: 0, picture_from_uv };
        });
        let found = rendered(&Watched::with_scene(scene.clone()), &[("spp", "1")]);
        let mut far = 0;
        for (pixel, found) in found.iter().enumerate() {
            let uv = place(pixel as u32, 0, 1) / SIDE as f32;
            let point = MeshPoint { uvs: [uv, Vec2::ZERO], color: Vec4::ONE };
            let expected = material::base_color_at(&scene, &scene.materials[0], &point).truncate();
            far += usize::from((*found - expected).abs().max_element() > 1e-3);
        }
        // Between two texels a float decides for one or the other.
        assert!(far <= if mag_linear { 0 } else { 2 }, "{wrap_u:?} {wrap_v:?} {color_space:?}: {far} pixels differ");
    }
}

/// A cone as wide as two texels reads the second level, as if that were the picture; one as wide as one and a half in the mean of
/// both sides reads what lies between two levels; one that is narrower than a texel, and a sampler without levels, the finest.
#[test]
fn a_cone_reads_the_level_whose_texels_are_as_wide() {
    let original = |width: u32, height: u32| {
        let rgba8 = (0..4 * width * height).map(|at| (at * 37 % 251) as u8).collect();
        Image { name: String::new(), width, height, rgba8 }
    };
    let coarser = |image: &Image, level: u32| {
        let [width, height] = [image.width, image.height].map(|side| (side >> level).max(1));
        let mut rgba8 = vec![0; 4 * (width * height) as usize];
        mipmaps::write(image, ColorSpace::Srgb, level..level + 1, None, &mut rgba8);
        Image { name: String::new(), width, height, rgba8 }
    };
    let seen = |image: Image, sampler: Sampler, level: &str| {
        let watched = Watched::with_scene(unlit_square(|scene| {
            scene.images = vec![image.into()];
            scene.textures = vec![Texture { image: 0, sampler, color_space: ColorSpace::Srgb }];
            scene.materials[0].base_color_texture = Some(0);
        }));
        rendered(&watched, &[("spp", "1"), ("texture-level", level)])
    };
    let blended = Sampler { mip_linear: Some(true), ..Sampler::default() };
    let nearest = Sampler { mip_linear: Some(false), ..Sampler::default() };
    let finest = Sampler { mip_linear: None, ..Sampler::default() };
    let (square, wide, small) = (original(2 * SIDE, 2 * SIDE), original(2 * SIDE, SIDE), original(SIDE / 2, SIDE - 1));
    let of = |image: &Image, level: u32| seen(coarser(image, level), blended, "0");
    let between = |a: Vec<Vec3>, b: Vec<Vec3>| a.iter().zip(&b).map(|(a, b)| 0.5 * (*a + *b)).collect();
    let expected: [(&Image, Sampler, Vec<Vec3>); 6] = [
        (&square, blended, of(&square, 1)),
        (&square, nearest, of(&square, 1)),
        (&square, finest, of(&square, 0)),
        (&wide, blended, between(of(&wide, 0), of(&wide, 1))),
        (&small, blended, of(&small, 0)),
        (&original(8 * SIDE, 8 * SIDE), nearest, of(&original(8 * SIDE, 8 * SIDE), 3)),
    ];
    for (image, sampler, expected) in expected {
        let found = seen(image.clone(), sampler, "cone");
        let off = found.iter().zip(&expected).map(|(a, b)| (*a - *b).abs().max_element()).fold(0f32, f32::max);
        assert!(off < 1e-4, "{}x{}, {sampler:?}: {off} off", image.width, image.height);
    }
}
