//! The rows of techniques that light by shadow maps (`passes::shadow_maps`).
//!
//! The biases are those at which pictures of three scenes came nearest to shadow rays: with maps of 512 at 480x270, FLIP of
//! the hall (80,000 triangles), `lamps` (27 lamps) and `fence` (30) is 0.028, 0.0075 and 0.0055 at 0.03 % and 2 texels; 0.152,
//! 0.0088 and 0.027 without a slope's part, where surfaces shadow themselves; 0.032, 0.0083 and 0.0075 at 0.0001 %; at 0.1 % the
//! RMSE of the fence is 0.103 instead of 0.061.

use super::{Condition, Kind, Setting, Unread, Values};

/// `DIRECT_SHADOW` with shadow maps among its choices.
pub const MAPPED_DIRECT_SHADOW: Setting = Setting {
    key: "direct-shadow",
    symbol: "",
    kind: Kind::Choice(&["none", "sun", "ray", "map"]),
    default: "sun",
    unit: "",
    paper: "Clarberg 2014, 6 (map)",
    help: "shadow rays to no light, to directional lights, or to every punctual light; or, with techniques that have them, \
           shadow maps of every punctual light",
};

/// How shadow maps are made and read.
pub const SHADOW_MAPS: &[Setting] = &[
    Setting {
        key: "shadow-maps",
        symbol: "",
        kind: Kind::Choice(&["frame", "once"]),
        default: "frame",
        unit: "",
        paper: "Clarberg 2014, 6.2",
        help: "when shadow maps are drawn: anew in every frame and set of samples, as the paper does, or once before the first, their \
               time in a row of its own; the same picture",
    },
    Setting {
        key: "shadow-map-size",
        symbol: "",
        kind: Kind::Integer { min: 16, max: 8192 },
        default: "1024",
        unit: "px",
        paper: "Clarberg 2014, 6.2",
        help: "side of a shadow map: one for each spot and directional light, six for each point light and for a spot wider \
               than 178 degrees",
    },
    Setting {
        key: "shadow-filter",
        symbol: "",
        kind: Kind::Choice(&["auto", "nearest", "bilinear", "gather"]),
        default: "auto",
        unit: "",
        paper: "",
        help: "how a shadow map is asked: one comparison, or four, weighed by their distance in the device's filter or, where \
               depth does not filter, in the shader (the plain way to the same picture); auto: bilinear where the device \
               has it, else gather",
    },
    Setting {
        key: "shadow-bias",
        symbol: "",
        kind: Kind::Length,
        default: "0.03%",
        unit: "m",
        paper: "",
        help: "a point asks its shadow map from this much nearer to the light: what rounding moves surfaces by",
    },
    Setting {
        key: "shadow-slope-bias",
        symbol: "",
        kind: Kind::Number { min: 0.0, max: 64.0 },
        default: "2",
        unit: "px",
        paper: "",
        help: "surfaces in a shadow map lie farther from the light by what their depth changes over this many of its texels: \
               2 is what four comparisons reach",
    },
    Setting {
        key: "shadow-casters",
        symbol: "",
        kind: Kind::Choice(&["culled", "all"]),
        default: "culled",
        unit: "",
        paper: "",
        help: "what is drawn into a shadow map: the clusters of triangles that it may hold, or all (the plain way to the same \
               bits)",
    },
];

fn without_maps(values: &Values) -> Option<Unread> {
    Unread::unless(values, MAPPED_DIRECT_SHADOW.key, &["map"], "there are no shadow maps")
}

/// `SHADOW_MAPS` are read where there are any.
pub const SHADOW_MAP_CONDITIONS: &[Condition] = &[
    Condition { key: "shadow-maps", unread: without_maps },
    Condition { key: "shadow-map-size", unread: without_maps },
    Condition { key: "shadow-filter", unread: without_maps },
    Condition { key: "shadow-bias", unread: without_maps },
    Condition { key: "shadow-slope-bias", unread: without_maps },
    Condition { key: "shadow-casters", unread: without_maps },
];
