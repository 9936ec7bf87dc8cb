//! The pool: textures that draws use one after the other (Clarberg & Munkberg 2014, section 6: "a pool of large
//! mipmapped textures"), buffers each with all levels to a texel, and beside each the triangle that shades each of its
//! texels. texture_space.textures.N   buffer, 8 B a texel: RGBA16F
//! texture_space.owners.N     buffer, 4 B a texel: atlas.glsl says of what; ours, not the paper's
//! texture_space.touched.N    buffer, a bit a texel and their count: what a frame has shaded; with `--instrument off`
//! 16 B that nothing reads

use crate::error::{Error, Result};
use crate::gpu::{Access, Bound, Buffer, Commands, Gpu, readback};
use crate::plan::{Plan, Resources};
use crate::techniques::Inputs;
use crate::techniques::deep_shading::modes::pool_size::PoolSize;
use crate::techniques::deep_shading::resources::{NAME, full};
use crate::units::Bytes;
use std::collections::BTreeMap;
use std::sync::Arc;

pub(super) const TEXEL_BYTES: u64 = 8;
pub(super) const OWNER_BYTES: u64 = 4;

pub(super) fn texels(side_px: u32) -> u64 {
    (0..=side_px.ilog2()).map(|level| u64::from(side_px >> level).pow(2)).sum()
}

pub(super) fn texture(index: u32) -> String {
    full(&format!("texture_space.textures.{index}"))
}

pub(super) fn owners(index: u32) -> String {
    full(&format!("texture_space.owners.{index}"))
}

pub(super) fn touched(index: u32) -> String {
    full(&format!("texture_space.touched.{index}"))
}

impl PoolSize {
    /// Errors: the device binds no buffer as long as a texture (exit code 4, and which fits).
    pub fn require_fitting(self, inputs: &Inputs<'_>) -> Result<()> {
        let limits = &inputs.caps.limits;
        let range = limits.max_storage_buffer_range_bytes;
        let fits = |side_px: u32| {
            texels(side_px) * TEXEL_BYTES <= range && limits.most_drawn_px().iter().all(|most| side_px <= *most)
        };
        if fits(self.side_px) {
            return Ok(());
        }
        let most = std::iter::successors(Some(self.side_px / 2), |side_px| Some(side_px / 2)).find(|side| fits(*side));
        Err(Error::memory(format!(
            "--shading-texture-size {}: a texture has {}, and this device binds {} at once",
            self.side_px,
            Bytes(texels(self.side_px) * TEXEL_BYTES),
            Bytes(range)
        ))
        .within(NAME)
        .note(format!("--shading-texture-size {} fits", most.expect("devices bind a texel"))))
    }

    /// `is_counted`: with what counts the texels that a frame touches.
    pub fn plan(self, plan: &mut Plan, is_counted: bool) {
        let count = texels(self.side_px);
        for index in 0..self.count {
            plan.buffer("texture_pool", texture(index), count * TEXEL_BYTES);
            plan.buffer("texture_owners", owners(index), count * OWNER_BYTES);
            plan.buffer("counters", touched(index), if is_counted { 4 * (1 + count.div_ceil(32)) } else { 0 });
            if is_counted {
                plan.read_back(&touched(index));
            }
        }
    }

    /// How the pass that draws touches it.
    pub fn touches(self) -> impl Iterator<Item = (String, Access)> {
        (0..self.count).flat_map(|index| {
            let owned = [Access::TransferWrite, Access::FragmentWrite, Access::GraphicsRead];
            let shaded = [Access::FragmentWrite, Access::GraphicsRead];
            let counted = [Access::TransferWrite, Access::FragmentWrite].map(|access| (touched(index), access));
            let owned = owned.map(|access| (owners(index), access));
            owned.into_iter().chain(shaded.map(|access| (texture(index), access))).chain(counted)
        })
    }
}

/// One texture, the owners of its texels, and which of them were shaded.
struct PoolTexture {
    texels: Buffer,
    owners: Buffer,
    touched: Buffer,
}

/// The textures of the next chunk of draws: all that touches them, in its order, is one round.
pub struct Pool(Vec<PoolTexture>);

impl Pool {
    pub fn new(resources: &mut Resources, size: PoolSize) -> Self {
        let slot = |index| PoolTexture {
            texels: resources.buffer(&texture(index)),
            owners: resources.buffer(&owners(index)),
            touched: resources.buffer(&touched(index)),
        };
        Self((0..size.count).map(slot).collect())
    }

    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Buffers of each texture that shaders bind.
    pub fn bound(&self) -> impl Iterator<Item = [(&'static str, Bound<'_>); 3]> {
        self.0.iter().map(|PoolTexture { texels, owners, touched }| {
            [("Texels", texels), ("Owners", owners), ("Touched", touched)]
                .map(|(name, buffer)| (name, Bound::Buffer(buffer)))
        })
    }

    /// Bytes of the owners of one texture.
    pub fn owner_bytes(&self) -> u64 {
        self.0.first().map_or(0, |slot| slot.owners.bytes)
    }

    fn owners(&self) -> impl Iterator<Item = &Buffer> {
        self.0.iter().map(|slot| &slot.owners)
    }

    fn texels(&self) -> impl Iterator<Item = &Buffer> {
        self.0.iter().map(|slot| &slot.texels)
    }

    fn touched(&self) -> impl Iterator<Item = &Buffer> {
        self.0.iter().map(|slot| &slot.touched)
    }

    /// Bytes that a frame of `draw_count` draws has touched, by full name: texels that were shaded, each once however many draws
    /// shaded it, and all owners of the textures that were used, which are cleared whole.
    ///
    /// Errors: memory for reading the counts back (exit code 4).
    pub fn touched_bytes(&self, gpu: &Arc<Gpu>, draw_count: usize) -> Result<BTreeMap<String, u64>> {
        let mut bytes = BTreeMap::new();
        for (index, slot) in self.0.iter().enumerate() {
            let count: Vec<u32> =
                bytemuck::pod_collect_to_vec(&readback::buffer(gpu, &slot.touched, 4, Access::FragmentWrite)?);
            bytes.insert(slot.texels.name.clone(), u64::from(count[0]) * TEXEL_BYTES);
            bytes.insert(slot.owners.name.clone(), if index < draw_count { slot.owners.bytes } else { 0 });
        }
        Ok(bytes)
    }

    /// Clears the owners of the texels of the first `used`, for claims to follow. `is_first`: nothing has touched them
    /// in this frame.
    pub fn begin(&self, cmd: &mut Commands, used: usize, is_first: bool) {
        cmd.barriers(self.owners().map(|owners| match is_first {
            true => owners.discard(Access::TransferWrite),
            false => owners.from(Access::GraphicsRead).to(Access::TransferWrite),
        }));
        self.owners().take(used).for_each(|owners| cmd.clear(owners));
        cmd.barriers(self.owners().map(|owners| owners.from(Access::TransferWrite).to(Access::FragmentWrite)));
        if is_first {
            cmd.barriers(self.touched().map(|touched| touched.discard(Access::TransferWrite)));
            self.touched().for_each(|touched| cmd.clear(touched));
        }
        let left = if is_first { Access::TransferWrite } else { Access::FragmentWrite };
        cmd.barriers(self.touched().map(|touched| touched.from(left).to(Access::FragmentWrite)));
    }

    /// After claims, for owners to shade.
    pub fn claimed(&self, cmd: &mut Commands, is_first: bool) {
        cmd.barriers(self.owners().map(|owners| owners.from(Access::FragmentWrite).to(Access::GraphicsRead)));
        cmd.barriers(self.texels().map(|texels| match is_first {
            true => texels.discard(Access::FragmentWrite),
            false => texels.from(Access::GraphicsRead).to(Access::FragmentWrite),
        }));
    }

    /// After shading, for look-ups.
    pub fn shaded(&self, cmd: &mut Commands) {
        cmd.barriers(self.texels().map(|texels| texels.from(Access::FragmentWrite).to(Access::GraphicsRead)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 42.7 MiB a texture, as Clarberg 2014 section 6 has it.
    #[test]
    fn a_texture_has_all_levels_to_a_texel() {
        assert_eq!(texels(2048) * TEXEL_BYTES, 44_739_240);
        assert_eq!(texels(1), 1);
    }
}
