//! The rows of what lies between a surface and the film, which several techniques read.

use super::{Kind, Part, Setting};

/// A homogeneous medium that fills the scene.
pub const MEDIUM: Setting = Setting {
    key: "medium",
    symbol: "",
    kind: Kind::PartsOrNone(&[
        Part { word: "S", min: 0.0, max: 1e6 },
        Part { word: "A", min: 0.0, max: 1e6 },
        Part { word: "G", min: -0.99, max: 0.99 },
    ]),
    default: "none",
    unit: "1/m",
    paper: "Dubla 2009, 3.4",
    help: "light that a homogeneous medium scatters (S) and absorbs (A) a metre, and the mean cosine of the angle by which it \
           turns it (G, Henyey-Greenstein); it fills the box around all that is drawn, the eye and the lights",
};
