//! Levels of textures along triangles' edges: what a quad's lanes beyond the triangle read must not choose a level.
//!
//! A checkerboard whose texels are two pixels wide is seen at its finest level everywhere; every other level is grey.

use crate::support::choices::{known_to, techniques};
use crate::support::square::{matt, picture, square};
use crate::support::watched::{Changes, Watched};
use crate::support::{self, Feature};
use glam::{Affine2, Vec2, Vec3, Vec4};
use quincunx::scene::{AlphaMode, ColorSpace, Placement, Scene};

/// Pixels of a side.
const SIDE: usize = 32;
/// Texels of a side.
const TEXELS: usize = 16;

const AMBIENT: Changes<'static> = &[("size", "32x32"), ("rig", "none"), ("ambient", "1"), ("brdf", "lambert")];

/// Black where x + y is odd.
fn is_black(x: usize, y: usize) -> bool {
    (x + y) % 2 == 1
}

/// The board on a square of two triangles, read through `placement`, by vertices that have colours or a second set of
/// coordinates where they need it.
fn board(placement: Placement, has_colors: bool, alpha: AlphaMode) -> Scene {
    let mut scene = square(matt(Vec4::ONE));
    let texel = |at: usize| if is_black(at % TEXELS, at / TEXELS) { [0, 0, 0, 255] } else { [255; 4] };
    let texels: Vec<[u8; 4]> = (0..TEXELS * TEXELS).map(texel).collect();
    let texture = picture(&mut scene, TEXELS as u32, &texels, ColorSpace::Srgb);
    scene.textures[texture].sampler.mip_linear = Some(false);
    let mesh = &mut scene.meshes[0];
    if has_colors {
        mesh.colors = vec![Vec4::ONE; mesh.positions.len()];
    }
    if placement.uv_set == 1 {
        mesh.uvs_1 = std::mem::replace(&mut mesh.uvs, vec![Vec2::ZERO; mesh.positions.len()]);
    }
    let material = &mut scene.materials[0];
    material.base_color_texture = Some(texture);
    material.alpha = alpha;
    material.placements.fill(placement);
    scene
}

#[test]
fn the_finest_level_is_seen_on_every_edge() {
    // By an odd count of texels: black and white change places.
    let moved = Affine2::from_translation(Vec2::new(3.0 / TEXELS as f32, 0.0));
    let cases = [
        ("plain", Placement::default(), false, false),
        ("vertex colours", Placement::default(), true, false),
        ("a second set of coordinates", Placement { uv_set: 1, ..Placement::default() }, false, false),
        ("a texture transform", Placement { uv_set: 0, picture_from_uv: moved }, false, true),
    ];
    // Rays have no quads; samples of deep shading find their shading points through placed vertices.
    let are_placed = support::has(&support::driver(), Feature::ExactPositions);
    let mut techniques: Vec<&str> = techniques().filter(|name| *name != "path_traced").collect();
    techniques.retain(|name| *name != "deep_shading" || are_placed);
    for (case, placement, has_colors, is_swapped) in cases {
        for alpha in [AlphaMode::Opaque, AlphaMode::Mask { cutoff: 0.5 }, AlphaMode::Blend] {
            let watched = Watched::with_scene(board(placement, has_colors, alpha));
            for technique in &techniques {
                // Ambient light is the same of all of them without it, too.
                let found = watched.picture(technique, &known_to(technique, AMBIENT));
                let wrong: Vec<_> = (0..SIDE * SIDE)
                    .filter(|at| {
                        let expected = if is_black(at % SIDE / 2, at / SIDE / 2) == is_swapped { 1.0 } else { 0.0 };
                        (Vec3::from_array(found.pixels[*at]) - expected).abs().max_element() > 1.0 / 1024.0
                    })
                    .map(|at| (at % SIDE, at / SIDE, found.pixels[at]))
                    .collect();
                assert!(wrong.is_empty(), "{technique}, {case}, {alpha:?}: {} pixels: {wrong:?}", wrong.len());
            }
        }
    }
}
