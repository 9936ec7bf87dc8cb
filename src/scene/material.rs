//! glTF's metallic-roughness material, static part.

use super::Placement;
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

/// Which of a material's textures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TextureSlot {
    BaseColor,
    MetallicRoughness,
    Normal,
    Emissive,
    Occlusion,
}

impl TextureSlot {
    /// In the order of `Material::placements` and of the shaders' bindings.
    pub const ALL: [Self; 5] =
        [Self::BaseColor, Self::MetallicRoughness, Self::Normal, Self::Emissive, Self::Occlusion];
}

/// F0 of a dielectric whose index of refraction is 1.5, glTF's default.
pub const DEFAULT_DIELECTRIC_F0: f32 = 0.04;

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
    /// Red is the part of ambient light that reaches the surface.
    pub occlusion_texture: Option<usize>,
    /// How much of the occlusion counts, 0 to 1.
    pub occlusion_strength: f32,
    /// Where each texture is read, in the order of `TextureSlot::ALL`.
    pub placements: [Placement; TextureSlot::ALL.len()],
    /// Part of the light at normal incidence that the surface of the part that is no metal mirrors, 0 to 1. 0: there is
    /// no such surface, and it mirrors nothing at grazing angles either.
    pub dielectric_f0: f32,
    /// The base colour is the radiance that it sends; it takes no light, sends none on and is no emitter for others.
    pub unlit: bool,
    pub alpha: AlphaMode,
    /// Also seen and lit from behind, with the normal turned around.
    pub double_sided: bool,
    /// Layer of a stipple, 1 to 15, that the file gives a BLEND surface (Kircher 2009, section 4).
    pub stipple_layer: Option<u32>,
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
            occlusion_texture: None,
            occlusion_strength: 1.0,
            placements: [Placement::default(); TextureSlot::ALL.len()],
            dielectric_f0: DEFAULT_DIELECTRIC_F0,
            unlit: false,
            alpha: AlphaMode::Opaque,
            double_sided: false,
            stipple_layer: None,
        }
    }
}

impl Material {
    /// A matt surface without textures: `albedo` is linear RGB, 0 to 1.
    pub fn diffuse(name: &str, albedo: Vec3) -> Self {
        Self { name: name.to_owned(), base_color: albedo.extend(1.0), metallic: 0.0, ..Self::default() }
    }

    /// Whether any of it gives light of its own to others.
    pub fn is_emissive(&self) -> bool {
        self.emissive != Vec3::ZERO && !self.unlit
    }

    /// Index into `Scene::textures`.
    pub fn texture(&self, slot: TextureSlot) -> Option<usize> {
        match slot {
            TextureSlot::BaseColor => self.base_color_texture,
            TextureSlot::MetallicRoughness => self.metallic_roughness_texture,
            TextureSlot::Normal => self.normal_texture,
            TextureSlot::Emissive => self.emissive_texture,
            TextureSlot::Occlusion => self.occlusion_texture,
        }
    }

    pub fn placement(&self, slot: TextureSlot) -> &Placement {
        &self.placements[slot as usize]
    }

    /// Whether a texture is read elsewhere than at the mesh's first coordinates.
    pub fn has_placements(&self) -> bool {
        self.placed().any(|placement| *placement != Placement::default())
    }

    /// Whether a texture reads `Mesh::uvs_1`.
    pub fn reads_uvs_1(&self) -> bool {
        self.placed().any(|placement| placement.uv_set == 1)
    }

    fn placed(&self) -> impl Iterator<Item = &Placement> {
        TextureSlot::ALL.into_iter().filter(|slot| self.texture(*slot).is_some()).map(|slot| self.placement(slot))
    }

    /// Whether shading needs more of it than colour, roughness, metalness and emission.
    pub fn has_extras(&self) -> bool {
        self.unlit || self.occlusion_texture.is_some() || self.dielectric_f0 != DEFAULT_DIELECTRIC_F0
    }
}
