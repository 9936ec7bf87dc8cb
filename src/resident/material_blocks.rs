//! Materials as shaders read them: glsl/resident.glsl's blocks.

use crate::gpu::shader::structs::{MaterialBlock, PlacementBlock};
use crate::scene::{AlphaMode, Material, Placement, Scene, TextureSlot};
use crate::shading::brdf;

/// glsl/resident.glsl's bits.
const BASE_COLOR_TEXTURE: u32 = 1;
const METALLIC_ROUGHNESS_TEXTURE: u32 = 2;
const NORMAL_TEXTURE: u32 = 4;
const EMISSIVE_TEXTURE: u32 = 8;
const DOUBLE_SIDED: u32 = 16;
const OCCLUSION_TEXTURE: u32 = 32;
const UNLIT: u32 = 64;
const F0_SHIFT: u32 = 8;
const OCCLUSION_SHIFT: u32 = 16;

/// Factors and flags of one material.
pub fn block(material: &Material) -> MaterialBlock {
    let bit = |present: bool, bit: u32| if present { bit } else { 0 };
    MaterialBlock {
        base_color: material.base_color.to_array(),
        emissive: material.emissive.extend(material.normal_scale).to_array(),
        metallic: material.metallic,
        roughness: material.roughness,
        alpha_cutoff: match material.alpha {
            AlphaMode::Mask { cutoff } => cutoff,
            AlphaMode::Opaque => 0.0,
            // Where it is drawn as solid: inferred_lighting's --alpha test.
            AlphaMode::Blend => 0.5,
        },
        flags: bit(material.base_color_texture.is_some(), BASE_COLOR_TEXTURE)
            | bit(material.metallic_roughness_texture.is_some(), METALLIC_ROUGHNESS_TEXTURE)
            | bit(material.normal_texture.is_some(), NORMAL_TEXTURE)
            | bit(material.emissive_texture.is_some(), EMISSIVE_TEXTURE)
            | bit(material.double_sided, DOUBLE_SIDED)
            | bit(material.occlusion_texture.is_some(), OCCLUSION_TEXTURE)
            | bit(material.unlit, UNLIT)
            | brdf::code_of_f0(material.dielectric_f0) << F0_SHIFT
            | ((material.occlusion_strength * 255.0).round() as u32) << OCCLUSION_SHIFT,
    }
}

/// Where each texture of each material is read, `TextureSlot::ALL` of one material after the other's.
pub fn placements(scene: &Scene) -> Vec<PlacementBlock> {
    let of = |material: &Material| TextureSlot::ALL.map(|slot| placement(material.placement(slot)));
    scene.materials.iter().flat_map(of).collect()
}

/// Coordinates on the picture as shaders make them.
pub fn placement(placement: &Placement) -> PlacementBlock {
    let [x, y] = [0, 1].map(|row| placement.picture_from_uv.matrix2.row(row));
    let shift = placement.picture_from_uv.translation;
    PlacementBlock { u: [x.x, x.y, shift.x, placement.uv_set as f32], v: [y.x, y.y, shift.y, 0.0] }
}
