//! The settings of inferred lighting.

use super::encoding::FIXED_LIMIT;
use super::layer_names;
use crate::settings::{
    BRDF, CULL_BY, Condition, DEPTH_PREPASS, DIRECT_SHADOW, GEOMETRY, Kind, MOTION_INTERVAL, MOTION_VECTORS,
    NORMAL_THRESHOLD, Setting, TEXELS, Unread, WORKGROUP,
};

/// Its rows of the table.
pub const SETTINGS: &[Setting] = &[
    BRDF,
    GEOMETRY,
    DIRECT_SHADOW,
    DEPTH_PREPASS,
    CULL_BY,
    TEXELS,
    WORKGROUP,
    NORMAL_THRESHOLD,
    Setting {
        key: "light-size",
        symbol: "",
        kind: Kind::PairOrAuto { min: 1, max: 16384 },
        default: "auto",
        unit: "px",
        paper: "Kircher 2009, 2.2",
        help: "width and height of the geometry pass and the light pass; auto: 0.625 of the frame, 800x450 of 1280x720",
    },
    Setting {
        key: "extras",
        symbol: "",
        kind: Kind::Choice(&["on", "off"]),
        default: "on",
        unit: "",
        paper: "Kircher 2009, 2.1",
        help: "the geometry pass writes roughness and material id, 4 bytes a texel; off: every highlight is as wide as \
               --light-roughness says",
    },
    Setting {
        key: "light-roughness",
        symbol: "",
        kind: Kind::Number { min: 0.0, max: 1.0 },
        default: "0.5",
        unit: "",
        paper: "Kircher 2009, 2.2",
        help: "of every surface in the light pass, with --extras off",
    },
    MOTION_VECTORS,
    MOTION_INTERVAL,
    Setting {
        key: "volumes",
        symbol: "",
        kind: Kind::Choice(&["tiled", "quad", "scissor", "stencil", "both", "auto"]),
        default: "tiled",
        unit: "",
        paper: "Kircher 2009, 2.2",
        help: "how texels meet their lights: in one dispatch with a list of lights a tile (tiled), or in a draw a light, over \
               the frame (quad), within the rectangle that bounds what it reaches (scissor), where its volume meets a surface \
               (stencil, depth-fail), or both; auto: both, but for lights smaller than --stencil-least, which go without",
    },
    Setting {
        key: "stencil-least",
        symbol: "",
        kind: Kind::Integer { min: 0, max: 1 << 28 },
        default: "4096",
        unit: "texels",
        paper: "Kircher 2009, 2.2",
        help: "of --volumes auto: a light whose rectangle has fewer texels is drawn without the stencil (lavapipe: it pays from some \
               16384 on, and below makes no difference)",
    },
    Setting {
        key: "shadow-volumes",
        symbol: "",
        kind: Kind::Integer { min: 0, max: 65_536 },
        default: "0",
        unit: "lights",
        paper: "Kircher 2009, 4, 7",
        help: "how many lights cast stencil shadow volumes of all closed opaque and MASK surfaces, instead of the rays of \
               --direct-shadow: directional lights first, then those of most flux; not with --volumes tiled",
    },
    Setting {
        key: "l-buffer",
        symbol: "",
        kind: Kind::Choice(&["float", "half", "fixed"]),
        default: "float",
        unit: "",
        paper: "Kircher 2009, 2.2, 5.1",
        help: "how lights sum up: in 32 bits, packed once, to half floats (float) or to 16 bits of fixed point (fixed); or \
               blended in half floats as in the paper (half)",
    },
    Setting {
        key: "light-range",
        symbol: "",
        kind: Kind::Number { min: 0.001, max: 65504.0 },
        default: "32",
        unit: "lx",
        paper: "Kircher 2009, 5.1",
        help: "of --l-buffer fixed: the most light; what is brighter is held there, and counted",
    },
    Setting {
        key: "packing",
        symbol: "",
        kind: Kind::Choice(&["words", "rgba8", "fixed"]),
        default: "words",
        unit: "",
        paper: "Kircher 2009, 5",
        help: "what the geometry pass draws a texel's two 16-bit numbers into: one word, the bytes of four channels, or two \
               channels of fixed point",
    },
    Setting {
        key: "fixed-range",
        symbol: "",
        kind: Kind::Number { min: 1.0, max: FIXED_LIMIT },
        default: "32",
        unit: "",
        paper: "Kircher 2009, 5.1",
        help: "of --packing fixed, whose format goes from -32 to 32: how far numbers from -1 to 1 are scaled; 32 uses every \
               step of it, 1 a 32nd of them",
    },
    Setting {
        key: "light-filter",
        symbol: "",
        kind: Kind::Choice(&["dsf", "bilinear", "nearest", "bilateral", "discontinuity"]),
        default: "dsf",
        unit: "",
        paper: "Kircher 2009, 3",
        help: "how four texels of the light buffer become the light of a pixel: the discontinuity sensitive filter, which takes those \
               of its object and normal group; bilinear, or the nearest one, whatever they show; by normal and distance from the \
               tangent plane, in weights that fall off (joint bilateral), or yes or no (discontinuity: Segovia 2006, 4.5)",
    },
    Setting {
        key: "light-fetch",
        symbol: "",
        kind: Kind::Choice(&["texels", "sampler"]),
        default: "texels",
        unit: "",
        paper: "Kircher 2009, 7.1",
        help: "of a solid surface's pixel whose four texels all belong to it: they are read one by one, or blended by the sampler in a \
               single fetch, as finely as the device places it",
    },
    Setting {
        key: "depth-threshold",
        symbol: "",
        kind: Kind::Number { min: 0.0, max: 1.0 },
        default: "0.05",
        unit: "",
        paper: "Kircher 2009, 3.1",
        help: "of the filter: by what part of its depth a sample's may be off, or, where normals decide, its place off the tangent plane",
    },
    Setting {
        key: "alpha",
        symbol: "",
        kind: Kind::Choice(&["blend", "test"]),
        default: "blend",
        unit: "",
        paper: "Kircher 2009, 4, 6",
        help: "BLEND surfaces: stippled into the light buffer and blended, or drawn as solid where their alpha is 0.5 and more",
    },
    Setting {
        key: "stipple",
        symbol: "",
        kind: Kind::Choice(&["2x2", "4x4"]),
        default: "2x2",
        unit: "px",
        paper: "Kircher 2009, 4",
        help: "which texels BLEND surfaces are lit at: one in four (3 layers over the solid one) or in sixteen (15)",
    },
    Setting {
        key: "assignment",
        symbol: "",
        kind: Kind::Choice(&["overlap", "depth", "static"]),
        default: "overlap",
        unit: "",
        paper: "Kircher 2009, 4, 7.1",
        help: "how BLEND surfaces share the layers of the stipple: those that overlap on screen get different ones, nearest \
               first (ours); by turns from the nearest on; or as the user says, the rest by turns in the order of the file",
    },
    Setting {
        key: "stipple-layers",
        symbol: "",
        kind: Kind::Text("NAME=LAYER,...|none"),
        default: layer_names::NONE,
        unit: "",
        paper: "Kircher 2009, 4",
        help: "of --assignment static: layers of the stipple, 1 to 3 or 15, for BLEND surfaces by the name of their node or \
               material; before quincunx_stipple_layer in the extras of a file's nodes and materials",
    },
    Setting {
        key: "alpha-filter",
        symbol: "",
        kind: Kind::Choice(&["cone", "bilinear"]),
        default: "cone",
        unit: "",
        paper: "Kircher 2009, 4",
        help: "of the four samples nearest to a fragment of a BLEND surface: weights that fall to 0 at --cone-radius, or \
               bilinear ones",
    },
    Setting {
        key: "cone-radius",
        symbol: "",
        kind: Kind::Number { min: 0.1, max: 64.0 },
        default: "2",
        unit: "texels",
        paper: "Kircher 2009, 4",
        help: "of --alpha-filter cone, in texels of the light buffer; with --stipple 4x4 twice as much",
    },
];

/// What its settings leave unread of each other.
pub const CONDITIONS: &[Condition] = &[
    Condition {
        key: "light-roughness",
        unread: |values| Unread::unless(values, "extras", &["off"], "each texel has its own roughness"),
    },
    Condition {
        key: "stencil-least",
        unread: |values| Unread::unless(values, "volumes", &["auto"], "all lights are drawn alike"),
    },
    Condition {
        key: CULL_BY.key,
        unread: |values| Unread::unless(values, "volumes", &["tiled"], "there are no tiles"),
    },
    Condition {
        key: "fixed-range",
        unread: |values| Unread::unless(values, "packing", &["fixed"], "it packs without fixed point"),
    },
    Condition {
        key: "cone-radius",
        unread: |values| Unread::unless(values, "alpha-filter", &["cone"], "its weights have no radius"),
    },
];
