//! The words of what is shaded (`--shading`); `shading` has what goes with each.

use crate::choice::choices;

choices! {
    /// What is shaded (`--shading`).
    pub enum ShadingKind {
        "deep" => Deep,
        "ssaa" => Ssaa,
        "msaa" => Msaa,
        "indirect-gbuffer" => IndirectGbuffer,
        "texture-space" => TextureSpace,
    }
}

impl ShadingKind {
    /// Those with a shading space.
    pub const OF_SPACE: &[Self] = &[Self::Deep, Self::IndirectGbuffer];
}
