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

impl Wrap {
    /// The texel, of `count` along an axis, that a coordinate beyond the picture falls on.
    pub fn texel(self, at: i64, count: u32) -> u32 {
        let count = i64::from(count);
        let inside = match self {
            Self::Repeat => at.rem_euclid(count),
            Self::ClampToEdge => at.clamp(0, count - 1),
            Self::MirroredRepeat => {
                let inside = at.rem_euclid(2 * count);
                inside.min(2 * count - 1 - inside)
            }
        };
        inside as u32
    }
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

/// How a device holds and reads textures, as far as a file says nothing of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Texturing {
    /// Greatest side of a texture in texels: larger ones begin at a coarser level. 0: no limit.
    pub limit_px: u32,
    /// Whether coarser levels leave out what no triangle shows.
    pub fills_gutters: bool,
    /// How many times as long as wide the part of a texture may be that one reading averages, 1 to 16.
    pub anisotropy: u32,
}

impl Texturing {
    /// Whether a texture is read at several places for a pixel that sees it at a slant.
    pub fn reads_along(&self) -> bool {
        self.anisotropy > 1
    }
}

impl Default for Texturing {
    fn default() -> Self {
        Self { limit_px: 0, fills_gutters: true, anisotropy: 1 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wrap_modes_reach_beyond_both_edges() {
        for (wrap, expected) in [
            (Wrap::Repeat, [2, 3, 0, 3, 0, 1]),
            (Wrap::ClampToEdge, [0, 0, 0, 3, 3, 3]),
            (Wrap::MirroredRepeat, [1, 0, 0, 3, 3, 2]),
        ] {
            let got = [-2, -1, 0, 3, 4, 5].map(|at| wrap.texel(at, 4));
            assert_eq!(got, expected, "{wrap:?}");
        }
    }
}
