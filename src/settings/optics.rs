//! The rows of what lies between a surface and the film, which several techniques read.

use super::{Kind, Part, Setting};

/// How wide the lens is.
pub const APERTURE: Setting = Setting {
    key: "aperture",
    symbol: "",
    kind: Kind::Number { min: 0.0, max: 1e6 },
    default: "0",
    unit: "m",
    paper: "Clarberg 2014, table 3",
    help: "diameter of the camera's thin lens: what is out of focus is blurred; 0: a pinhole, all is sharp",
};

/// Where the lens makes a sharp picture of.
pub const FOCUS: Setting = Setting {
    key: "focus",
    symbol: "",
    kind: Kind::NumberOrAuto { min: 1e-6, max: 1e9 },
    default: "auto",
    unit: "m",
    paper: "",
    help: "of --aperture: how far before the camera the plane in focus lies; auto: where the middle of the picture sees \
           something, else through the middle of the scene",
};

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
