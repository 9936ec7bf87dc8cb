//! Decoded pictures, how they are sampled, and where.

use glam::{Affine2, Vec2};

/// 8-bit RGBA, row-major from the upper left corner, 4 * width * height bytes.
#[derive(Clone, Debug, Default)]
pub struct Image {
    pub name: String,
    pub width: u32,
    pub height: u32,
    pub rgba8: Vec<u8>,
}

/// What the numbers of an image mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ColorSpace {
    /// sRGB-encoded colour (base colour, emissive); alpha is linear.
    Srgb,
    /// Plain numbers (normals, metallic and roughness).
    Linear,
}

/// How a texture is read outside 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Wrap {
    Repeat,
    MirroredRepeat,
    ClampToEdge,
}

/// glTF's sampler.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Sampler {
    pub wrap_u: Wrap,
    pub wrap_v: Wrap,
    /// Linear when magnified, else nearest.
    pub mag_linear: bool,
    /// Linear inside a level when minified, else nearest.
    pub min_linear: bool,
    /// None: only the finest level is used. Some(true): linear between levels, Some(false): the nearest level.
    pub mip_linear: Option<bool>,
}

impl Default for Sampler {
    /// glTF leaves the filter open where the file names none: trilinear, repeated.
    fn default() -> Self {
        Self { wrap_u: Wrap::Repeat, wrap_v: Wrap::Repeat, mag_linear: true, min_linear: true, mip_linear: Some(true) }
    }
}

/// Where a material reads one of its textures: from a UV set, moved as KHR_texture_transform says.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Placement {
    /// 0: `Mesh::uvs`; 1: `Mesh::uvs_1`.
    pub uv_set: usize,
    /// Coordinates on the picture from those of the mesh.
    pub picture_from_uv: Affine2,
}

impl Placement {
    /// Where on the picture a point lies whose two sets say `uvs`.
    pub fn at(&self, uvs: [Vec2; 2]) -> Vec2 {
        self.picture_from_uv.transform_point2(uvs[self.uv_set])
    }
}

/// An image seen through a sampler in a colour space.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Texture {
    /// Index into `Scene::images`.
    pub image: usize,
    pub sampler: Sampler,
    pub color_space: ColorSpace,
}
