//! How stippled surfaces get their layers.

/// How layers are given out (`--assignment`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Assignment {
    /// As the user says; the rest in rotation, in the order of the file.
    Static,
    /// By turns, from the nearest on.
    Depth,
    /// Overlapping draws get different ones, nearest first.
    Overlap,
}

impl Assignment {
    /// The value of `--assignment`.
    pub fn from_setting(text: &str) -> Self {
        match text {
            "static" => Self::Static,
            "depth" => Self::Depth,
            "overlap" => Self::Overlap,
            other => panic!("--assignment {other} was checked"),
        }
    }
}

/// Layers of a stipple of `side` texels a side that BLEND draws can have.
pub fn layer_count(side: u32) -> u32 {
    side * side - 1
}
