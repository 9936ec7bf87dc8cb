//! The settings of path tracing.

use crate::settings::{
    APERTURE, BRDF, Condition, EMISSIVE, FOCUS, Kind, MEDIUM, SHUTTER, STEREO, STEREO_EYES, Setting, Unread, VPL_CLAMP,
    Values, WORKGROUP,
};

/// Paths a pixel, at most: float sums of more lose what a path adds.
pub const MOST_SAMPLES: u32 = 1 << 16;
const DEFAULT_SAMPLES: u32 = 64;

/// What --until-error asks for; None: nothing.
pub fn until_error(values: &Values) -> Option<f64> {
    Some(values.number("until-error")).filter(|error| *error > 0.0)
}

/// Paths a pixel, at most where `until_error` ends them.
pub fn sample_count(values: &Values) -> u32 {
    let auto = if until_error(values).is_some() { MOST_SAMPLES } else { DEFAULT_SAMPLES };
    values.integer_or_auto("spp").map_or(auto, |count| count as u32)
}

/// Its rows of the table.
pub const SETTINGS: &[Setting] = &[
    Setting {
        key: "spp",
        symbol: "",
        kind: Kind::IntegerOrAuto { min: 1, max: MOST_SAMPLES as u64 },
        default: "auto",
        unit: "",
        paper: "",
        help: "paths a pixel, one a run of the frame, at most where --until-error ends them; auto: 64, with --until-error 65536",
    },
    Setting {
        key: "until-error",
        symbol: "",
        kind: Kind::Number { min: 0.0, max: 1.0 },
        default: "0",
        unit: "",
        paper: "",
        help: "paths go on until the estimated relative standard error of the pixels, root of the mean square, is at most this, \
               or --spp is reached; 0: all of --spp",
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
        key: "ambient-visibility",
        symbol: "",
        kind: Kind::Choice(&["on", "off"]),
        default: "on",
        unit: "",
        paper: "",
        help: "--ambient and --background light surfaces from all around: stopped by what stands between, and scattered on; off: each \
               surface that is seen sends all of --ambient on, which goes no further, and --background is seen and lights nothing, as \
               in all other techniques",
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
    Setting {
        key: "rays",
        symbol: "",
        kind: Kind::Choice(&["tree", "query"]),
        default: "tree",
        unit: "",
        paper: "",
        help: "what rays go through: a tree of this program's, walked by the shader; or the driver's own acceleration structure, by \
               ray queries, where the device has them. The same picture, but for rays that graze an edge",
    },
    Setting {
        key: "texture-level",
        symbol: "",
        kind: Kind::Choice(&["0", "cone"]),
        default: "0",
        unit: "",
        paper: "",
        help: "which level of a texture rays read: 0, the finest, which the paths of a pixel average; or the one whose texels are as \
               wide as the ray's cone, which wants fewer paths, blurs where surfaces are seen at a slant, and takes a third more memory",
    },
    APERTURE,
    FOCUS,
    STEREO,
    STEREO_EYES,
    SHUTTER,
    MEDIUM,
    EMISSIVE,
    VPL_CLAMP,
    BRDF,
    WORKGROUP,
];

/// What its settings leave unread of each other.
pub const CONDITIONS: &[Condition] = &[
    Condition {
        key: "bounces",
        unread: |values| Unread::unless(values, "transport", &["full"], "it says itself how often light is scattered"),
    },
    Condition {
        key: "stack-entries",
        unread: |values| Unread::unless(values, "stack", &["short"], "it has room for all that can wait"),
    },
];
