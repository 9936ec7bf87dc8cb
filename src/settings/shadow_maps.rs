//! The rows of techniques that light by shadow maps (`passes::shadow_maps`).
//!
//! The biases are those at which pictures of three scenes came nearest to shadow rays: with maps of 512 at 480x270,
//! FLIP of the hall (80,000 triangles), `lamps` (27 lamps) and `fence` (30) is 0.028, 0.0075 and 0.0055 at 0.03 % and 2
//! texels; 0.152, 0.0088 and 0.027 without a slope's part, where surfaces shadow themselves; 0.032, 0.0083 and 0.0075
//! at 0.0001 %; at 0.1 % the RMSE of the fence is 0.103 instead of 0.061.

use super::tables::{DirectShadow, GeometryChoice};
use super::{Changes, Kind, Setting, Unread, Values};
use crate::choice::choices;

/// `DIRECT_SHADOW` with shadow maps among its choices.
pub const MAPPED_DIRECT_SHADOW: Setting = Setting {
    key: "direct-shadow",
    kind: Kind::Choice(DirectShadow::WORDS),
    default: "sun",
    paper: "map: Clarberg 2014, 6",
    help: "Lights that cast shadows, and how: none; directional lights by rays (sun); every punctual light by rays \
           (ray); or, with techniques that have them, every punctual light by shadow maps (map)",
    ..Setting::changing(Changes::Picture)
};

choices! {
    /// When shadow maps are drawn (`--shadow-maps`).
    pub enum MapDrawing {
        /// In every frame and set of samples.
        "frame" => Frame,
        /// Before the first.
        "once" => Once,
    }
}

choices! {
    /// How a map is asked (`--shadow-filter`).
    pub enum MapFilter {
        /// One comparison.
        "nearest" => Nearest,
        /// Four, filtered by the sampler.
        "bilinear" => Bilinear,
        /// Four, filtered by the shader.
        "gather" => Gather,
    }
}

/// How shadow maps are made and read; nothing reads it where there are none.
pub const SHADOW_MAPS: &[Setting] = &[
    Setting {
        key: "shadow-maps",
        kind: Kind::Choice(MapDrawing::WORDS),
        default: "frame",
        paper: "Clarberg 2014, 6.2",
        help: "When shadow maps are drawn: anew in every frame and set of samples, as in the paper (frame), or once \
               before the first, with their time in a row of its own (once); the same picture",
        unread: without_maps,
        ..Setting::changing(Changes::Nothing)
    },
    Setting {
        key: "shadow-map-size",
        kind: Kind::Integer { min: 16, max: 8192 },
        default: "1024",
        unit: "px",
        paper: "Clarberg 2014, 6.2",
        help: "Width and height of a shadow map; spot and directional lights have one map each, point lights and spots \
               wider than 178 degrees six each",
        unread: without_maps,
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "shadow-filter",
        kind: Kind::Choice(MapFilter::WORDS),
        auto: true,
        default: "auto",
        help: "How a shadow map is read: by one comparison (nearest), or by four weighted by distance, in the device's \
               filter (bilinear) or, where depth formats cannot be filtered, in the shader (gather, the plain way to \
               the same picture); auto: bilinear where the device has it, gather elsewhere",
        unread: without_maps,
        ..Setting::changing(Changes::Picture)
    },
    SHADOW_BIAS_M,
    SHADOW_SLOPE_BIAS,
    SHADOW_CASTERS,
];

pub const SHADOW_BIAS_M: Setting = Setting {
    key: "shadow-bias",
    kind: Kind::Length,
    default: "0.03%",
    unit: "m",
    help: "Distance by which a point moves towards the light before its shadow map is read, to cover rounding",
    unread: without_maps,
    ..Setting::changing(Changes::Picture)
};

pub const SHADOW_SLOPE_BIAS: Setting = Setting {
    key: "shadow-slope-bias",
    kind: Kind::Number { min: 0.0, max: 64.0 },
    default: "2",
    unit: "px",
    help: "Slope bias: surfaces in a shadow map are moved away from the light by the change of their depth over \
           this many texels; 2 is the reach of four comparisons",
    unread: without_maps,
    ..Setting::changing(Changes::Picture)
};

pub const SHADOW_CASTERS: Setting = Setting {
    key: "shadow-casters",
    kind: Kind::Choice(GeometryChoice::WORDS),
    default: "culled",
    help: "Triangles to draw into a shadow map: only the clusters that it may hold (culled), or all of them (the \
           plain way to the same bits)",
    unread: without_maps,
    ..Setting::changing(Changes::Nothing)
};

fn without_maps(values: &Values) -> Option<Unread> {
    Unread::unless(values, MAPPED_DIRECT_SHADOW.key, &[DirectShadow::Map], "there are no shadow maps")
}
