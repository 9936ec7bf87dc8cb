//! Forward and deferred shading: culling of lights, the pre-pass, samples a pixel, shadows by map and by ray, and both
//! against paths.

use super::super::case::{Group, Place, Settings, Twin};
use super::super::judge::Bounds;
use crate::selftest::cases::bounds::{AGAIN, CUT, EVERYTHING, ROUNDING, SAME, WHOLE};
use crate::selftest::judge::Must;

pub const LAMPS: Place = Place::Scene("lamps:objects=12,lights=12");
pub const FENCE: Place = Place::Scene("fence:lights=6");

pub const POSITIONS: Bounds = Bounds {
    apart: 0.02,
    rmse: 0.006,
    flip: 0.015,
    mean: 0.002,
    why: "positions of 16 bits and those of floats; highlights are where rounding shows",
};
const EDGES: Bounds = Bounds {
    apart: 0.4,
    rmse: 0.05,
    flip: 0.08,
    mean: 0.03,
    why: "a surface is shaded once a pixel instead of at each sample, which small pictures are full of edges to show",
};
const PREPASS: Bounds = Bounds {
    apart: 0.03,
    rmse: 0.006,
    flip: 0.008,
    mean: 0.002,
    why: "of samples that pass the depth test a device may shade another one than without the pre-pass",
};
pub const FILTER: Bounds = Bounds {
    apart: 0.02,
    rmse: 0.005,
    flip: 0.005,
    mean: 0.002,
    why: "a device weighs the four comparisons of a filter in steps of its own",
};
const DEFERRED: Bounds = Bounds {
    apart: 0.01,
    rmse: 0.004,
    flip: 0.004,
    mean: 0.002,
    why: "what a G-buffer rounds, forward shading does not",
};
const TRACED: Bounds = Bounds {
    apart: 0.5,
    rmse: 0.03,
    flip: 0.08,
    mean: 0.02,
    why: "64 paths a pixel are noise beside 16 places a pixel, along edges and in no mean",
};
const TRACED_EDGES: Bounds = Bounds {
    rmse: 0.1,
    flip: 0.12,
    why: "64 paths a pixel against one place in its middle: edges are smooth in one and not in the other",
    ..TRACED
};
const RAYS_AND_MAPS: Bounds = Bounds {
    apart: 0.04,
    rmse: 0.012,
    flip: 0.02,
    mean: 0.003,
    why: "a map of 256 texels and rays: edges of shadows differ, lit and shadowed surfaces do not",
};

pub const PATHS_OF_DIRECT_LIGHT: &[(&str, &str)] =
    &[("brdf", "lambert"), ("transport", "direct"), ("emissive", "off"), ("ambient-visibility", "off"), ("spp", "64")];

/// The plain way to draw with whole materials (`passes::forward`), and every other one.
pub const PLAINLY_DRAWN: Twin =
    Twin::Method(&[("depth-prepass", "off"), ("light-lists", "none"), ("light-buffer", "storage"), EVERYTHING[0]]);
pub const DRAWN: &[Settings] = &[
    &[],
    &[("depth-prepass", "off")],
    &[("light-lists", "none")],
    &[("light-buffer", "uniform")],
    &[("light-buffer", "storage")],
    EVERYTHING,
];

pub const GROUPS: &[Group] = &[
    Group {
        name: "repeat",
        technique: "forward",
        place: LAMPS,
        common: &[],
        twin: Twin::Method(&[]),
        methods: AGAIN,
        must: SAME,
    },
    Group {
        name: "plain",
        technique: "forward",
        place: LAMPS,
        common: &[],
        twin: PLAINLY_DRAWN,
        methods: DRAWN,
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "bands",
        technique: "forward",
        place: LAMPS,
        common: &[],
        twin: Twin::Method(WHOLE),
        methods: CUT,
        must: SAME,
    },
    Group {
        name: "glass",
        technique: "forward",
        place: FENCE,
        common: &[],
        twin: Twin::Method(&[("light-lists", "none"), EVERYTHING[0]]),
        methods: &[&[], &[("depth-prepass", "off")]],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "msaa",
        technique: "forward",
        place: LAMPS,
        common: &[],
        twin: Twin::Method(&[("supersample", "4")]),
        methods: &[
            &[("msaa", "4")],
            &[("msaa", "8")],
            &[("msaa", "4"), ("sample-shading", "on")],
            &[("msaa", "4"), ("sample-format", "half")],
        ],
        must: Must::Near(EDGES),
    },
    Group {
        name: "msaa-prepass",
        technique: "forward",
        place: LAMPS,
        common: &[("msaa", "4")],
        twin: Twin::Method(&[("depth-prepass", "off")]),
        methods: &[&[]],
        must: Must::Near(PREPASS),
    },
    Group {
        name: "shadow-maps",
        technique: "forward",
        place: LAMPS,
        common: &[("direct-shadow", "map"), ("shadow-map-size", "256")],
        twin: Twin::Method(&[("shadow-filter", "gather"), ("shadow-casters", "all")]),
        methods: &[&[("shadow-filter", "gather")]],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "shadow-filter",
        technique: "forward",
        place: LAMPS,
        common: &[("direct-shadow", "map"), ("shadow-map-size", "256")],
        twin: Twin::Method(&[("shadow-filter", "gather")]),
        methods: &[&[("shadow-filter", "bilinear")]],
        must: Must::Near(FILTER),
    },
    Group {
        name: "map-and-ray",
        technique: "forward",
        place: LAMPS,
        common: &[("brdf", "lambert")],
        twin: Twin::Other("forward", &[("brdf", "lambert"), ("direct-shadow", "ray")]),
        methods: &[
            &[("direct-shadow", "map"), ("shadow-map-size", "256"), ("shadow-filter", "nearest")],
            &[("direct-shadow", "map"), ("shadow-map-size", "256")],
        ],
        must: Must::Near(RAYS_AND_MAPS),
    },
    Group {
        name: "traced",
        technique: "forward",
        place: LAMPS,
        common: &[("brdf", "lambert"), ("direct-shadow", "ray"), ("supersample", "4")],
        twin: Twin::Other("path_traced", PATHS_OF_DIRECT_LIGHT),
        methods: &[&[]],
        must: Must::Near(TRACED),
    },
    Group {
        name: "repeat",
        technique: "deferred",
        place: LAMPS,
        common: &[("cull", "tiled")],
        twin: Twin::Method(&[]),
        methods: AGAIN,
        must: SAME,
    },
    Group {
        name: "cull",
        technique: "deferred",
        place: LAMPS,
        common: &[],
        twin: Twin::Method(&[("cull", "none"), ("texels", "1"), EVERYTHING[0]]),
        methods: &[
            &[("cull", "none")],
            &[("cull", "tiled"), ("cull-by", "invocation")],
            &[("cull", "tiled"), ("cull-by", "workgroup")],
            &[("cull", "tiled"), ("texels", "1"), ("workgroup", "8x8")],
            &[("texels", "4")],
            &[("texels", "32"), ("workgroup", "32x4")],
        ],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "cull-rays",
        technique: "deferred",
        place: LAMPS,
        common: &[("direct-shadow", "ray")],
        twin: Twin::Method(&[("cull", "none")]),
        methods: &[&[("cull", "tiled")], &[("workgroup", "8x8")]],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "bands",
        technique: "deferred",
        place: LAMPS,
        common: &[("cull", "tiled"), ("direct-shadow", "ray")],
        twin: Twin::Method(WHOLE),
        methods: CUT,
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "position",
        technique: "deferred",
        place: LAMPS,
        common: &[("brdf", "lambert"), ("direct-shadow", "none")],
        twin: Twin::Method(&[("position", "float")]),
        methods: &[&[("position", "half")], &[("position", "unorm16")], &[("position", "depth")]],
        must: Must::Near(POSITIONS),
    },
    Group {
        name: "forward",
        technique: "deferred",
        place: FENCE,
        common: &[("position", "float")],
        twin: Twin::Other("forward", &[]),
        methods: &[&[]],
        must: Must::Near(DEFERRED),
    },
    Group {
        name: "glass",
        technique: "deferred",
        place: FENCE,
        common: &[],
        twin: Twin::Method(&[("light-lists", "none")]),
        methods: &[&[], &[("cull", "tiled")]],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "traced",
        technique: "deferred",
        place: LAMPS,
        common: &[("brdf", "lambert"), ("direct-shadow", "ray")],
        twin: Twin::Other("path_traced", PATHS_OF_DIRECT_LIGHT),
        methods: &[&[]],
        must: Must::Near(TRACED_EDGES),
    },
];
