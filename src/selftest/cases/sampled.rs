//! Interleaved sampling: the ways to draw a member, one sample against forward shading, and every sampler against paths.

use super::super::case::{Group, Place, Twin};
use super::super::judge::Bounds;
use crate::selftest::cases::baselines::{DRAWN, FENCE, FILTER, LAMPS, PATHS_OF_DIRECT_LIGHT, PLAINLY_DRAWN};
use crate::selftest::cases::bounds::{AGAIN, CUT, ROUNDING, SAME, WHOLE};
use crate::selftest::judge::Must;

/// Bars around a volume, and a rod within it.
const SPECIMEN: Place = Place::Scene("specimen:rod=on");

const VOLUME: (&str, &str) = ("volume", "marschner-lobb:size=16");
const HEAT: (&str, &str) = ("transfer", "heat");

/// Men that move, under spots.
const MOVING: Place = Place::Scene("chess:triangles=12000");
const EXPOSED: (&str, &str) = ("shutter", "0,0.6");

const TRACED: Bounds = Bounds {
    apart: 0.5,
    rmse: 0.05,
    flip: 0.1,
    mean: 0.02,
    why: "64 paths a pixel and 16 samples a pixel, both noise along edges and in no mean",
};

const MARCHED: Bounds = Bounds {
    apart: 0.5,
    rmse: 0.04,
    flip: 0.05,
    mean: 0.03,
    why: "120 planes and a fine march, and 8 bits that round at each of them",
};

const SNAPPED: Bounds = Bounds {
    apart: 0.1,
    rmse: 0.05,
    flip: 0.03,
    mean: 0.004,
    why: "the same samples, but corners are snapped to parts of a pixel in one and parts of a basis in the other",
};

const BLURRED: Bounds = Bounds {
    apart: 0.6,
    rmse: 0.06,
    flip: 0.12,
    mean: 0.03,
    why: "64 paths a pixel and 64 members, whose few moments or places of a lamp are seen as steps",
};

pub const GROUPS: &[Group] = &[
    Group {
        name: "repeat",
        technique: "interleaved_sampling",
        place: LAMPS,
        common: &[],
        twin: Twin::Method(&[]),
        methods: AGAIN,
        must: SAME,
    },
    Group {
        name: "plain",
        technique: "interleaved_sampling",
        place: LAMPS,
        common: &[("basis", "2.5x1.75")],
        twin: PLAINLY_DRAWN,
        methods: DRAWN,
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "bands",
        technique: "interleaved_sampling",
        place: LAMPS,
        common: &[],
        twin: Twin::Method(WHOLE),
        methods: CUT,
        must: SAME,
    },
    Group {
        name: "one-sample",
        technique: "interleaved_sampling",
        place: FENCE,
        common: &[("basis", "1x1"), ("samples", "1")],
        twin: Twin::Other("forward", &[]),
        methods: &[&[]],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "shadow-maps",
        technique: "interleaved_sampling",
        place: LAMPS,
        common: &[("direct-shadow", "map"), ("shadow-map-size", "256"), ("samples", "1")],
        twin: Twin::Method(&[("shadow-filter", "gather"), ("shadow-casters", "all")]),
        methods: &[&[("shadow-filter", "gather")]],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "shadow-filter",
        technique: "interleaved_sampling",
        place: LAMPS,
        common: &[("direct-shadow", "map"), ("shadow-map-size", "256"), ("samples", "1")],
        twin: Twin::Method(&[("shadow-filter", "gather")]),
        methods: &[&[("shadow-filter", "bilinear")]],
        must: Must::Near(FILTER),
    },
    Group {
        name: "traced",
        technique: "interleaved_sampling",
        place: LAMPS,
        common: &[("brdf", "lambert"), ("direct-shadow", "ray"), ("samples", "16")],
        twin: Twin::Other("path_traced", PATHS_OF_DIRECT_LIGHT),
        methods: &[
            &[("sampler", "relaxed")],
            &[("sampler", "sobol")],
            &[("sampler", "r2")],
            &[("sampler", "jittered")],
            &[("sampler", "random")],
            &[("sampler", "ign")],
            &[("sampler", "void-and-cluster")],
            &[("sampler", "blue-errors")],
            &[("direct-shadow", "map"), ("shadow-map-size", "256"), ("shadow-filter", "nearest")],
        ],
        must: Must::Near(TRACED),
    },
    Group {
        name: "stipple",
        technique: "interleaved_sampling",
        place: LAMPS,
        common: &[("basis", "2.5x2"), ("samples", "2"), ("places", "free")],
        twin: Twin::Method(&[("members", "layers")]),
        methods: &[&[("members", "stipple")]],
        must: SAME,
    },
    Group {
        name: "tuples",
        technique: "interleaved_sampling",
        place: LAMPS,
        common: &[("basis", "3x2"), ("samples", "2")],
        twin: Twin::Method(&[("members", "layers")]),
        methods: &[&[("members", "tuples")]],
        must: Must::Near(SNAPPED),
    },
    Group {
        name: "sixteenths",
        technique: "interleaved_sampling",
        place: LAMPS,
        common: &[("basis", "3x2"), ("samples", "2"), ("places", "sixteenths")],
        twin: Twin::Method(&[("members", "layers")]),
        methods: &[&[("members", "tuples")], &[("members", "sample-locations")]],
        must: Must::Near(SNAPPED),
    },
    Group {
        name: "motion",
        technique: "interleaved_sampling",
        place: MOVING,
        common: &[("effect", "aa,motion"), ("samples", "16"), ("direct-shadow", "ray"), EXPOSED, ("brdf", "lambert")],
        twin: Twin::Other(
            "path_traced",
            &[
                ("brdf", "lambert"),
                ("transport", "direct"),
                ("emissive", "off"),
                ("ambient-visibility", "off"),
                ("light-visibility", "on"),
                ("spp", "64"),
                EXPOSED,
            ],
        ),
        methods: &[&[], &[("direct-shadow", "map"), ("shadow-map-size", "256")]],
        must: Must::Near(BLURRED),
    },
    Group {
        name: "soft-shadow",
        technique: "interleaved_sampling",
        place: LAMPS,
        common: &[
            ("effect", "aa,soft-shadow"),
            ("samples", "16"),
            ("direct-shadow", "ray"),
            ("light-radius", "0.4"),
            ("brdf", "lambert"),
        ],
        twin: Twin::Other(
            "path_traced",
            &[
                ("brdf", "lambert"),
                ("transport", "direct"),
                ("light-radius", "0.4"),
                ("ambient-visibility", "off"),
                ("light-visibility", "on"),
                ("spp", "64"),
            ],
        ),
        methods: &[&[], &[("direct-shadow", "map"), ("shadow-map-size", "256")]],
        must: Must::Near(BLURRED),
    },
    Group {
        name: "volume",
        technique: "interleaved_sampling",
        place: SPECIMEN,
        common: &[
            ("effect", "volume"),
            VOLUME,
            HEAT,
            ("planes", "120"),
            ("samples", "1"),
            ("direct-shadow", "ray"),
            ("brdf", "lambert"),
        ],
        twin: Twin::Other(
            "path_traced",
            &[
                ("brdf", "lambert"),
                ("transport", "direct"),
                ("emissive", "off"),
                ("ambient-visibility", "off"),
                ("pixel", "middle"),
                ("spp", "1"),
                VOLUME,
                HEAT,
            ],
        ),
        methods: &[&[], &[("depth", "half")], &[("depth", "8")], &[("summation", "hierarchical")]],
        must: Must::Near(MARCHED),
    },
];
