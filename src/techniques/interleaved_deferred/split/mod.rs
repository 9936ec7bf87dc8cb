//! G-buffer splitting (BS): how the pixels of one light subset come together. Segovia 2006, sections 3.1 to 3.3.

pub mod one_pass;

/// The roads of `--split`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Road {
    /// Every light on every pixel: plain deferred shading, another sum.
    None,
    /// All lights at one pixel of each pattern, interpolated: another sum.
    Subsample,
    /// One pass over the un-split G-buffer, each pixel looping over its own subset.
    Branch,
    /// A dispatch a subset over the un-split G-buffer, at the pattern's stride.
    Indirect,
    /// The same in one dispatch, workgroups numbered by subset.
    Remap,
    /// A copy into sub-buffers in one pass.
    OnePass,
}

impl Road {
    /// The value of `--split`.
    pub fn from_setting(text: &str) -> Self {
        match text {
            "none" => Self::None,
            "subsample" => Self::Subsample,
            "branch" => Self::Branch,
            "indirect" => Self::Indirect,
            "remap" => Self::Remap,
            "one-pass" => Self::OnePass,
            other => panic!("--split {other} was checked"),
        }
    }

    /// Whether it copies the G-buffer into sub-buffers, and the irradiance back.
    pub fn copies(self) -> bool {
        self == Self::OnePass
    }

    /// Whether all lights are summed at each pixel that is shaded.
    pub fn sums_all(self) -> bool {
        matches!(self, Self::None | Self::Subsample)
    }
}
