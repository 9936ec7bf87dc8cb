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
        help: "Size of the interleaved pattern; each of its pixels has a light subset of its own",
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
        help: "How pixels get the light subset of their place in the pattern. Without subsets: every light on every \
               pixel (none), or all lights at one pixel of each pattern (subsample). Without a copy: one draw for each \
               subset, its pixels chosen by a test (stencil, depth); each pixel looping over its own subset (branch); \
               pixels of one subset together, at the pattern's stride, in a dispatch for each (indirect) or one for \
               all (remap). With a copy into n x m sub-buffers and back: in one pass (one-pass), in two passes by \
               blocks (two-pass), through workgroup memory (tile), into the layers of an image (layered), or by \
               fragment programs and look-up textures (fragment)",
    },
    Setting {
        key: "storage",
        symbol: "",
        kind: Kind::Choice(&["auto", "buffer", "image"]),
        default: "auto",
        unit: "",
        paper: "Segovia 2006, figure 3",
        help: "Where sub-buffers lie: in storage buffers, two texels a thread, or tiled in images; auto: images where \
               --split knows nothing else, otherwise buffers on software drivers and images elsewhere",
    },
    Setting {
        key: "copy",
        symbol: "",
        kind: Kind::Choice(&["pull", "push"]),
        default: "pull",
        unit: "",
        paper: "",
        help: "What a thread of a copy stands for: a texel that it writes (pull) or a texel that it reads (push), or a \
               pair of such texels in buffers",
    },
    Setting {
        key: "block",
        symbol: "p x q",
        kind: Kind::Sides { min: 1, max: 1024 },
        default: "16",
        unit: "px",
        paper: "Segovia 2006, 3.3",
        help: "Size of a block for --split two-pass and tile, and for fragment in two passes; rounded up to whole \
               patterns",
    },
    Setting {
        key: "fragment-passes",
        symbol: "",
        kind: Kind::Integer { min: 1, max: 2 },
        default: "2",
        unit: "",
        paper: "Segovia 2006, 3.2, 4.2",
        help: "Passes of --split fragment: 1 uses one look-up texture, 2 splits into blocks and then translates the \
               blocks",
    },
    Setting {
        key: "vpls",
        symbol: "",
        kind: Kind::Integer { min: 1, max: 65_536 },
        default: "256",
        unit: "",
        paper: "Segovia 2006, 6",
        help: "Number of virtual point lights, made by Instant Radiosity",
    },
    Setting {
        key: "vpl-bounces",
        symbol: "",
        kind: Kind::Integer { min: 1, max: 16 },
        default: "1",
        unit: "",
        paper: "Segovia 2006, 6.2",
        help: "Most surfaces that one light walk lands on",
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
        help: "How the scene's own lights are shaded: on every pixel by --brdf (full), in the subsets as diffuse light \
               (interleaved), or not at all (none)",
    },
    Setting {
        key: "blend-lights",
        symbol: "",
        kind: Kind::Choice(&["subset", "all"]),
        default: "subset",
        unit: "",
        paper: "",
        help: "Virtual point lights that shade BLEND surfaces, which no filter smooths: those of the pixel's subset, \
               or all",
    },
    Setting {
        key: "direct-pattern",
        symbol: "i x j",
        kind: Kind::PairOrAuto { min: 1, max: 64 },
        default: "auto",
        unit: "px",
        paper: "Segovia 2006, 4.6",
        help: "Pattern of the scene's own lights with --direct interleaved; it divides --pattern and is made of \
               clusters of its sub-buffers; with fewer pixels to share the lights, each has more of them; auto: \
               --pattern",
    },
    Setting {
        key: "filter",
        symbol: "",
        kind: Kind::Choice(&["gauss", "gauss-fast", "none"]),
        default: "gauss",
        unit: "",
        paper: "Segovia 2006, 4.5",
        help: "Filter of the interleaved irradiance; a picture that is not interleaved (--split none, or pattern 1x1) \
               is not filtered",
    },
    Setting {
        key: "kernel",
        symbol: "",
        kind: Kind::Integer { min: 5, max: 17 },
        default: "5",
        unit: "px",
        paper: "Segovia 2006, tables 2 and 3",
        help: "Taps of the filter in one direction, an odd number",
    },
    Setting {
        key: "fuse",
        symbol: "",
        kind: Kind::Choice(&["off", "on"]),
        default: "off",
        unit: "",
        paper: "",
        help: "Merge passes of --filter gauss: the composite runs over the filter's columns, and a one-pass gather \
               that pulls over its rows; the same pixels with fewer passes, and fewer stages to time and to look at",
    },
    Setting {
        key: "sigma",
        symbol: "",
        kind: Kind::Number { min: 0.0, max: 64.0 },
        default: "0",
        unit: "px",
        paper: "",
        help: "Standard deviation of the filter; 0: a third of the kernel, which weighs the pixels of a 4x4 pattern \
               most evenly",
    },
    Setting {
        key: "discontinuity",
        symbol: "",
        kind: Kind::Choice(&["directional", "any"]),
        default: "directional",
        unit: "",
        paper: "Segovia 2006, 4.5",
        help: "Discontinuity at which the filter stops: one in the direction of the filter (directional), or one in \
               any of the three directions (any, the paper's single flag, which leaves pixels along an edge \
               unfiltered)",
    },
    NORMAL_THRESHOLD,
    Setting {
        key: "position-threshold",
        symbol: "",
        kind: Kind::Length,
        default: "0.5%",
        unit: "m",
        paper: "Segovia 2006, 4.5",
        help: "Distance from a pixel's tangent plane above which a neighbour lies across a discontinuity",
    },
];

/// Splits that copy into sub-buffers.
pub const COPYING: &[&str] = &["one-pass", "two-pass", "tile", "layered", "fragment"];

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

/// Settings that are not read with some values of others.
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
    Condition { key: "brdf", unread: |values| Unread::with(values, "direct", &["none"], "there is no direct light") },
    Condition { key: "cull", unread: |values| Unread::with(values, "direct", &["none"], "there is no direct light") },
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
