//! Whether touched bytes are counted, and in which pieces.

use crate::choice::choices;

choices! {
    /// Pieces in which it is counted which bytes a frame touches (`--touched`).
    #[derive(Default)]
    pub enum Touched {
        /// It is not counted.
        #[default]
        "off" => Off,
        /// In cache lines of 64 bytes; of images in blocks of texels of as many.
        "line" => Line,
        /// In pages of 4096 bytes; of images in blocks of texels of as many.
        "page" => Page,
    }
}

impl Touched {
    /// Bytes of a piece; None where it is not counted.
    pub fn granule_bytes(self) -> Option<u64> {
        match self {
            Self::Off => None,
            Self::Line => Some(64),
            Self::Page => Some(4096),
        }
    }
}
