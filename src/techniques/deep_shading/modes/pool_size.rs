//! How many textures are shaded, and how large (`--shading-textures`, `--shading-texture-size`).

use crate::settings::Values;

/// How many textures (`--shading-textures`), and how large (`--shading-texture-size`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PoolSize {
    pub count: u32,
    /// Texels of a side of the finest level: a power of two.
    pub side_px: u32,
}

impl PoolSize {
    pub fn of(values: &Values) -> Self {
        let [count, side_px] = ["shading-textures", "shading-texture-size"].map(|key| values.integer(key) as u32);
        Self { count, side_px }
    }
}
