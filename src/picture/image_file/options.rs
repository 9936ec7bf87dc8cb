//! How a picture is written.

use crate::choice::choices;
use crate::picture::Aov;
use crate::picture::tonemap::ToneMap;
use std::collections::BTreeMap;

/// How a picture is written. A PNG heeds `exposure_ev`, `tone_map` and `attributes`, an EXR all but the first two.
#[derive(Clone, Debug, Default)]
pub struct WriteOptions<'a> {
    /// PNG: stops; 0 makes radiance 1 white.
    pub exposure_ev: f64,
    /// PNG.
    pub tone_map: ToneMap,
    /// EXR: of every channel but the whole-number ones.
    pub exr_precision: ExrPrecision,
    /// EXR: layers beside the picture, with different names. A PNG has no room for them: writing one fails.
    pub aovs: &'a [Aov],
    /// Text attributes of an EXR, text chunks (iTXt) of a PNG, as (name, text): the technique, the scene's hash. Names are
    /// different, ASCII, of 1 to 79 bytes, and none of OpenEXR's own.
    pub attributes: Vec<(String, String)>,
}

choices! {
    /// The floating-point format of an EXR (`--exr`).
    #[derive(Default)]
    pub enum ExrPrecision {
        /// 32 bits: what is read back equals what was written.
        #[default]
        "float" => Float,
        /// 16 bits, rounded to nearest, ties to even. A finite value past 65504, the largest half, becomes 65504.
        "half" => Half,
    }
}

/// The texts of a header, by name.
pub type Texts = BTreeMap<String, String>;
