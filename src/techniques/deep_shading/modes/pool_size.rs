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
        let side_px = values.text("shading-texture-size").parse().expect("it is one of a list");
        Self { count: values.integer("shading-textures") as u32, side_px }
    }
}
