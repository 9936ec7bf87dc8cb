//! Materials, textures, samplers and images of a .glb. Images are embedded as PNG, which loses nothing.

use super::binary::Binary;
use crate::error::{Error, Result};
use crate::scene::{AlphaMode, Image, Material, Sampler, Scene, TextureSlot, Wrap};
use glam::Vec3;
use image::{ExtendedColorType, ImageEncoder};
use serde_json::{Value, json};

const EMISSIVE_STRENGTH: &str = "KHR_materials_emissive_strength";

/// The arrays of the document that they become.
pub struct Looks {
    pub materials: Vec<Value>,
    pub textures: Vec<Value>,
    pub samplers: Vec<Value>,
    pub images: Vec<Value>,
    /// What the materials need.
    pub extensions: Vec<&'static str>,
}

/// Errors: an image that cannot be encoded (exit code 2).
pub fn encode(scene: &Scene, binary: &mut Binary) -> Result<Looks> {
    let mut samplers: Vec<Sampler> = Vec::new();
    let mut textures = Vec::new();
    for texture in &scene.textures {
        let sampler = samplers.iter().position(|known| *known == texture.sampler).unwrap_or_else(|| {
            samplers.push(texture.sampler);
            samplers.len() - 1
        });
        textures.push(json!({ "source": texture.image, "sampler": sampler }));
    }
    let images = scene.images.iter().map(|image| image_json(image, binary)).collect::<Result<_>>()?;
    let materials: Vec<Value> = scene.materials.iter().map(material_json).collect();
    let extensions: Vec<&str> = materials
        .iter()
        .any(|material| material.get("extensions").is_some())
        .then_some(EMISSIVE_STRENGTH)
        .into_iter()
        .collect();
    Ok(Looks { materials, textures, samplers: samplers.iter().map(sampler_json).collect(), images, extensions })
}

/// Whether any texture coordinates are read.
pub fn has_texture(material: &Material) -> bool {
    TextureSlot::ALL.into_iter().any(|slot| material.texture(slot).is_some())
}

fn image_json(image: &Image, binary: &mut Binary) -> Result<Value> {
    let mut png = Vec::new();
    image::codecs::png::PngEncoder::new(&mut png)
        .write_image(&image.rgba8, image.width, image.height, ExtendedColorType::Rgba8)
        .map_err(|error| Error::request(format!("image {:?} cannot be encoded: {error}", image.name)))?;
    Ok(json!({ "name": image.name, "mimeType": "image/png", "bufferView": binary.image(&png) }))
}

/// In WebGL's numbers.
fn sampler_json(sampler: &Sampler) -> Value {
    let wrap = |wrap| match wrap {
        Wrap::Repeat => 10497,
        Wrap::MirroredRepeat => 33648,
        Wrap::ClampToEdge => 33071,
    };
    let min_filter = match (sampler.min_linear, sampler.mip_linear) {
        (false, None) => 9728,
        (true, None) => 9729,
        (false, Some(false)) => 9984,
        (true, Some(false)) => 9985,
        (false, Some(true)) => 9986,
        (true, Some(true)) => 9987,
    };
    json!({
        "magFilter": if sampler.mag_linear { 9729 } else { 9728 },
        "minFilter": min_filter,
        "wrapS": wrap(sampler.wrap_u),
        "wrapT": wrap(sampler.wrap_v),
    })
}

fn material_json(material: &Material) -> Value {
    assert!(!material.has_extras() && !material.has_placements(), "no generator makes {}", material.name);
    let mut surface = json!({
        "baseColorFactor": material.base_color.to_array(),
        "metallicFactor": material.metallic,
        "roughnessFactor": material.roughness,
    });
    if let Some(index) = material.base_color_texture {
        surface["baseColorTexture"] = json!({ "index": index });
    }
    if let Some(index) = material.metallic_roughness_texture {
        surface["metallicRoughnessTexture"] = json!({ "index": index });
    }
    let mut json = json!({ "name": material.name, "pbrMetallicRoughness": surface });
    if let Some(index) = material.normal_texture {
        json["normalTexture"] = json!({ "index": index, "scale": material.normal_scale });
    }
    if let Some(index) = material.emissive_texture {
        json["emissiveTexture"] = json!({ "index": index });
    }
    if material.is_emissive() {
        let (factor, strength) = scaled(material.emissive);
        json["emissiveFactor"] = json!(factor.to_array());
        if strength != 1.0 {
            json["extensions"] = json!({ EMISSIVE_STRENGTH: { "emissiveStrength": strength } });
        }
    }
    match material.alpha {
        AlphaMode::Opaque => {}
        AlphaMode::Mask { cutoff } => {
            json["alphaMode"] = json!("MASK");
            json["alphaCutoff"] = json!(cutoff);
        }
        AlphaMode::Blend => json["alphaMode"] = json!("BLEND"),
    }
    if material.double_sided {
        json["doubleSided"] = json!(true);
    }
    json
}

/// A colour, each channel 0 to 1, and the power of two that makes `value` of it exactly; 1 where no power is needed.
pub fn scaled(value: Vec3) -> (Vec3, f32) {
    let greatest = value.max_element();
    if greatest <= 1.0 {
        return (value, 1.0);
    }
    // Beyond half of the greatest float there is no power of two above it.
    let power = greatest.log2().ceil().min(127.0).exp2();
    (value / power, power)
}
