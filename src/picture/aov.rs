//! Stages of a frame beside its picture, by name.

/// A layer beside the picture (an arbitrary output variable): `name.R`, `name.G`, `name.B` or `name.Y` in the EXR.
#[derive(Clone, Debug, PartialEq)]
pub struct Aov {
    /// ASCII, without a dot at either end: viewers group channels by what stands before the last dot.
    pub name: String,
    pub channels: AovChannels,
}

/// The numbers of an AOV, row-major, as many as the picture has pixels.
#[derive(Clone, Debug, PartialEq)]
pub enum AovChannels {
    /// Three channels: `name.R`, `name.G`, `name.B`.
    Rgb(Vec<[f32; 3]>),
    /// One channel: `name.Y`.
    Y(Vec<f32>),
    /// One channel of whole numbers, `name.Y`, 32 bits in either precision.
    YU32(Vec<u32>),
}

impl AovChannels {
    pub(super) fn pixel_count(&self) -> usize {
        match self {
            Self::Rgb(values) => values.len(),
            Self::Y(values) => values.len(),
            Self::YU32(values) => values.len(),
        }
    }
}
