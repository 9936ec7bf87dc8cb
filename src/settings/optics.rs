//! The rows of what lies between a surface and the film, which several techniques read.

use super::{Changes, Kind, Part, Setting, Unread, Values};
use crate::choice::choices;
use crate::error::{Error, Result};

/// How wide the lens is.
pub const APERTURE: Setting = Setting {
    key: "aperture",
    kind: Kind::Number { min: 0.0, max: 1e6 },
    default: "0",
    unit: "m",
    paper: "Clarberg 2014, table 3",
    help: "Diameter of the camera's thin lens, which blurs what is out of focus; 0: a pinhole, all is sharp",
    ..Setting::changing(Changes::Picture)
};

/// Distance at which the lens makes a sharp picture.
pub const FOCUS: Setting = Setting {
    key: "focus",
    kind: Kind::Number { min: 1e-6, max: 1e9 },
    auto: true,
    default: "auto",
    unit: "m",
    help: "Distance from the camera to the plane in focus, for --aperture and --stereo; auto: the surface at the \
           middle of the picture, or, where there is none, the middle of the scene",
    unread: |values| match values.number(STEREO.key) > 0.0 {
        true => None,
        false => Unread::without(values, APERTURE.key, "through a pinhole all is sharp"),
    },
    ..Setting::changing(Changes::Picture)
};

/// How far two eyes are apart.
pub const STEREO: Setting = Setting {
    key: "stereo",
    kind: Kind::Number { min: 0.0, max: 1e6 },
    default: "0",
    unit: "m",
    paper: "Clarberg 2014, 7",
    help: "Distance between two eyes, one to the left and one to the right of the camera, each with a lens of \
           --aperture; both see what lies at --focus in the same place of the picture, and the picture written is the \
           left eye's; 0: one eye, the camera's",
    ..Setting::changing(Changes::Picture)
};

choices! {
    /// Which of two eyes see (`--stereo-eyes`).
    pub enum StereoEyes {
        "both" => Both,
        "left" => Left,
        "right" => Right,
    }
}

/// Which of the two eyes see.
pub const STEREO_EYES: Setting = Setting {
    key: "stereo-eyes",
    kind: Kind::Choice(StereoEyes::WORDS),
    default: "both",
    paper: "Clarberg 2014, 7",
    help: "Eyes of --stereo to draw: both, which deep_shading shades at once as seen from the midpoint between them, \
           with the right eye's picture in the stage stereo.right; or one eye alone, as seen by that eye",
    unread: |values| Unread::without(values, STEREO.key, "there is one eye"),
    ..Setting::changing(Changes::Picture)
};

/// How long the film is exposed.
pub const SHUTTER: Setting = Setting {
    key: "shutter",
    kind: Kind::PartsOrNone(&[Part { word: "OPEN", min: -1e9, max: 1e9 }, Part { word: "CLOSE", min: -1e9, max: 1e9 }]),
    default: "none",
    unit: "s",
    paper: "Keller 2001, 3.2",
    help: "Times at which the shutter opens and closes, relative to --time; what animations move in between is blurred \
           along straight lines from its place at opening to its place at closing; none: a single moment",
    ..Setting::changing(Changes::Picture)
};

/// Whether a G-buffer holds how surfaces move on the screen.
pub const MOTION_VECTORS: Setting = Setting {
    key: "motion-vectors",
    kind: Kind::Choice(&["off", "on"]),
    default: "off",
    paper: "Kircher 2009, 2.1",
    help: "Write motion vectors in the geometry pass: how far each surface has moved on the screen since \
           --motion-interval before --time, in texels right and down, as two half floats in 4 bytes a texel (--aov \
           geometry.motion)",
    ..Setting::changing(Changes::Nothing)
};

/// How long before `--time` motion vectors begin.
pub const MOTION_INTERVAL: Setting = Setting {
    key: "motion-interval",
    kind: Kind::Number { min: 0.0, max: 1e6 },
    default: "0.0333333333",
    unit: "s",
    paper: "Kircher 2009, 2.1",
    help: "Time of one frame, over which --motion-vectors are measured; motion begins at 0 s at the earliest",
    unread: |values| Unread::unless(values, MOTION_VECTORS.key, &["on"], "there are no motion vectors"),
    ..Setting::changing(Changes::Nothing)
};

/// The moment at which motion vectors begin, seconds, at least 0; None where none are asked for, or the technique reads
/// no such setting.
pub fn earlier_s(values: &Values) -> Option<f64> {
    let is_asked = values.get(MOTION_VECTORS.key) == Some("on");
    is_asked.then(|| (values.number("time") - values.number("motion-interval")).max(0.0))
}

/// The moments of `--time` and `--shutter` at which the shutter opens and closes, seconds; the same one where there is
/// no shutter, or the technique reads none.
///
/// Errors: it closes before it opens (exit code 2).
pub fn exposure_s(values: &Values) -> Result<[f64; 2]> {
    let time_s = values.number("time");
    let shutter = values.get(SHUTTER.key).and_then(|_| values.numbers_or_none(SHUTTER.key));
    let Some([open_s, close_s]) = shutter else {
        return Ok([time_s; 2]);
    };
    if open_s > close_s {
        let text = values.text("shutter");
        return Err(Error::request(format!("--shutter {text}: it closes before it opens"))
            .note(format!("--shutter {close_s},{open_s} is the same time in order")));
    }
    Ok([time_s + open_s, time_s + close_s])
}

/// How large point and spot lights are.
pub const LIGHT_RADIUS: Setting = Setting {
    key: "light-radius",
    kind: Kind::Number { min: 0.0, max: 1e6 },
    default: "0",
    unit: "m",
    paper: "Dubla 2009, 3.3",
    help: "Radius of the sphere that a point or spot light is, alike bright all over: its shadows have penumbrae; far off \
           it is as bright as the light has it, and inside it is dark. 0: lights are points, whose shadows are hard",
    ..Setting::changing(Changes::Picture)
};

/// `--light-radius` in metres; 0 where the technique reads no such setting.
pub fn light_radius_m(values: &Values) -> f32 {
    values.get(LIGHT_RADIUS.key).map_or(0.0, |_| values.number(LIGHT_RADIUS.key) as f32)
}

/// A homogeneous medium that fills the scene.
pub const MEDIUM: Setting = Setting {
    key: "medium",
    kind: Kind::PartsOrNone(&[
        Part { word: "S", min: 0.0, max: 1e6 },
        Part { word: "A", min: 0.0, max: 1e6 },
        Part { word: "G", min: -0.99, max: 0.99 },
    ]),
    auto: true,
    default: "auto",
    unit: "1/m",
    paper: "Dubla 2009, 3.4",
    help: "Homogeneous medium: its coefficients of scattering (S) and absorption (A), and the mean cosine of the \
           scattering angle (G, Henyey-Greenstein); it fills the box around all that is drawn, the eye and the lights; \
           auto: the scene's own, which of the built-in ones office:smoke=on has, else none",
    ..Setting::changing(Changes::Picture)
};
