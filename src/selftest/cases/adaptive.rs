//! Adaptive interleaved sampling: both ways to refine, the host's threads, positions as the G-buffer stores them, lists of
//! lights for glass.

use super::super::case::{Group, Place, Twin};
use crate::selftest::cases::bounds::{AGAIN, CUT, ROUNDING, SAME, WHOLE};
use crate::selftest::judge::{Bounds, Must};

const NAME: &str = "adaptive_interleaved";
const CORNELL: Place = Place::Scene("cornell");
const EMISSIVE: (&str, &str) = ("emissive", "on");
/// Every tile refines: what rounding turns is a ray, and no number of iterations.
const ALL: (&str, &str) = ("mode", "max");

const HOST: Bounds = Bounds {
    apart: 0.04,
    rmse: 0.02,
    flip: 0.015,
    mean: 0.012,
    why: "the same estimator on the host: rays that graze an edge meet it on one side and not on the other, and a pixel's \
          middle on an edge is its neighbour's; where corners snap to 1/16 pixel that is 2.6 % of a small picture",
};

pub const GROUPS: &[Group] = &[
    Group {
        name: "repeat",
        technique: NAME,
        place: CORNELL,
        common: &[EMISSIVE],
        twin: Twin::Method(&[]),
        methods: AGAIN,
        must: SAME,
    },
    Group {
        name: "refine",
        technique: NAME,
        place: CORNELL,
        common: &[EMISSIVE],
        twin: Twin::Method(&[("refine", "fused")]),
        methods: &[&[("refine", "indirect")], &[("refine", "indirect"), ("workgroup", "8x8")]],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "ray-order",
        technique: NAME,
        place: CORNELL,
        common: &[EMISSIVE],
        twin: Twin::Method(&[("ray-order", "tile")]),
        methods: &[&[("ray-order", "slot")], &[("ray-order", "slot"), ("tile", "3x3"), ("workgroup", "8x8")]],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "guidance-of-neighbours",
        technique: NAME,
        place: CORNELL,
        common: &[EMISSIVE, ("guidance-of", "neighbours")],
        twin: Twin::Method(&[("ray-order", "tile")]),
        methods: &[&[("ray-order", "slot")]],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "guidance-of-components",
        technique: NAME,
        place: CORNELL,
        common: &[EMISSIVE, ("guidance-of", "components")],
        twin: Twin::Method(&[("ray-order", "tile")]),
        methods: &[&[("ray-order", "slot")]],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "id-choice",
        technique: NAME,
        place: CORNELL,
        common: &[EMISSIVE, ALL, ("id-choice", "contribution")],
        twin: Twin::Method(&[("refine", "fused")]),
        methods: &[&[("refine", "indirect")]],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "position",
        technique: NAME,
        place: CORNELL,
        common: &[EMISSIVE, ALL],
        twin: Twin::Method(&[("position", "float")]),
        methods: &[&[("position", "half")], &[("position", "unorm16")], &[("position", "depth")]],
        must: Must::Near(super::baselines::POSITIONS),
    },
    Group {
        name: "glass",
        technique: NAME,
        place: Place::Scene("fence:lights=6"),
        common: &[],
        twin: Twin::Method(&[("light-lists", "none")]),
        methods: &[&[]],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "airlight",
        technique: NAME,
        place: CORNELL,
        common: &[EMISSIVE, ("medium", "0.1,0.05,0.3"), ("ambient", "0.1"), ("components", "id,ss,pm,ao")],
        twin: Twin::Method(&[("refine", "fused")]),
        methods: &[&[("refine", "indirect")]],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "trace",
        technique: NAME,
        place: CORNELL,
        common: &[EMISSIVE, ALL, ("medium", "0.1,0.05,0.3"), ("ambient", "0.1"), ("components", "id,ss,pm,ao")],
        twin: Twin::Method(&[("trace", "host")]),
        methods: &[&[("trace", "device")]],
        must: Must::Near(HOST),
    },
    Group {
        name: "submits",
        technique: NAME,
        place: CORNELL,
        common: &[EMISSIVE],
        twin: Twin::Method(WHOLE),
        methods: CUT,
        must: SAME,
    },
];
