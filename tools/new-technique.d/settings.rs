//! The settings that only this technique reads, and the common ones that it reads too.

use crate::settings::{BRDF, Changes, DIRECT_SHADOW, GEOMETRY, Kind, Setting, WORKGROUP};

pub const SETTINGS: &[Setting] = &[
    Setting {
        key: "light-scale",
        kind: Kind::Number { min: 0.0, max: 1000.0 },
        default: "1",
        help: "Factor of the light of the scene's lights on solid surfaces",
        ..Setting::changing(Changes::Picture)
    },
    BRDF,
    DIRECT_SHADOW,
    GEOMETRY,
    WORKGROUP,
];
