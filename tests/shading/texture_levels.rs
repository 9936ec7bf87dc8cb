//! What coarser levels of textures show: nothing of gutters, and along a slant as much as across it.

use crate::support::choices::{known_to, techniques};
use crate::support::square::{matt, picture, square};
use crate::support::watched::{Changes, Watched};
use glam::{Affine2, Vec2, Vec3, Vec4};
use quincunx::scene::{ColorSpace, Placement, Sampler, Scene, Texturing};

/// Pixels of a side.
const SIDE: usize = 32;

const AMBIENT: Changes<'static> =
    &[("size", "32x32"), ("rig", "none"), ("ambient", "1"), ("brdf", "lambert"), ("texture-level", "cone")];

/// The square that fills the picture, unlit, with a part of a texture on it: `size` of it from `corner`.
fn board(side: u32, texels: &[[u8; 4]], corner: Vec2, size: Vec2) -> Scene {
    let mut scene = square(matt(Vec4::ONE));
    let texture = picture(&mut scene, side, texels, ColorSpace::Srgb);
    scene.textures[texture].sampler = Sampler::default();
    let material = &mut scene.materials[0];
    (material.base_color_texture, material.unlit) = (Some(texture), true);
    let picture_from_uv = Affine2::from_scale_angle_translation(size, 0.0, corner);
    material.placements.fill(Placement { uv_set: 0, picture_from_uv });
    scene
}

#[test]
fn gutters_do_not_show() {
    // A chart of odd sides, 2.5 texels a pixel: two levels are blended, and their texels straddle its edges.
    let chart = |at: u32| (100..181).contains(&at);
    let texel = |at: u32| if chart(at % 256) && chart(at / 256) { [0, 255, 0, 255] } else { [255, 0, 0, 255] };
    let texels: Vec<[u8; 4]> = (0..256 * 256).map(texel).collect();
    let mut scene = board(256, &texels, Vec2::splat(100.0 / 256.0), Vec2::splat(81.0 / 256.0));
    for fills_gutters in [true, false] {
        scene.texturing = Texturing { fills_gutters, ..Texturing::default() };
        let watched = Watched::with_scene(scene.clone());
        for technique in techniques() {
            let found = watched.picture(technique, &known_to(technique, AMBIENT));
            let away = |at: usize| (Vec3::from_array(found.pixels[at]) - Vec3::Y).abs().max_element();
            let worst = (0..SIDE * SIDE).map(away).fold(0.0, f32::max);
            if fills_gutters {
                assert!(worst <= 1.0 / 1024.0, "{technique}: {worst} of the gutters");
            } else {
                assert!(worst > 0.1, "{technique}: {worst}, and none of the gutters");
            }
        }
    }
}

/// Stripes of 8 pixels beside each other, and 16 times as many texels along them as across: by the mesh's coordinates, or by
/// where the material places its textures.
#[test]
fn stripes_are_kept_where_texels_are_narrow() {
    let texel = |at: u32| if (at % 32 / 8).is_multiple_of(2) { [255; 4] } else { [0, 0, 0, 255] };
    let texels: Vec<[u8; 4]> = (0..32 * 32).map(texel).collect();
    let mut of_mesh = board(32, &texels, Vec2::ZERO, Vec2::ONE);
    of_mesh.meshes[0].uvs.iter_mut().for_each(|uv| uv.y *= 16.0);
    let placed = board(32, &texels, Vec2::ZERO, Vec2::new(1.0, 16.0));
    for (mut scene, anisotropy) in [(of_mesh.clone(), 1), (of_mesh, 16), (placed, 16)] {
        scene.texturing = Texturing { anisotropy, ..Texturing::default() };
        let watched = Watched::with_scene(scene.clone());
        for technique in techniques() {
            let found = watched.picture(technique, &known_to(technique, AMBIENT));
            // The middle of each stripe.
            let of = |parity: usize| {
                let columns = (0..4).filter(|stripe| stripe % 2 == parity).map(|stripe| 8 * stripe + 4);
                let values =
                    columns.flat_map(|x| (0..SIDE).map(move |y| (x, y))).map(|(x, y)| found.pixels[SIDE * y + x][0]);
                values.fold([f32::MAX, f32::MIN], |[low, high], value| [low.min(value), high.max(value)])
            };
            let [white, black] = [of(0), of(1)];
            if anisotropy > 1 {
                assert!(white[0] - black[1] > 0.95, "{technique}: {white:?} {black:?}");
            } else if technique != "path_traced" {
                // The level of a cone goes by the mean of both scales, which leaves the stripes.
                assert!(white[1] - black[0] < 0.5, "{technique}: {white:?} {black:?}");
            }
        }
    }
}
