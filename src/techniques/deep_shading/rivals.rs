//! Memory of the paper's rival, by the paper's own figures (Clarberg & Munkberg 2014, section 6: 42.7 MB a texture,
//! 341.3 MB for eight).

use crate::gpu::ImageDescription;
use crate::techniques::Rival;
use crate::units::Extent;
use ash::vk::{Format, ImageUsageFlags as Usage};

const NAME: &str = "adaptive texture-space shading (Andersson et al. 2014)";
/// Texels of a side of a texture of its pool, as the paper sets it up, and how many it uses.
const SIDE_PX: u32 = 2048;
const POOL_TEXTURES: u32 = 8;

/// One texture of the pool, and the pool.
pub fn rivals() -> Vec<Rival> {
    [1, POOL_TEXTURES]
        .map(|count| {
            let extent = Extent::new(SIDE_PX, SIDE_PX);
            let plain = ImageDescription::plain(extent, Format::R16G16B16A16_SFLOAT, 1, Usage::SAMPLED);
            let level_count = SIDE_PX.ilog2() + 1;
            let pool = ImageDescription { level_count, layer_count: Some(count), ..plain };
            let formula = format!("{count} x {SIDE_PX}^2 texels x 8 B x 4/3 (levels to 1x1)");
            Rival { name: NAME, paper: "Clarberg 2014, 6", formula, bytes: pool.bytes() }
        })
        .into()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The bytes of section 6. A sum over levels ends at a texel, 4/3 of the first level is the sum without an end.
    #[test]
    fn the_pool_is_as_large_as_the_paper_says() {
        let bytes = rivals().iter().map(|rival| rival.bytes).collect::<Vec<_>>();
        let level_bytes = (0..12).map(|level| 8 * (2048u64 >> level).pow(2)).sum::<u64>();
        assert_eq!(bytes, [level_bytes, 8 * level_bytes]);
        assert_eq!(bytes, [44_739_240, 357_913_920]);
        let mebibytes = bytes.iter().map(|bytes| format!("{:.1}", *bytes as f64 / f64::from(1 << 20)));
        assert_eq!(mebibytes.collect::<Vec<_>>(), ["42.7", "341.3"]);
    }
}
