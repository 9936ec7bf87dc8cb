//! glTF's metallic-roughness material, static part.

use glam::{Vec3, Vec4};

/// How alpha decides what is drawn (glTF 2.0, section 3.9.4).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AlphaMode {
    Opaque,
    /// Drawn where alpha is at least `cutoff`.
    Mask {
        cutoff: f32,
    },
    /// Blended over what lies behind it.
    Blend,
}

/// Factors and textures. A texture is an index into `Scene::textures`; a factor multiplies it.
#[derive(Clone, Debug)]
pub struct Material {
    pub name: String,
    /// Linear RGB and alpha, 0 to 1.
    pub base_color: Vec4,
    pub base_color_texture: Option<usize>,
    /// 0 to 1.
    pub metallic: f32,
    /// Perceptual, 0 to 1; alpha of GGX is its square.
    pub roughness: f32,
    /// Green is roughness, blue is metallic.
    pub metallic_roughness_texture: Option<usize>,
    pub normal_texture: Option<usize>,
    /// Scales x and y of the normal map.
    pub normal_scale: f32,
    /// Radiance, W/(m^2 sr) in glTF's photometric sense (cd/m^2): factor times KHR_materials_emissive_strength.
    pub emissive: Vec3,
    pub emissive_texture: Option<usize>,
    pub alpha: AlphaMode,
    /// Also seen and lit from behind, with the normal turned around.
    pub double_sided: bool,
}

impl Default for Material {
    /// glTF's default material: white, metallic, rough, opaque, single-sided.
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: Vec4::ONE,
            base_color_texture: None,
            metallic: 1.0,
            roughness: 1.0,
            metallic_roughness_texture: None,
            normal_texture: None,
            normal_scale: 1.0,
            emissive: Vec3::ZERO,
            emissive_texture: None,
            alpha: AlphaMode::Opaque,
            double_sided: false,
        }
    }
}

impl Material {
    /// A matt surface without textures: `albedo` is linear RGB, 0 to 1.
    pub fn diffuse(name: &str, albedo: Vec3) -> Self {
        Self { name: name.to_owned(), base_color: albedo.extend(1.0), metallic: 0.0, ..Self::default() }
    }

    /// Whether any of it gives light of its own.
    pub fn is_emissive(&self) -> bool {
        self.emissive != Vec3::ZERO
    }
}
