//! The settings of path tracing.

use crate::settings::{APERTURE, BRDF, EMISSIVE, FOCUS, Kind, MEDIUM, SHUTTER, Setting, VPL_CLAMP, WORKGROUP};

/// Its rows of the table.
pub const SETTINGS: &[Setting] = &[
    Setting {
        key: "spp",
        symbol: "",
        kind: Kind::Integer { min: 1, max: 65_536 },
        default: "64",
        unit: "",
        paper: "",
        help: "paths a pixel, one a run of the frame",
    },
    Setting {
        key: "transport",
        symbol: "",
        kind: Kind::Choice(&["direct", "one-bounce", "single-scatter", "full"]),
        default: "full",
        unit: "",
        paper: "",
        help: "light that is counted: straight from lights, or scattered by one surface more; scattered once, by a surface or by \
               --medium; or as often as --bounces says, by either. The first two are dimmed by --medium, and lose what it scatters",
    },
    Setting {
        key: "bounces",
        symbol: "",
        kind: Kind::Integer { min: 1, max: 64 },
        default: "16",
        unit: "",
        paper: "",
        help: "of --transport full: surfaces, or places of --medium, that scatter a path at most; from the fourth on it may end by chance, unbiased",
    },
    Setting {
        key: "light-visibility",
        symbol: "",
        kind: Kind::Choice(&["on", "off"]),
        default: "on",
        unit: "",
        paper: "",
        help: "the scene's own lights cast shadows; off: they shine through everything",
    },
    Setting {
        key: "vpl-visibility",
        symbol: "",
        kind: Kind::Choice(&["on", "off"]),
        default: "on",
        unit: "",
        paper: "Segovia 2006, 6.2",
        help: "light between surfaces is stopped by what stands between; off: it is what infinitely many virtual point lights \
               without shadows give, diffuse and with --vpl-clamp, by a light walk of its own for each pixel",
    },
    Setting {
        key: "punctual",
        symbol: "",
        kind: Kind::Choice(&["on", "off"]),
        default: "on",
        unit: "",
        paper: "",
        help: "point, spot and directional lights; off: emissive triangles light the scene even where --emissive is auto",
    },
    APERTURE,
    FOCUS,
    SHUTTER,
    MEDIUM,
    EMISSIVE,
    VPL_CLAMP,
    BRDF,
    WORKGROUP,
];
