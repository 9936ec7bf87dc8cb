//! A material at one point, on the host: what rays and light walks read where they land. Finest texture level, bilinear,
//! or nearest where the sampler magnifies so: a device that shows more texels than pixels has the mean of several. Twin
//! of glsl/shading/texel.glsl, and for normals of glsl/shading/material.glsl.

use crate::picture::tonemap::linear_from_srgb;
use crate::scene::{AlphaMode, ColorSpace, Draw, Image, Material, Mesh, Scene, Texture, TextureSlot};
use glam::{Mat3, Vec2, Vec3, Vec4};

/// What a mesh says of a point on one of its triangles.
#[derive(Clone, Copy, Debug)]
pub struct MeshPoint {
    /// Coordinates in both UV sets; 0 where there is none.
    pub uvs: [Vec2; 2],
    /// Linear RGB and alpha; white where there is none.
    pub color: Vec4,
}

impl MeshPoint {
    /// Between the vertices `corners`, whose `weights` add up to 1.
    pub fn on(mesh: &Mesh, corners: [usize; 3], weights: [f32; 3]) -> Self {
        let uv = |uvs: &[Vec2]| {
            let at = |corner: usize| uvs.get(corners[corner]).copied().unwrap_or(Vec2::ZERO) * weights[corner];
            at(0) + at(1) + at(2)
        };
        let color = |corner: usize| mesh.colors[corners[corner]] * weights[corner];
        Self {
            uvs: [uv(&mesh.uvs), uv(&mesh.uvs_1)],
            color: if mesh.colors.is_empty() { Vec4::ONE } else { color(0) + color(1) + color(2) },
        }
    }
}

/// Base colour factor times vertex colour times texture: linear RGB and alpha.
pub fn base_color_at(scene: &Scene, material: &Material, point: &MeshPoint) -> Vec4 {
    material.base_color * point.color * texel_of(scene, material, TextureSlot::BaseColor, point)
}

/// Linear RGB of the part that scatters diffusely; black where the material is unlit.
pub fn albedo_at(scene: &Scene, material: &Material, point: &MeshPoint) -> Vec3 {
    if material.unlit {
        return Vec3::ZERO;
    }
    let metallic = material.metallic * texel_of(scene, material, TextureSlot::MetallicRoughness, point).z;
    base_color_at(scene, material, point).truncate() * (1.0 - metallic)
}

/// Radiance that the surface sends of its own to others.
pub fn emissive_at(scene: &Scene, material: &Material, point: &MeshPoint) -> Vec3 {
    material.emissive * texel_of(scene, material, TextureSlot::Emissive, point).truncate()
}

/// Vertices' normal and tangent at one point of a triangle, in world space as they are interpolated.
#[derive(Clone, Copy, Debug)]
pub struct VertexFrame {
    /// Any length.
    pub normal_ws: Vec3,
    /// w: the sign of the bitangent. xyz is 0 where there is no normal map.
    pub tangent_ws: Vec4,
}

impl VertexFrame {
    /// Between the vertices `corners` of a mesh where `draw` has it; `weights` add up to 1.
    pub fn on(mesh: &Mesh, draw: &Draw, corners: [usize; 3], weights: [f32; 3]) -> Self {
        let (normals, tangents) = (draw.normals_from_object(), Mat3::from_mat4(draw.world_from_object));
        let normal = |corner: usize| normals * mesh.normals[corners[corner]] * weights[corner];
        let tangent = |corner: usize| {
            let tangent = mesh.tangents.get(corners[corner]).copied().unwrap_or(Vec4::ZERO);
            (tangents * tangent.truncate()).extend(tangent.w) * weights[corner]
        };
        Self { normal_ws: normal(0) + normal(1) + normal(2), tangent_ws: tangent(0) + tangent(1) + tangent(2) }
    }
}

/// Unit shading normal, on the viewer's side where the material is double-sided; `is_front`: the viewer sees the front.
pub fn normal_at(scene: &Scene, material: &Material, point: &MeshPoint, frame: &VertexFrame, is_front: bool) -> Vec3 {
    let mut normal = frame.normal_ws.normalize_or_zero();
    let tangent_ws = frame.tangent_ws.truncate();
    if material.normal_texture.is_some() && tangent_ws != Vec3::ZERO {
        let tangent = tangent_ws.normalize_or_zero();
        let bitangent = normal.cross(tangent) * frame.tangent_ws.w;
        let mapped = texel_of(scene, material, TextureSlot::Normal, point).truncate() * 2.0 - 1.0;
        let scale = material.normal_scale;
        let bent = tangent * (mapped.x * scale) + bitangent * (mapped.y * scale) + normal * mapped.z;
        // A map that points nowhere leaves the surface as it is.
        if bent.dot(bent) > 1e-12 {
            normal = bent.normalize();
        }
    }
    if material.double_sided && !is_front { -normal } else { normal }
}

/// Whether a MASK surface has a hole here.
pub fn is_hole(scene: &Scene, material: &Material, point: &MeshPoint) -> bool {
    match material.alpha {
        AlphaMode::Mask { cutoff } => base_color_at(scene, material, point).w < cutoff,
        AlphaMode::Opaque | AlphaMode::Blend => false,
    }
}

/// What the texture says where it is placed; white where there is none.
fn texel_of(scene: &Scene, material: &Material, slot: TextureSlot, point: &MeshPoint) -> Vec4 {
    match material.texture(slot) {
        None => Vec4::ONE,
        Some(texture) => sample(scene, &scene.textures[texture], material.placement(slot).at(point.uvs)),
    }
}

fn sample(scene: &Scene, texture: &Texture, uv: Vec2) -> Vec4 {
    let image = &scene.images[texture.image];
    let size = Vec2::new(image.width as f32, image.height as f32);
    let is_linear = texture.sampler.mag_linear;
    let at = uv * size - if is_linear { 0.5 } else { 0.0 };
    let low = at.floor();
    let fraction = if is_linear { at - low } else { Vec2::ZERO };
    let mut sum = Vec4::ZERO;
    for (step, weight) in [
        (Vec2::new(0.0, 0.0), (1.0 - fraction.x) * (1.0 - fraction.y)),
        (Vec2::new(1.0, 0.0), fraction.x * (1.0 - fraction.y)),
        (Vec2::new(0.0, 1.0), (1.0 - fraction.x) * fraction.y),
        (Vec2::new(1.0, 1.0), fraction.x * fraction.y),
    ] {
        let x = texture.sampler.wrap_u.texel((low.x + step.x) as i64, image.width);
        let y = texture.sampler.wrap_v.texel((low.y + step.y) as i64, image.height);
        sum += texel(image, x, y, texture.color_space) * weight;
    }
    sum
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
    use crate::scene::{Placement, Sampler, Wrap};
    use glam::{Affine2, Mat4};

    #[test]
    fn a_hole_is_where_alpha_falls_below_the_cutoff() {
        let image =
            Image { name: String::new(), width: 2, height: 1, rgba8: vec![255, 255, 255, 255, 255, 255, 255, 0] };
        let sampler = Sampler { wrap_u: Wrap::ClampToEdge, ..Sampler::default() };
        let texture = Texture { image: 0, sampler, color_space: ColorSpace::Srgb };
        let scene = Scene { images: vec![image.into()], textures: vec![texture], ..Scene::default() };
        let alpha = AlphaMode::Mask { cutoff: 0.5 };
        let material = Material { base_color_texture: Some(0), alpha, ..Material::default() };
        let at = |x: f32| MeshPoint { uvs: [Vec2::new(x, 0.5), Vec2::ZERO], color: Vec4::ONE };
        assert!(!is_hole(&scene, &material, &at(0.1)));
        assert!(is_hole(&scene, &material, &at(0.9)));
        assert!((base_color_at(&scene, &material, &at(0.5)).w - 0.5).abs() < 1e-6);
        let faint = MeshPoint { color: Vec4::new(0.5, 0.25, 1.0, 0.4), ..at(0.1) };
        assert!(is_hole(&scene, &material, &faint), "the vertex's alpha counts too");
        assert_eq!(base_color_at(&scene, &material, &faint), faint.color);
    }

    /// A map of two texels, one that leans to the side of growing u and one that points nowhere, on a draw that is
    /// stretched and mirrored.
    #[test]
    fn a_normal_map_bends_the_normal_in_the_frame_of_its_triangle() {
        let image =
            Image { name: String::new(), width: 2, height: 1, rgba8: vec![255, 128, 255, 255, 128, 128, 128, 255] };
        let sampler = Sampler { wrap_u: Wrap::ClampToEdge, mag_linear: false, ..Sampler::default() };
        let texture = Texture { image: 0, sampler, color_space: ColorSpace::Linear };
        let scene = Scene { images: vec![image.into()], textures: vec![texture], ..Scene::default() };
        let mesh =
            Mesh { normals: vec![Vec3::Z; 3], tangents: vec![Vec4::new(1.0, 0.0, 0.0, -1.0); 3], ..Mesh::default() };
        let draw = Draw { mesh: 0, world_from_object: Mat4::from_scale(Vec3::new(-2.0, 1.0, 5.0)) };
        let frame = VertexFrame::on(&mesh, &draw, [0, 1, 2], [0.25, 0.25, 0.5]);
        let material = |scale, double_sided| Material {
            normal_texture: Some(0),
            normal_scale: scale,
            double_sided,
            ..Material::default()
        };
        let normal = |material: Material, x: f32, is_front| {
            let point = MeshPoint { uvs: [Vec2::new(x, 0.5), Vec2::ZERO], color: Vec4::ONE };
            normal_at(&scene, &material, &point, &frame, is_front)
        };
        let near = |found: Vec3, expected: Vec3| assert!((found - expected).length() < 6e-3, "{found} for {expected}");
        // 128 of 255 is next to the middle.
        near(normal(material(1.0, false), 0.2, true), Vec3::new(-1.0, 0.0, 1.0).normalize());
        near(normal(material(0.5, false), 0.2, true), Vec3::new(-0.5, 0.0, 1.0).normalize());
        near(normal(material(0.5, false), 0.2, false), Vec3::new(-0.5, 0.0, 1.0).normalize());
        near(normal(material(0.5, true), 0.2, false), Vec3::new(0.5, 0.0, -1.0).normalize());
        let plain = Material { normal_texture: None, ..material(1.0, false) };
        assert_eq!(normal(plain, 0.2, true), Vec3::Z);
        // Green grows against the bitangent of w = -1, which is +y here: the draw mirrors, the sign stays.
        assert_eq!(frame.tangent_ws, Vec4::new(-2.0, 0.0, 0.0, -1.0));
    }

    #[test]
    fn a_placement_turns_scales_and_moves_and_chooses_its_set() {
        let image = Image { name: String::new(), width: 2, height: 1, rgba8: [[255; 4], [0, 0, 0, 255]].concat() };
        let texture = Texture { image: 0, sampler: Sampler::default(), color_space: ColorSpace::Linear };
        let scene = Scene { images: vec![image.into()], textures: vec![texture], ..Scene::default() };
        let mut material = Material { base_color_texture: Some(0), metallic: 0.0, ..Material::default() };
        // u of the picture runs along v of the second set, from 0.25 on, at half the pace.
        let quarter = std::f32::consts::FRAC_PI_2;
        let picture_from_uv =
            Affine2::from_scale_angle_translation(Vec2::new(1.0, 0.5), -quarter, Vec2::new(0.25, 0.5));
        material.placements[TextureSlot::BaseColor as usize] = Placement { uv_set: 1, picture_from_uv };
        for (v, white) in [(0.0, 1.0), (0.5, 0.5), (1.0, 0.0)] {
            let point = MeshPoint { uvs: [Vec2::splat(7.3), Vec2::new(0.0, v)], color: Vec4::ONE };
            let albedo = albedo_at(&scene, &material, &point);
            assert!((albedo.x - white).abs() < 1e-5, "{v}: {albedo}");
        }
        material.unlit = true;
        let point = MeshPoint { uvs: [Vec2::ZERO; 2], color: Vec4::ONE };
        assert_eq!(albedo_at(&scene, &material, &point), Vec3::ZERO);
    }
}
