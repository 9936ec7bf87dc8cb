//! The settings of interleaved deferred shading.

use crate::settings::{Condition, EMISSIVE, Kind, NORMAL_THRESHOLD, Setting, Unread, VPL_CLAMP, Values};

/// Its rows of the table.
pub const SETTINGS: &[Setting] = &[
    Setting {
        key: "pattern",
        symbol: "n x m",
        kind: Kind::Pair { min: 1, max: 64 },
        default: "4x4",
        unit: "px",
        paper: "Segovia 2006, 3",
        help: "the interleaved pattern: each of its pixels has a light subset of its own",
    },
    Setting {
        key: "split",
        symbol: "",
        kind: Kind::Choice(&[
            "none",
            "subsample",
            "stencil",
            "depth",
            "branch",
            "indirect",
            "remap",
            "one-pass",
            "two-pass",
            "tile",
            "layered",
            "fragment",
        ]),
        default: "one-pass",
        unit: "",
        paper: "Segovia 2006, 3.1-3.3, 4.2",
        help: "how pixels meet their subset: every light on every pixel (none), all lights at one pixel of a pattern \
               (subsample); a draw a subset, its pixels chosen by a test (stencil, depth), each pixel looping over its \
               own (branch), a subset at a time at the pattern's stride, in a dispatch each (indirect) or in one \
               (remap); or a copy into n x m sub-buffers and back: in one pass, in two by blocks, through workgroup \
               memory (tile), into the layers of an image (layered), by fragment programs and look-up textures (fragment)",
    },
    Setting {
        key: "storage",
        symbol: "",
        kind: Kind::Choice(&["auto", "buffer", "image"]),
        default: "auto",
        unit: "",
        paper: "Segovia 2006, figure 3",
        help: "where sub-buffers lie: in storage buffers, two texels a thread, or tiled in images; auto: buffer on software \
               drivers, image elsewhere and where the road knows nothing else",
    },
    Setting {
        key: "copy",
        symbol: "",
        kind: Kind::Choice(&["pull", "push"]),
        default: "pull",
        unit: "",
        paper: "",
        help: "what a thread of a copy stands for: a texel written (pull) or a texel read (push); a pair in buffers",
    },
    Setting {
        key: "block",
        symbol: "p x q",
        kind: Kind::Sides { min: 1, max: 1024 },
        default: "16",
        unit: "px",
        paper: "Segovia 2006, 3.3",
        help: "of the splits in blocks: two-pass, tile, fragment in two passes; rounded up to whole patterns",
    },
    Setting {
        key: "fragment-passes",
        symbol: "",
        kind: Kind::Integer { min: 1, max: 2 },
        default: "2",
        unit: "",
        paper: "Segovia 2006, 3.2, 4.2",
        help: "of --split fragment: one with one look-up texture, or block splitting and block translation",
    },
    Setting {
        key: "vpls",
        symbol: "",
        kind: Kind::Integer { min: 1, max: 65_536 },
        default: "256",
        unit: "",
        paper: "Segovia 2006, 6",
        help: "virtual point lights, made by Instant Radiosity",
    },
    Setting {
        key: "vpl-bounces",
        symbol: "",
        kind: Kind::Integer { min: 1, max: 16 },
        default: "1",
        unit: "",
        paper: "Segovia 2006, 6.2",
        help: "surfaces that a light walk lands on at most",
    },
    VPL_CLAMP,
    EMISSIVE,
    Setting {
        key: "direct",
        symbol: "",
        kind: Kind::Choice(&["full", "interleaved", "none"]),
        default: "full",
        unit: "",
        paper: "Segovia 2006, 4.6",
        help: "the scene's own lights: shaded on every pixel by --brdf, joined to the subsets as diffuse light, or left out",
    },
    Setting {
        key: "blend-lights",
        symbol: "",
        kind: Kind::Choice(&["subset", "all"]),
        default: "subset",
        unit: "",
        paper: "",
        help: "virtual point lights of BLEND surfaces, which no filter smooths: those of the pixel's subset, or all",
    },
    Setting {
        key: "direct-pattern",
        symbol: "i x j",
        kind: Kind::PairOrAuto { min: 1, max: 64 },
        default: "auto",
        unit: "px",
        paper: "Segovia 2006, 4.6",
        help: "of --direct interleaved: the pattern of the scene's own lights, which divides --pattern and is made of \
               clusters of its sub-buffers; fewer pixels share them out, so each has more of them; auto: --pattern",
    },
    Setting {
        key: "filter",
        symbol: "",
        kind: Kind::Choice(&["gauss", "gauss-fast", "none"]),
        default: "gauss",
        unit: "",
        paper: "Segovia 2006, 4.5",
        help: "of the interleaved irradiance; a picture that is not interleaved (--split none, or 1x1) is not filtered",
    },
    Setting {
        key: "kernel",
        symbol: "",
        kind: Kind::Integer { min: 5, max: 17 },
        default: "5",
        unit: "px",
        paper: "Segovia 2006, tables 2 and 3",
        help: "taps of the filter in one direction, odd",
    },
    Setting {
        key: "fuse",
        symbol: "",
        kind: Kind::Choice(&["off", "on"]),
        default: "off",
        unit: "",
        paper: "",
        help: "of --filter gauss: on, the composite walks the filter's columns, and a gather in one pass that pulls walks its rows; the \
               same pixels with fewer passes, and fewer stages to time and to look at",
    },
    Setting {
        key: "sigma",
        symbol: "",
        kind: Kind::Number { min: 0.0, max: 64.0 },
        default: "0",
        unit: "px",
        paper: "",
        help: "standard deviation of the filter; 0: a third of the kernel, which weighs the pixels of a 4x4 pattern most evenly",
    },
    Setting {
        key: "discontinuity",
        symbol: "",
        kind: Kind::Choice(&["directional", "any"]),
        default: "directional",
        unit: "",
        paper: "Segovia 2006, 4.5",
        help: "what ends a walk of the filter: a discontinuity in its own direction, or in any of the three (the paper's \
               one flag, which leaves pixels along an edge unfiltered)",
    },
    NORMAL_THRESHOLD,
    Setting {
        key: "position-threshold",
        symbol: "",
        kind: Kind::Length,
        default: "0.5%",
        unit: "m",
        paper: "Segovia 2006, 4.5",
        help: "a neighbour is across a discontinuity where it lies farther off the pixel's tangent plane",
    },
];

/// Splits that copy into sub-buffers.
const COPYING: &[&str] = &["one-pass", "two-pass", "tile", "layered", "fragment"];

/// Every pixel that is shaded has all lights.
fn sums_all(values: &Values) -> Option<Unread> {
    Unread::with(values, "split", &["none", "subsample"], "every light is summed")
}

/// Nothing is interleaved that a filter would smooth.
fn is_even(values: &Values) -> Option<Unread> {
    sums_all(values).or_else(|| Unread::with(values, "pattern", &["1x1"], "nothing is interleaved"))
}

fn is_unfiltered(values: &Values) -> Option<Unread> {
    is_even(values).or_else(|| Unread::unless(values, "filter", &["gauss", "gauss-fast"], "nothing is filtered"))
}

/// What its settings leave unread of each other.
pub const CONDITIONS: &[Condition] = &[
    Condition {
        key: "pattern",
        unread: |values| Unread::with(values, "split", &["none"], "every pixel has all lights"),
    },
    Condition { key: "storage", unread: |values| Unread::unless(values, "split", COPYING, "it copies nothing") },
    Condition { key: "copy", unread: |values| Unread::unless(values, "split", COPYING, "it copies nothing") },
    Condition {
        key: "block",
        unread: |values| {
            Unread::unless(values, "split", &["two-pass", "tile", "fragment"], "it has no blocks").or_else(|| {
                let draws = values.text("split") == "fragment";
                let passes = || Unread::unless(values, "fragment-passes", &["2"], "one pass has no blocks");
                if draws { passes() } else { None }
            })
        },
    },
    Condition {
        key: "fragment-passes",
        unread: |values| Unread::unless(values, "split", &["fragment"], "it has no fragment programs"),
    },
    Condition { key: "blend-lights", unread: is_even },
    Condition { key: "brdf", unread: |values| Unread::with(values, "direct", &["none"], "no light is direct") },
    Condition { key: "cull", unread: |values| Unread::with(values, "direct", &["none"], "no light is direct") },
    Condition {
        key: "direct-pattern",
        unread: |values| {
            Unread::unless(values, "direct", &["interleaved"], "no punctual light is in a subset")
                .or_else(|| sums_all(values))
        },
    },
    Condition { key: "filter", unread: is_even },
    Condition { key: "kernel", unread: is_unfiltered },
    Condition { key: "sigma", unread: is_unfiltered },
    Condition { key: "discontinuity", unread: is_unfiltered },
    Condition { key: "normal-threshold", unread: is_unfiltered },
    Condition { key: "position-threshold", unread: is_unfiltered },
    Condition {
        key: "fuse",
        unread: |values| {
            is_even(values)
                .or_else(|| Unread::unless(values, "filter", &["gauss"], "no pass walks rows and columns of buffers"))
        },
    },
];
