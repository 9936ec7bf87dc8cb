//! Metallic-roughness materials, and the textures they look through.

use glam::{Vec3, Vec4};
use gltf::Document;
use gltf::material::AlphaMode as GltfAlphaMode;
use gltf::texture::{MagFilter, MinFilter, WrappingMode};

use super::label;
use crate::error::{Error, Result};
use crate::scene::{AlphaMode, ColorSpace, Material, Sampler, Texture, Wrap};

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
            "texture asks for a UV set other than 0 and is drawn with set 0",
            "textures ask for a UV set other than 0 and are drawn with set 0",
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
    other_uv_sets: usize,
    clamped: usize,
}

impl Reader {
    fn material(&mut self, material: &gltf::Material<'_>) -> Result<Material> {
        let surface = material.pbr_metallic_roughness();
        let base_color_texture = surface.base_color_texture().map(|info| self.info(&info, ColorSpace::Srgb));
        let metallic_roughness_texture =
            surface.metallic_roughness_texture().map(|info| self.info(&info, ColorSpace::Linear));
        let normal_texture =
            material.normal_texture().map(|info| self.texture(&info.texture(), info.tex_coord(), ColorSpace::Linear));
        let emissive_texture = material.emissive_texture().map(|info| self.info(&info, ColorSpace::Srgb));

        let normal_scale = material.normal_texture().map_or(1.0, |info| info.scale());
        let emissive_strength = material.emissive_strength().unwrap_or(1.0);
        let emissive = Vec3::from_array(material.emissive_factor()) * emissive_strength;
        let alpha = match material.alpha_mode() {
            GltfAlphaMode::Opaque => AlphaMode::Opaque,
            GltfAlphaMode::Mask => {
                let cutoff = material.alpha_cutoff().unwrap_or(0.5);
                AlphaMode::Mask { cutoff: self.in_range("alphaCutoff", cutoff, f32::MAX)? }
            }
            GltfAlphaMode::Blend => AlphaMode::Blend,
        };
        let mut base_color = [0.0; 4];
        for (channel, factor) in surface.base_color_factor().into_iter().enumerate() {
            base_color[channel] = self.in_range("baseColorFactor", factor, 1.0)?;
        }
        let mut radiance = [0.0; 3];
        for (channel, factor) in emissive.to_array().into_iter().enumerate() {
            radiance[channel] = self.in_range("emissiveFactor times emissiveStrength", factor, f32::MAX)?;
        }
        if !normal_scale.is_finite() {
            return Err(Error::request(format!("normalTexture.scale is {normal_scale}; it must be finite")));
        }
        Ok(Material {
            name: material.name().unwrap_or_default().to_owned(),
            base_color: Vec4::from_array(base_color),
            base_color_texture,
            metallic: self.in_range("metallicFactor", surface.metallic_factor(), 1.0)?,
            roughness: self.in_range("roughnessFactor", surface.roughness_factor(), 1.0)?,
            metallic_roughness_texture,
            normal_texture,
            normal_scale,
            emissive: Vec3::from_array(radiance),
            emissive_texture,
            alpha,
            double_sided: material.double_sided(),
        })
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

    fn info(&mut self, info: &gltf::texture::Info<'_>, color_space: ColorSpace) -> usize {
        self.texture(&info.texture(), info.tex_coord(), color_space)
    }

    /// Index of the image seen so; the same image may be seen in two colour spaces.
    fn texture(&mut self, texture: &gltf::Texture<'_>, uv_set: u32, color_space: ColorSpace) -> usize {
        self.other_uv_sets += usize::from(uv_set != 0);
        let seen = Texture { image: texture.source().index(), sampler: sampler(&texture.sampler()), color_space };
        self.textures.iter().position(|known| *known == seen).unwrap_or_else(|| {
            self.textures.push(seen);
            self.textures.len() - 1
        })
    }
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
