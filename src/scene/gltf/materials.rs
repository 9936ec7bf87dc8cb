//! Metallic-roughness materials with the extensions that change them, and the textures they look through.
//!
//! Two extensions are approximated, each with a warning. A transmissive surface becomes a BLEND one whose alpha is what
//! it does not let through, 1 - transmission * (1 - F0): light goes straight on and takes no colour. KHR_materials_specular
//! scales F0 by its factor and by the mean of its colour: grazing reflection stays whole where the factor is not 0.

use std::collections::HashMap;

use glam::{Affine2, Vec2, Vec4};
use gltf::Document;
use gltf::json::extensions::texture::{
    TextureTransform, TextureTransformOffset, TextureTransformRotation, TextureTransformScale,
};
use gltf::material::AlphaMode as GltfAlphaMode;
use gltf::texture::{MagFilter, MinFilter, WrappingMode};

use super::lights::MAX_INTENSITY;
use super::{label, marks};
use crate::error::{Error, Result};
use crate::scene::material::DEFAULT_DIELECTRIC_F0;
use crate::scene::{AlphaMode, ColorSpace, Material, Placement, Sampler, Texture, TextureSlot, Wrap};

/// All materials of the file, and what they use.
#[derive(Debug)]
pub struct Materials {
    pub materials: Vec<Material>,
    /// `Texture::image` counts in `image_indices`.
    pub textures: Vec<Texture>,
    /// The file's images that a material shows, ascending.
    pub image_indices: Vec<usize>,
}

/// Reads every material; numbers outside their range are clamped with a warning.
pub fn read(document: &Document, warnings: &mut Vec<String>) -> Result<Materials> {
    let mut reader = Reader::default();
    let materials = document.materials().map(|material| {
        let label = label::element("material", material.index().unwrap_or_default(), material.name());
        reader.material(&material).map_err(|error| error.within(label))
    });
    let materials = materials.collect::<Result<Vec<_>>>()?;

    let mut image_indices: Vec<usize> = reader.textures.iter().map(|texture| texture.image).collect();
    image_indices.sort_unstable();
    image_indices.dedup();
    for texture in &mut reader.textures {
        texture.image = image_indices.partition_point(|image| *image < texture.image);
    }
    for (count, one, many) in [
        (
            reader.other_uv_sets,
            "texture asks for a UV set beyond 1 and is drawn with set 0",
            "textures ask for a UV set beyond 1 and are drawn with set 0",
        ),
        (
            reader.transmissive,
            "transmissive material is drawn as a BLEND surface: alpha stands for 1 - transmission",
            "transmissive materials are drawn as BLEND surfaces: alpha stands for 1 - transmission",
        ),
        (
            reader.specular,
            "material's KHR_materials_specular only scales its reflection at normal incidence",
            "materials' KHR_materials_specular only scales their reflection at normal incidence",
        ),
        (reader.clamped, "material factor is clamped to its range", "material factors are clamped to their ranges"),
    ] {
        if count > 0 {
            warnings.push(label::count(count, one, many));
        }
    }
    Ok(Materials { materials, textures: reader.textures, image_indices })
}

/// Gathers textures while materials are read; here `Texture::image` counts in the file's images.
#[derive(Default)]
struct Reader {
    textures: Vec<Texture>,
    /// Where each of `textures` is.
    places: HashMap<Texture, usize>,
    other_uv_sets: usize,
    clamped: usize,
    transmissive: usize,
    specular: usize,
}

impl Reader {
    fn material(&mut self, material: &gltf::Material<'_>) -> Result<Material> {
        let surface = material.pbr_metallic_roughness();
        let mut base_color = [0.0; 4];
        for (channel, factor) in surface.base_color_factor().into_iter().enumerate() {
            base_color[channel] = self.in_range("baseColorFactor", factor, 1.0)?;
        }
        let alpha = match material.alpha_mode() {
            GltfAlphaMode::Opaque => AlphaMode::Opaque,
            GltfAlphaMode::Mask => {
                let cutoff = material.alpha_cutoff().unwrap_or(0.5);
                AlphaMode::Mask { cutoff: self.in_range("alphaCutoff", cutoff, f32::MAX)? }
            }
            GltfAlphaMode::Blend => AlphaMode::Blend,
        };
        let mut read = Material {
            name: material.name().unwrap_or_default().to_owned(),
            base_color: Vec4::from_array(base_color),
            alpha,
            double_sided: material.double_sided(),
            unlit: material.unlit(),
            stipple_layer: marks::stipple_layer(material.extras())?,
            ..Material::default()
        };
        if let Some(info) = surface.base_color_texture() {
            let (texture, placement) = self.info(&info, ColorSpace::Srgb)?;
            read.base_color_texture = Some(texture);
            read.placements[TextureSlot::BaseColor as usize] = placement;
        }
        if read.unlit {
            // KHR_materials_unlit: nothing but the base colour counts.
            read.metallic = 0.0;
            read.dielectric_f0 = 0.0;
            return Ok(read);
        }
        read.metallic = self.in_range("metallicFactor", surface.metallic_factor(), 1.0)?;
        read.roughness = self.in_range("roughnessFactor", surface.roughness_factor(), 1.0)?;
        self.maps(material, &mut read)?;
        self.emission(material, &mut read)?;
        self.reflection(material, &mut read)?;
        self.transmission(material, &mut read)?;
        Ok(read)
    }

    /// The textures beside that of the base colour.
    fn maps(&mut self, material: &gltf::Material<'_>, read: &mut Material) -> Result<()> {
        if let Some(info) = material.pbr_metallic_roughness().metallic_roughness_texture() {
            let (texture, placement) = self.info(&info, ColorSpace::Linear)?;
            read.metallic_roughness_texture = Some(texture);
            read.placements[TextureSlot::MetallicRoughness as usize] = placement;
        }
        if let Some(info) = material.normal_texture() {
            if !info.scale().is_finite() {
                return Err(Error::request(format!("normalTexture.scale is {}; it must be finite", info.scale())));
            }
            let transform = raw_transform(info.extension_value(TEXTURE_TRANSFORM))?;
            read.placements[TextureSlot::Normal as usize] = self.placement(info.tex_coord(), transform.as_ref())?;
            read.normal_texture = Some(self.texture(&info.texture(), ColorSpace::Linear));
            read.normal_scale = info.scale();
        }
        if let Some(info) = material.occlusion_texture() {
            let transform = raw_transform(info.extension_value(TEXTURE_TRANSFORM))?;
            read.placements[TextureSlot::Occlusion as usize] = self.placement(info.tex_coord(), transform.as_ref())?;
            read.occlusion_texture = Some(self.texture(&info.texture(), ColorSpace::Linear));
            read.occlusion_strength = self.in_range("occlusionTexture.strength", info.strength(), 1.0)?;
        }
        Ok(())
    }

    fn emission(&mut self, material: &gltf::Material<'_>, read: &mut Material) -> Result<()> {
        if let Some(info) = material.emissive_texture() {
            let (texture, placement) = self.info(&info, ColorSpace::Srgb)?;
            read.emissive_texture = Some(texture);
            read.placements[TextureSlot::Emissive as usize] = placement;
        }
        let strength = material.emissive_strength().unwrap_or(1.0);
        for (channel, factor) in material.emissive_factor().into_iter().enumerate() {
            read.emissive[channel] =
                self.in_range("emissiveFactor times emissiveStrength", factor * strength, MAX_INTENSITY)?;
        }
        Ok(())
    }

    /// F0 by KHR_materials_ior and KHR_materials_specular.
    fn reflection(&mut self, material: &gltf::Material<'_>, read: &mut Material) -> Result<()> {
        if let Some(ior) = material.ior() {
            // 0 stands for an index without bound: everything is mirrored.
            if !ior.is_finite() || (ior < 1.0 && ior != 0.0) {
                return Err(Error::request(format!("its index of refraction is {ior}; it must be 0, or 1 or more")));
            }
            let ratio = (ior - 1.0) / (ior + 1.0);
            // In 32 bits the default's square is not quite 0.04.
            read.dielectric_f0 = if ior == 1.5 { DEFAULT_DIELECTRIC_F0 } else { ratio * ratio };
        }
        if let Some(specular) = material.specular() {
            let factor = self.in_range("specularFactor", specular.specular_factor(), 1.0)?;
            let mut mean = 0.0;
            for channel in specular.specular_color_factor() {
                mean += self.in_range("specularColorFactor", channel, f32::MAX)? / 3.0;
            }
            let is_default = factor == 1.0 && specular.specular_color_factor() == [1.0; 3];
            let has_texture = specular.specular_texture().is_some() || specular.specular_color_texture().is_some();
            if !is_default {
                read.dielectric_f0 = (read.dielectric_f0 * mean).min(1.0) * factor;
            }
            self.specular += usize::from(has_texture || !is_default);
        }
        Ok(())
    }

    fn transmission(&mut self, material: &gltf::Material<'_>, read: &mut Material) -> Result<()> {
        let Some(transmission) = material.transmission() else { return Ok(()) };
        let factor = self.in_range("transmissionFactor", transmission.transmission_factor(), 1.0)?;
        if factor > 0.0 {
            self.transmissive += 1;
            // What is neither mirrored nor let through.
            let stopped = 1.0 - factor * (1.0 - read.dielectric_f0);
            read.base_color.w = if read.alpha == AlphaMode::Blend { read.base_color.w * stopped } else { stopped };
            read.alpha = AlphaMode::Blend;
        }
        Ok(())
    }

    /// The factor clamped to 0 to `max`.
    fn in_range(&mut self, what: &str, factor: f32, max: f32) -> Result<f32> {
        if !factor.is_finite() {
            return Err(Error::request(format!("{what} is {factor}; it must be finite")));
        }
        let clamped = factor.clamp(0.0, max);
        self.clamped += usize::from(clamped != factor);
        Ok(clamped)
    }

    fn info(&mut self, info: &gltf::texture::Info<'_>, color_space: ColorSpace) -> Result<(usize, Placement)> {
        let transform = info.texture_transform().map(|transform| TextureTransform {
            offset: TextureTransformOffset(transform.offset()),
            rotation: TextureTransformRotation(transform.rotation()),
            scale: TextureTransformScale(transform.scale()),
            tex_coord: transform.tex_coord(),
            ..TextureTransform::default()
        });
        let placement = self.placement(info.tex_coord(), transform.as_ref())?;
        Ok((self.texture(&info.texture(), color_space), placement))
    }

    /// `uv_set`: the texture's own; the transform may name another.
    fn placement(&mut self, uv_set: u32, transform: Option<&TextureTransform>) -> Result<Placement> {
        let asked = transform.and_then(|transform| transform.tex_coord).unwrap_or(uv_set);
        self.other_uv_sets += usize::from(asked > 1);
        let uv_set = usize::from(asked == 1);
        let Some(transform) = transform else { return Ok(Placement { uv_set, ..Placement::default() }) };
        let (offset, scale) = (Vec2::from_array(transform.offset.0), Vec2::from_array(transform.scale.0));
        let rotation = transform.rotation.0;
        if !offset.is_finite() || !scale.is_finite() || !rotation.is_finite() {
            return Err(Error::request(format!(
                "{TEXTURE_TRANSFORM} has offset {offset}, rotation {rotation} and scale {scale}; all must be finite"
            )));
        }
        // Turned counter-clockwise as the picture is seen, whose v points down.
        Ok(Placement { uv_set, picture_from_uv: Affine2::from_scale_angle_translation(scale, -rotation, offset) })
    }

    /// Index of the image seen so; the same image may be seen in two colour spaces.
    fn texture(&mut self, texture: &gltf::Texture<'_>, color_space: ColorSpace) -> usize {
        let seen = Texture { image: texture.source().index(), sampler: sampler(&texture.sampler()), color_space };
        *self.places.entry(seen).or_insert_with(|| {
            self.textures.push(seen);
            self.textures.len() - 1
        })
    }
}

const TEXTURE_TRANSFORM: &str = "KHR_texture_transform";

/// The crate knows the extension at colour textures only.
fn raw_transform(value: Option<&serde_json::Value>) -> Result<Option<TextureTransform>> {
    let read = value.map(|value| serde_json::from_value(value.clone())).transpose();
    read.map_err(|error| Error::request(format!("{TEXTURE_TRANSFORM} cannot be read: {error}")))
}

fn sampler(sampler: &gltf::texture::Sampler<'_>) -> Sampler {
    let default = Sampler::default();
    let (min_linear, mip_linear) = match sampler.min_filter() {
        None => (default.min_linear, default.mip_linear),
        Some(MinFilter::Nearest) => (false, None),
        Some(MinFilter::Linear) => (true, None),
        Some(MinFilter::NearestMipmapNearest) => (false, Some(false)),
        Some(MinFilter::LinearMipmapNearest) => (true, Some(false)),
        Some(MinFilter::NearestMipmapLinear) => (false, Some(true)),
        Some(MinFilter::LinearMipmapLinear) => (true, Some(true)),
    };
    Sampler {
        wrap_u: wrap(sampler.wrap_s()),
        wrap_v: wrap(sampler.wrap_t()),
        mag_linear: sampler.mag_filter().map_or(default.mag_linear, |filter| filter == MagFilter::Linear),
        min_linear,
        mip_linear,
    }
}

fn wrap(mode: WrappingMode) -> Wrap {
    match mode {
        WrappingMode::Repeat => Wrap::Repeat,
        WrappingMode::MirroredRepeat => Wrap::MirroredRepeat,
        WrappingMode::ClampToEdge => Wrap::ClampToEdge,
    }
}
