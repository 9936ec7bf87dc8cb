//! The re-indexing cube map (`--vpl-shadow-index cube-map`; Segovia 2006, section 4.3; King and Newhall 2004): a small cube whose texels
//! say where in an unrolled map a direction lies, R16G16_UINT, filled once on the host.
//!
//! A face of it has as many texels as a face of a map, so that each of its texels is one of the map's: nothing is interpolated.

use super::held::GROUP;
use super::unrolled::MapAtlas;
use crate::error::Result;
use crate::gpu::sampler::Sampler;
use crate::gpu::{Access, Bound, Gpu, Image, upload};
use crate::plan::{Plan, Resources, Shape};
use ash::vk;
use glam::Vec3;
use std::sync::Arc;

const INDEX: &str = "interleaved_deferred.vpl_shadow.index";

/// What a device looks directions up in.
pub struct IndexCube {
    image: Image,
    nearest: Sampler,
}

/// Plans the cube for maps of `atlas`.
pub fn plan(plan: &mut Plan, atlas: &MapAtlas) {
    plan.push(GROUP, INDEX, Shape::Image(atlas.index_description()));
}

impl IndexCube {
    /// Takes what `plan` put in, and fills it.
    ///
    /// Errors: memory for the upload (exit code 4).
    pub fn new(gpu: &Arc<Gpu>, resources: &mut Resources, atlas: &MapAtlas) -> Result<Self> {
        let image = resources.image(INDEX);
        let texels = texels(atlas);
        let fill = |bytes: &mut [u8]| bytes.copy_from_slice(bytemuck::cast_slice(&texels));
        upload::image(gpu, &image, Access::ComputeSample, fill)?;
        Ok(Self { image, nearest: Sampler::clamped(gpu, vk::Filter::NEAREST)? })
    }

    /// What maps.comp binds.
    pub fn bound(&self) -> (&'static str, Bound<'_>) {
        ("map_index", Bound::Sampled(&self.image, self.nearest.handle, Access::ComputeSample))
    }
}

/// Places in a map, face by face and row by row.
fn texels(atlas: &MapAtlas) -> Vec<[u16; 2]> {
    let side = atlas.size_px;
    let middle = |texel: u32| (texel as f32 + 0.5) / side as f32 * 2.0 - 1.0;
    (0..6)
        .flat_map(|face| (0..side).flat_map(move |y| (0..side).map(move |x| (face, x, y))))
        .map(|(face, x, y)| atlas.texel_of(towards(face, middle(x), middle(y))).map(|at| at as u16))
        .collect()
}

/// The direction through a place of a cube's face, -1 to 1, as Vulkan has them (cube map face selection).
fn towards(face: u32, s: f32, t: f32) -> Vec3 {
    match face {
        0 => Vec3::new(1.0, -t, -s),
        1 => Vec3::new(-1.0, -t, s),
        2 => Vec3::new(s, 1.0, t),
        3 => Vec3::new(s, -1.0, -t),
        4 => Vec3::new(s, -t, 1.0),
        _ => Vec3::new(-s, -t, -1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::super::unrolled::MapShape;
    use super::*;
    use std::collections::BTreeSet;

    /// Each texel of a map has one of the cube's that leads to it, and of a hemicube those behind the light lead somewhere in it.
    #[test]
    fn every_texel_of_a_map_is_led_to() {
        for (shape, texel_count) in [(MapShape::Hemicube, 3 * 64), (MapShape::Cube, 6 * 64)] {
            let atlas = MapAtlas::new(shape, 8, 1, 4096);
            let [width, height] = atlas.tile_px();
            let led_to: BTreeSet<[u16; 2]> = texels(&atlas).into_iter().collect();
            assert_eq!(led_to.len(), texel_count, "{shape:?}");
            assert!(led_to.iter().all(|[x, y]| u32::from(*x) < width && u32::from(*y) < height), "{shape:?}");
        }
    }
}
