//! Interleaved deferred shading: every split, storage, form of copy and filter, beside pixels that loop over their own
//! subset.

use super::super::case::{Group, Place, Settings, Twin};
use super::super::judge::Bounds;
use crate::selftest::cases::bounds::{AGAIN, CUT, EVERYTHING, ROUNDING, SAME, WHOLE};
use crate::selftest::judge::Must;

const NAME: &str = "interleaved_deferred";
const CORNELL: Place = Place::Scene("cornell");
const HALL: Place = Place::Scene("hall:triangles=8000");
const FENCE: Place = Place::Scene("fence:lights=6");
const VPLS: (&str, &str) = ("vpls", "64");
const UNFILTERED: (&str, &str) = ("filter", "none");

/// Every method of `--split` that must give the picture of `branch`, and that one first, in every storage and form of
/// copy that it knows.
pub const SPLITS: [Settings; 19] = [
    &[("split", "branch")],
    &[("split", "indirect")],
    &[("split", "remap")],
    &[("split", "stencil")],
    &[("split", "depth")],
    &[("split", "one-pass"), ("storage", "buffer"), ("copy", "pull")],
    &[("split", "one-pass"), ("storage", "buffer"), ("copy", "push")],
    &[("split", "one-pass"), ("storage", "image"), ("copy", "pull")],
    &[("split", "one-pass"), ("storage", "image"), ("copy", "push")],
    &[("split", "two-pass"), ("storage", "buffer"), ("copy", "pull")],
    &[("split", "two-pass"), ("storage", "buffer"), ("copy", "push")],
    &[("split", "two-pass"), ("storage", "image"), ("copy", "pull")],
    &[("split", "two-pass"), ("storage", "image"), ("copy", "push")],
    &[("split", "tile"), ("storage", "buffer")],
    &[("split", "tile"), ("storage", "image")],
    &[("split", "layered"), ("copy", "pull")],
    &[("split", "layered"), ("copy", "push")],
    &[("split", "fragment"), ("fragment-passes", "1")],
    &[("split", "fragment"), ("fragment-passes", "2")],
];

const HALF_TEXELS: Bounds = Bounds {
    apart: 0.15,
    rmse: 0.012,
    flip: 0.05,
    mean: 0.006,
    why: "a fetch between two texels is weighed in steps of the device's own, and across discontinuities otherwise",
};
const CONVERGED: Bounds = Bounds {
    apart: 0.25,
    rmse: 0.015,
    flip: 0.08,
    mean: 0.005,
    why: "each pixel has a subset of the lights, and the filter spreads it: the mean stays, and edges are coarser",
};

const ONE_TEXEL: Bounds = Bounds {
    apart: 0.002,
    rmse: 0.001,
    flip: 0.001,
    mean: 0.0005,
    why: "the same maps elsewhere in an image: corners are snapped after they are moved there, which takes a texel of an edge \
          here and there",
};
const TEXELS_WIDE: Bounds = Bounds {
    apart: 0.03,
    rmse: 0.01,
    flip: 0.01,
    mean: 0.002,
    why: "a map's texels are as wide as its distance says, and a shadow's edge with them",
};

pub const GROUPS: &[Group] = &[
    Group {
        name: "repeat",
        technique: NAME,
        place: CORNELL,
        common: &[VPLS],
        twin: Twin::Method(&[]),
        methods: AGAIN,
        must: SAME,
    },
    Group {
        name: "split",
        technique: NAME,
        place: CORNELL,
        common: &[VPLS, ("pattern", "4x4"), UNFILTERED],
        twin: Twin::Method(&[("split", "branch"), ("texels", "1"), EVERYTHING[0]]),
        methods: &SPLITS,
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "split-textures",
        technique: NAME,
        place: HALL,
        common: &[VPLS, ("pattern", "3x2"), ("cull", "tiled")],
        twin: Twin::Method(&[("split", "branch")]),
        methods: &[
            &[("split", "one-pass"), ("cull-by", "invocation")],
            &[("split", "one-pass"), ("cull-by", "workgroup")],
            &[("split", "two-pass"), ("storage", "image"), ("block", "9x4")],
            &[("split", "tile"), ("block", "12")],
            &[("split", "stencil")],
        ],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "one-subset",
        technique: NAME,
        place: CORNELL,
        common: &[VPLS],
        twin: Twin::Method(&[("split", "none")]),
        methods: &[
            &[("pattern", "1x1")],
            &[("pattern", "1x1"), ("split", "tile")],
            &[("pattern", "1x1"), ("split", "fragment")],
            &[("pattern", "1x1"), ("split", "subsample")],
        ],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "threads",
        technique: NAME,
        place: CORNELL,
        common: &[VPLS],
        twin: Twin::Method(&[("texels", "1"), ("workgroup", "64x1")]),
        methods: &[&[("texels", "4")], &[("workgroup", "8x8")], &[("texels", "16"), ("workgroup", "16x8")]],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "fuse",
        technique: NAME,
        place: CORNELL,
        common: &[VPLS],
        twin: Twin::Method(&[("fuse", "off")]),
        methods: &[&[("fuse", "on")], &[("fuse", "on"), ("split", "branch")], &[("fuse", "on"), ("split", "layered")]],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "filter",
        technique: NAME,
        place: CORNELL,
        common: &[VPLS, ("kernel", "9")],
        twin: Twin::Method(&[("filter", "gauss")]),
        methods: &[&[("filter", "gauss-fast")]],
        must: Must::Near(HALF_TEXELS),
    },
    Group {
        name: "shade-by",
        technique: NAME,
        place: CORNELL,
        common: &[VPLS, ("position", "float"), UNFILTERED],
        twin: Twin::Method(&[("split", "branch")]),
        methods: &[
            &[("shade-by", "viewport")],
            &[("shade-by", "quad"), ("split", "tile")],
            &[("shade-by", "quad"), ("split", "fragment")],
        ],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "vpl-brdf",
        technique: NAME,
        place: FENCE,
        common: &[VPLS, ("vpl-brdf", "ggx"), ("position", "float"), UNFILTERED],
        twin: Twin::Method(&[("split", "branch")]),
        methods: &[
            &[("split", "one-pass")],
            &[("split", "two-pass"), ("storage", "image")],
            &[("split", "tile")],
            &[("split", "fragment"), ("shade-by", "viewport")],
            &[("split", "stencil")],
        ],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "sub-buffer-color",
        technique: NAME,
        place: CORNELL,
        common: &[VPLS],
        twin: Twin::Method(&[("sub-buffer-color", "off")]),
        methods: &[
            &[("sub-buffer-color", "on")],
            &[("sub-buffer-color", "on"), ("split", "two-pass")],
            &[("sub-buffer-color", "on"), ("split", "fragment")],
        ],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "walk-end",
        technique: NAME,
        place: CORNELL,
        common: &[VPLS, ("kernel", "9")],
        twin: Twin::Method(&[("walk-end", "flag")]),
        methods: &[&[("walk-end", "branch")], &[("walk-end", "branch"), ("fuse", "on")]],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "all-lights",
        technique: NAME,
        place: CORNELL,
        common: &[("vpls", "256")],
        twin: Twin::Method(&[("split", "none")]),
        methods: &[&[]],
        must: Must::Near(CONVERGED),
    },
    Group {
        name: "position",
        technique: NAME,
        place: CORNELL,
        common: &[VPLS, ("split", "branch"), UNFILTERED],
        twin: Twin::Method(&[("position", "float")]),
        methods: &[&[("position", "half")], &[("position", "unorm16")], &[("position", "depth")]],
        must: Must::Near(super::baselines::POSITIONS),
    },
    Group {
        name: "glass",
        technique: NAME,
        place: FENCE,
        common: &[VPLS],
        twin: Twin::Method(&[("light-lists", "none"), ("split", "branch")]),
        methods: &[&[], &[("split", "tile")]],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "accumulate",
        technique: NAME,
        place: FENCE,
        common: &[VPLS, ("accumulate", "3")],
        twin: Twin::Method(&[("light-lists", "none"), ("split", "branch")]),
        methods: &[&[], &[("split", "stencil")], &[("split", "tile")]],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "accumulate-float",
        technique: NAME,
        place: FENCE,
        common: &[VPLS, ("accumulate", "3"), ("position", "float")],
        twin: Twin::Method(&[("light-lists", "none"), ("split", "branch")]),
        methods: &[&[("split", "tile")]],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "vpl-shadow",
        technique: NAME,
        place: CORNELL,
        common: &[VPLS, UNFILTERED, ("vpl-shadow", "ray")],
        twin: Twin::Method(&[("split", "branch"), ("position", "float")]),
        methods: &[&[("position", "float")], &[("split", "stencil"), ("position", "float")]],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "vpl-shadow-map",
        technique: NAME,
        place: CORNELL,
        common: &[VPLS, UNFILTERED, ("vpl-shadow", "map"), ("position", "float")],
        twin: Twin::Method(&[("split", "branch"), ("shadow-casters", "all")]),
        methods: &[&[], &[("split", "stencil")]],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "vpl-shadow-shape",
        technique: NAME,
        place: CORNELL,
        common: &[VPLS, UNFILTERED, ("vpl-shadow", "map"), ("position", "float")],
        twin: Twin::Method(&[("vpl-shadow-shape", "layers"), ("vpl-shadow-maps", "5")]),
        methods: &[
            &[("vpl-shadow-shape", "cube"), ("vpl-shadow-maps", "64")],
            &[("vpl-shadow-shape", "hemicube"), ("vpl-shadow-maps", "7")],
            &[("vpl-shadow-shape", "cube"), ("vpl-shadow-index", "cube-map")],
            &[("vpl-shadow-shape", "hemicube"), ("vpl-shadow-index", "cube-map")],
        ],
        must: Must::Near(ONE_TEXEL),
    },
    Group {
        name: "vpl-shadow-rays",
        technique: NAME,
        place: CORNELL,
        common: &[VPLS, ("position", "float")],
        twin: Twin::Method(&[("vpl-shadow", "ray")]),
        methods: &[&[("vpl-shadow", "map"), ("vpl-shadow-size", "512")]],
        must: Must::Near(TEXELS_WIDE),
    },
    Group {
        name: "bands",
        technique: NAME,
        place: CORNELL,
        common: &[VPLS],
        twin: Twin::Method(WHOLE),
        methods: CUT,
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "memory",
        technique: NAME,
        place: CORNELL,
        common: &[VPLS],
        twin: Twin::Method(&[("allocation", "linear")]),
        methods: &[&[("allocation", "dedicated")], &[("allocation", "tlsf")], &[("allocation", "buddy")]],
        must: SAME,
    },
    Group {
        name: "tiling",
        technique: NAME,
        place: CORNELL,
        common: &[VPLS],
        twin: Twin::Method(&[("image-tiling", "optimal")]),
        methods: &[&[("image-tiling", "linear")], &[("image-tiling", "linear"), ("storage", "buffer")]],
        must: SAME,
    },
    Group {
        name: "touched",
        technique: NAME,
        place: CORNELL,
        common: &[VPLS],
        twin: Twin::Method(&[("touched", "off")]),
        methods: &[&[("touched", "line")], &[("touched", "page")]],
        must: SAME,
    },
];
