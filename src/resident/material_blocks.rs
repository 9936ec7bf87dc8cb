//! Materials as shaders read them: glsl/resident.glsl's blocks.

use crate::gpu::shader::resident::{
    MATERIAL_ANISOTROPY_SHIFT, MATERIAL_BASE_COLOR_TEXTURE, MATERIAL_DOUBLE_SIDED, MATERIAL_EMISSIVE_TEXTURE,
    MATERIAL_F0_SHIFT, MATERIAL_METALLIC_ROUGHNESS_TEXTURE, MATERIAL_NORMAL_TEXTURE, MATERIAL_OCCLUSION_SHIFT,
    MATERIAL_OCCLUSION_TEXTURE, MATERIAL_UNLIT,
};
use crate::gpu::shader::structs::{MaterialBlock, PlacementBlock};
use crate::scene::{AlphaMode, Material, Placement, Scene, TextureSlot};
use crate::shading::brdf;

/// Factors and flags of one of the scene's materials.
pub fn block(scene: &Scene, material: &Material) -> MaterialBlock {
    let textures = TextureSlot::ALL.into_iter().filter_map(|slot| material.texture(slot));
    // A picture that is seen at its finest level alone is seen where a pixel's middle falls.
    let has_levels = { textures }.all(|texture| scene.textures[texture].sampler.mip_linear.is_some());
    let anisotropy = if has_levels { scene.texturing.anisotropy } else { 1 };
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
        flags: bit(material.base_color_texture.is_some(), MATERIAL_BASE_COLOR_TEXTURE)
            | bit(material.metallic_roughness_texture.is_some(), MATERIAL_METALLIC_ROUGHNESS_TEXTURE)
            | bit(material.normal_texture.is_some(), MATERIAL_NORMAL_TEXTURE)
            | bit(material.emissive_texture.is_some(), MATERIAL_EMISSIVE_TEXTURE)
            | bit(material.double_sided, MATERIAL_DOUBLE_SIDED)
            | bit(material.occlusion_texture.is_some(), MATERIAL_OCCLUSION_TEXTURE)
            | bit(material.unlit, MATERIAL_UNLIT)
            | brdf::code_of_f0(material.dielectric_f0) << MATERIAL_F0_SHIFT
            | ((material.occlusion_strength * 255.0).round() as u32) << MATERIAL_OCCLUSION_SHIFT
            | (anisotropy - 1) << MATERIAL_ANISOTROPY_SHIFT,
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
