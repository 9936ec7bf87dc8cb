//! A material at one point, on the host: what a light walk reads where its rays land. Finest texture level, bilinear.

use crate::report::tonemap::linear_from_srgb;
use crate::scene::{AlphaMode, ColorSpace, Image, Material, Scene, Texture, Wrap};
use glam::{Vec2, Vec3, Vec4};

/// Base colour factor times texture: linear RGB and alpha.
pub fn base_color_at(scene: &Scene, material: &Material, uv: Vec2) -> Vec4 {
    let texel = material.base_color_texture.map_or(Vec4::ONE, |texture| sample(scene, &scene.textures[texture], uv));
    material.base_color * texel
}

/// 0 to 1.
pub fn metallic_at(scene: &Scene, material: &Material, uv: Vec2) -> f32 {
    let texel =
        material.metallic_roughness_texture.map_or(1.0, |texture| sample(scene, &scene.textures[texture], uv).z);
    material.metallic * texel
}

/// Radiance that the surface sends of its own.
pub fn emissive_at(scene: &Scene, material: &Material, uv: Vec2) -> Vec3 {
    let texel = material.emissive_texture.map_or(Vec4::ONE, |texture| sample(scene, &scene.textures[texture], uv));
    material.emissive * texel.truncate()
}

/// Whether a MASK surface has a hole here.
pub fn is_hole(scene: &Scene, material: &Material, uv: Vec2) -> bool {
    match material.alpha {
        AlphaMode::Mask { cutoff } => base_color_at(scene, material, uv).w < cutoff,
        AlphaMode::Opaque | AlphaMode::Blend => false,
    }
}

fn sample(scene: &Scene, texture: &Texture, uv: Vec2) -> Vec4 {
    let image = &scene.images[texture.image];
    let size = Vec2::new(image.width as f32, image.height as f32);
    let at = uv * size - 0.5;
    let low = at.floor();
    let fraction = at - low;
    let mut sum = Vec4::ZERO;
    for (step, weight) in [
        (Vec2::new(0.0, 0.0), (1.0 - fraction.x) * (1.0 - fraction.y)),
        (Vec2::new(1.0, 0.0), fraction.x * (1.0 - fraction.y)),
        (Vec2::new(0.0, 1.0), (1.0 - fraction.x) * fraction.y),
        (Vec2::new(1.0, 1.0), fraction.x * fraction.y),
    ] {
        let x = wrapped(texture.sampler.wrap_u, low.x + step.x, image.width);
        let y = wrapped(texture.sampler.wrap_v, low.y + step.y, image.height);
        sum += texel(image, x, y, texture.color_space) * weight;
    }
    sum
}

/// The texel that a coordinate beyond the picture falls on.
fn wrapped(wrap: Wrap, at: f32, size: u32) -> u32 {
    let last = size as f32 - 1.0;
    let index = match wrap {
        Wrap::Repeat => at.rem_euclid(size as f32),
        Wrap::ClampToEdge => at.clamp(0.0, last),
        Wrap::MirroredRepeat => {
            let period = at.rem_euclid(2.0 * size as f32);
            if period >= size as f32 { 2.0 * size as f32 - 1.0 - period } else { period }
        }
    };
    index.clamp(0.0, last) as u32
}

fn texel(image: &Image, x: u32, y: u32, color_space: ColorSpace) -> Vec4 {
    let start = 4 * (y as usize * image.width as usize + x as usize);
    let [r, g, b, a] = [0, 1, 2, 3].map(|channel| f32::from(image.rgba8[start + channel]) / 255.0);
    match color_space {
        ColorSpace::Linear => Vec4::new(r, g, b, a),
        ColorSpace::Srgb => {
            let linear = |encoded: f32| linear_from_srgb(f64::from(encoded)) as f32;
            Vec4::new(linear(r), linear(g), linear(b), a)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Sampler;

    #[test]
    fn wrap_modes_reach_beyond_both_edges() {
        for (wrap, expected) in [
            (Wrap::Repeat, [2, 3, 0, 3, 0, 1]),
            (Wrap::ClampToEdge, [0, 0, 0, 3, 3, 3]),
            (Wrap::MirroredRepeat, [1, 0, 0, 3, 3, 2]),
        ] {
            let got = [-2.0, -1.0, 0.0, 3.0, 4.0, 5.0].map(|at| wrapped(wrap, at, 4));
            assert_eq!(got, expected, "{wrap:?}");
        }
    }

    #[test]
    fn a_hole_is_where_alpha_falls_below_the_cutoff() {
        let image =
            Image { name: String::new(), width: 2, height: 1, rgba8: vec![255, 255, 255, 255, 255, 255, 255, 0] };
        let sampler = Sampler { wrap_u: Wrap::ClampToEdge, ..Sampler::default() };
        let texture = Texture { image: 0, sampler, color_space: ColorSpace::Srgb };
        let scene = Scene { images: vec![image], textures: vec![texture], ..Scene::default() };
        let alpha = AlphaMode::Mask { cutoff: 0.5 };
        let material = Material { base_color_texture: Some(0), alpha, ..Material::default() };
        assert!(!is_hole(&scene, &material, Vec2::new(0.1, 0.5)));
        assert!(is_hole(&scene, &material, Vec2::new(0.9, 0.5)));
        assert!((base_color_at(&scene, &material, Vec2::new(0.5, 0.5)).w - 0.5).abs() < 1e-6);
    }
}
