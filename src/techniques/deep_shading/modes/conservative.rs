//! `--conservative`.

/// How every pixel that a triangle touches is drawn (`--conservative`).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Conservative {
    /// By the device.
    Hardware,
    /// Its hull from a geometry shader.
    Geometry,
    /// Its hull from vertex shaders.
    Vertex,
    /// Only what it covers the middle of: samples at its rim find no colour.
    Plain,
}

impl Conservative {
    pub fn name(self) -> &'static str {
        match self {
            Self::Hardware => "hardware",
            Self::Geometry => "geometry",
            Self::Vertex => "vertex",
            Self::Plain => "none",
        }
    }
}
