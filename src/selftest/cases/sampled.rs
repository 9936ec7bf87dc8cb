//! Interleaved sampling: the ways to draw a member, one sample against forward shading, and every sampler against paths.

use super::super::case::{Group, Place, Twin};
use super::super::judge::Bounds;
use crate::selftest::cases::baselines::{DRAWN, FENCE, FILTER, LAMPS, PATHS_OF_DIRECT_LIGHT, PLAINLY_DRAWN};
use crate::selftest::cases::bounds::{AGAIN, CUT, ROUNDING, SAME, WHOLE};
use crate::selftest::judge::Must;

/// Bars around a volume, and a rod within it.
const SPECIMEN: Place = Place::Scene("specimen:rod=on");

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
    mean: 0.02,
    why: "120 planes and a fine march, and 8 bits that round at each of them",
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
        name: "volume",
        technique: "interleaved_sampling",
        place: SPECIMEN,
        common: &[
            ("effect", "volume"),
            ("volume", "marschner-lobb:size=16"),
            ("transfer", "heat"),
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
            ],
        ),
        methods: &[&[], &[("depth", "half")], &[("depth", "8")], &[("summation", "hierarchical")]],
        must: Must::Near(MARCHED),
    },
];
