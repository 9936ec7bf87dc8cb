//! What is shaded (`--shading`), and which settings go with it.

use crate::caps::Caps;
use crate::error::{Error, Result};
use crate::settings::{Values, readers};
use crate::techniques::deep_shading::modes::pass_samples;
use crate::techniques::deep_shading::modes::pool_size::PoolSize;
use crate::techniques::deep_shading::modes::shading_kind::ShadingKind;
use crate::techniques::deep_shading::modes::visibility::Visibility;
use crate::techniques::deep_shading::resources::NAME;
use crate::techniques::deep_shading::settings::SETTINGS;

/// What is shaded (`--shading`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shading {
    /// Triangles in the lists.
    Deep,
    /// Entries of a compact geometry buffer that samples point to.
    IndirectGbuffer,
    /// Every sample that is drawn.
    Ssaa,
    /// A pixel's samples that see a triangle, once.
    Msaa {
        /// Samples a pixel that are drawn at once.
        pass_samples: u32,
    },
    /// Texels of each draw's texture.
    TextureSpace(PoolSize),
}

impl Shading {
    /// The value of `--shading`, with `spp` samples a pixel.
    ///
    /// Errors: another setting is changed that it does not read; samples of a pass that `spp` is no multiple of (exit code 2).
    pub fn new(values: &Values, caps: &Caps, spp: u32) -> Result<Self> {
        readers::require_read(SETTINGS, values)?;
        Ok(match values.choice("shading") {
            ShadingKind::Deep => Self::Deep,
            ShadingKind::IndirectGbuffer => Self::IndirectGbuffer,
            ShadingKind::Ssaa => Self::Ssaa,
            ShadingKind::TextureSpace => Self::TextureSpace(PoolSize::of(values)),
            ShadingKind::Msaa => Self::Msaa { pass_samples: pass_samples::pass_samples(values, caps, spp)? },
        })
    }

    /// How samples find what they see.
    ///
    /// Errors: what is drawn sample by sample has no such kind (exit code 2).
    pub fn visibility(self, values: &Values, caps: &Caps) -> Result<Visibility> {
        let visibility = Visibility::of(values, caps);
        let (is_drawn, why, advice) = match self {
            Self::Deep | Self::IndirectGbuffer => return Ok(visibility),
            Self::Msaa { .. } => (
                visibility == Visibility::Stochastic,
                "a shader tests a pixel's samples, all at once",
                "--visibility stochastic does so",
            ),
            Self::Ssaa | Self::TextureSpace(_) => (
                matches!(visibility, Visibility::RepeatFrame | Visibility::Stochastic),
                "samples are drawn and coloured layer by layer",
                "--visibility repeat-frame and stochastic do so",
            ),
        };
        if is_drawn {
            return Ok(visibility);
        }
        let [shading, kind] = ["shading", "visibility"].map(|key| values.text(key));
        Err(Error::request(format!("--visibility {kind} with --shading {shading}: {why}")).within(NAME).note(advice))
    }

    /// The logarithm to 2 of a texture's side; 0: there are none.
    pub fn texture_side_bits(self) -> u32 {
        if let Self::TextureSpace(size) = self { size.side_px.ilog2() } else { 0 }
    }

    /// Samples a pixel of what is drawn into.
    pub fn pass_samples(self) -> u32 {
        match self {
            Self::Msaa { pass_samples } => pass_samples,
            Self::Deep | Self::IndirectGbuffer | Self::Ssaa | Self::TextureSpace(_) => 1,
        }
    }
}
