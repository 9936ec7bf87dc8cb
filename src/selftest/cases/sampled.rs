//! Interleaved sampling: the ways to draw a member, one sample against forward shading, and every sampler against paths.

use super::super::case::{Group, Place, Twin};
use super::super::judge::Bounds;
use crate::selftest::cases::bounds::{AGAIN, CUT, EVERYTHING, ROUNDING, SAME, WHOLE};
use crate::selftest::judge::Must;

const LAMPS: Place = Place::Scene("lamps:objects=12,lights=12");
const FENCE: Place = Place::Scene("fence:lights=6");

const FILTER: Bounds = Bounds {
    apart: 0.02,
    rmse: 0.005,
    flip: 0.005,
    mean: 0.002,
    why: "a device weighs the four comparisons of a filter in steps of its own",
};
const TRACED: Bounds = Bounds {
    apart: 0.5,
    rmse: 0.05,
    flip: 0.1,
    mean: 0.02,
    why: "64 paths a pixel and 16 samples a pixel, both noise along edges and in no mean",
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
        twin: Twin::Method(&[
            ("depth-prepass", "off"),
            ("light-lists", "none"),
            ("light-buffer", "storage"),
            EVERYTHING[0],
        ]),
        methods: &[
            &[],
            &[("depth-prepass", "off")],
            &[("light-lists", "none")],
            &[("light-buffer", "uniform")],
            &[("light-buffer", "storage")],
            EVERYTHING,
        ],
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
        twin: Twin::Other(
            "path_traced",
            &[
                ("brdf", "lambert"),
                ("transport", "direct"),
                ("emissive", "off"),
                ("ambient-visibility", "off"),
                ("spp", "64"),
            ],
        ),
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
];
