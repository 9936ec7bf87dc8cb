//! Inferred lighting: every kind of light volume, of light buffer, of packing and of filter.

use super::super::case::{Group, Place, Twin};
use super::super::judge::Bounds;
use crate::selftest::cases::bounds::{AGAIN, CUT, EVERYTHING, ROUNDING, SAME, WHOLE};
use crate::selftest::judge::Must;

const NAME: &str = "inferred_lighting";
const FENCE: Place = Place::Scene("fence:lights=6");
const LAMPS: Place = Place::Scene("lamps:objects=12,lights=12");
const AT_FRAME_SIZE: (&str, &str) = ("light-size", "61x37");

const HALVES: Bounds = Bounds {
    apart: 0.01,
    rmse: 0.002,
    flip: 0.012,
    mean: 0.005,
    why: "light of 16 bits a channel and of 32: half floats that are blended lose a part in a thousand a light",
};
const DEFERRED: Bounds = Bounds {
    apart: 0.005,
    rmse: 0.001,
    flip: 0.004,
    mean: 0.002,
    why: "a light buffer of the frame's size is deferred shading but for normals and light in 16 bits",
};
const HIGHLIGHTS: Bounds = Bounds {
    apart: 0.3,
    rmse: 0.03,
    flip: 0.05,
    mean: 0.03,
    why: "one number of a highlight or two have the colour of the light that is scattered",
};
const SAMPLER: Bounds = Bounds {
    apart: 0.005,
    rmse: 0.002,
    flip: 0.004,
    mean: 0.002,
    why: "a sampler blends four texels in steps of the device's own",
};
const EDGES: Bounds = Bounds {
    apart: 0.45,
    rmse: 0.09,
    flip: 0.12,
    mean: 0.03,
    why: "four or eight places of a pixel instead of one: its edges differ, its surfaces do not",
};
const STENCIL_AND_RAYS: Bounds = Bounds {
    apart: 0.02,
    rmse: 0.012,
    flip: 0.015,
    mean: 0.004,
    why: "shadow volumes are drawn, and rays are cast: edges of shadows fall into one texel or its neighbour",
};

pub const GROUPS: &[Group] = &[
    Group {
        name: "repeat",
        technique: NAME,
        place: FENCE,
        common: &[],
        twin: Twin::Method(&[]),
        methods: AGAIN,
        must: SAME,
    },
    Group {
        name: "volumes",
        technique: NAME,
        place: FENCE,
        common: &[("stipple", "2x2")],
        twin: Twin::Method(&[("volumes", "tiled"), ("texels", "1"), ("depth-prepass", "off"), EVERYTHING[0]]),
        methods: &[
            &[("volumes", "tiled"), ("cull-by", "invocation")],
            &[("volumes", "tiled"), ("cull-by", "workgroup")],
            &[("volumes", "tiled"), ("workgroup", "8x8")],
            &[("volumes", "quad")],
            &[("volumes", "scissor")],
            &[("volumes", "stencil")],
            &[("volumes", "both")],
            &[("volumes", "auto"), ("stencil-least", "50")],
        ],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "stipple",
        technique: NAME,
        place: FENCE,
        common: &[("stipple", "4x4"), ("alpha-filter", "bilinear"), ("extras", "off"), ("packing", "rgba8")],
        twin: Twin::Method(&[("volumes", "tiled")]),
        methods: &[&[("volumes", "stencil")], &[("volumes", "scissor")]],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "volumes-rays",
        technique: NAME,
        place: LAMPS,
        common: &[("direct-shadow", "ray")],
        twin: Twin::Method(&[("volumes", "tiled")]),
        methods: &[&[("volumes", "stencil")], &[("volumes", "scissor")]],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "shadow-volumes",
        technique: NAME,
        place: LAMPS,
        common: &[AT_FRAME_SIZE, ("brdf", "lambert"), ("volumes", "both")],
        twin: Twin::Method(&[("direct-shadow", "ray")]),
        methods: &[&[("shadow-volumes", "64"), ("direct-shadow", "none")]],
        must: Must::Near(STENCIL_AND_RAYS),
    },
    Group {
        name: "prepass",
        technique: NAME,
        place: LAMPS,
        common: &[],
        twin: Twin::Method(&[("depth-prepass", "off")]),
        methods: &[&[("depth-prepass", "on")]],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "bands",
        technique: NAME,
        place: LAMPS,
        common: &[],
        twin: Twin::Method(WHOLE),
        methods: CUT,
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "l-buffer",
        technique: NAME,
        place: LAMPS,
        common: &[("volumes", "scissor"), ("highlight", "intensity")],
        twin: Twin::Method(&[("l-buffer", "float")]),
        methods: &[&[("l-buffer", "half")], &[("l-buffer", "fixed")]],
        must: Must::Near(HALVES),
    },
    Group {
        name: "packing",
        technique: NAME,
        place: LAMPS,
        common: &[],
        twin: Twin::Method(&[("packing", "words")]),
        methods: &[&[("packing", "rgba8")], &[("packing", "fixed")]],
        must: Must::Near(HALVES),
    },
    Group {
        name: "light-filter",
        technique: NAME,
        place: LAMPS,
        common: &[AT_FRAME_SIZE, ("brdf", "lambert"), ("direct-shadow", "none")],
        twin: Twin::Other("deferred", &[("brdf", "lambert"), ("position", "depth"), ("direct-shadow", "none")]),
        methods: &[
            &[("light-filter", "dsf")],
            &[("light-filter", "bilinear")],
            &[("light-filter", "nearest")],
            &[("light-filter", "bilateral")],
            &[("light-filter", "discontinuity")],
        ],
        must: Must::Near(DEFERRED),
    },
    Group {
        name: "highlight",
        technique: NAME,
        place: LAMPS,
        common: &[AT_FRAME_SIZE, ("direct-shadow", "none")],
        twin: Twin::Other("deferred", &[("position", "depth"), ("direct-shadow", "none")]),
        methods: &[
            &[("highlight", "rgb")],
            &[("highlight", "rgb"), ("volumes", "scissor"), ("l-buffer", "half")],
            &[("highlight", "split")],
            &[("highlight", "intensity"), ("fresnel", "light")],
            &[("highlight", "intensity"), ("fresnel", "normal")],
        ],
        must: Must::Near(HIGHLIGHTS),
    },
    Group {
        name: "light-fetch",
        technique: NAME,
        place: LAMPS,
        common: &[("highlight", "intensity")],
        twin: Twin::Method(&[("light-fetch", "texels")]),
        methods: &[&[("light-fetch", "sampler")]],
        must: Must::Near(SAMPLER),
    },
    Group {
        name: "msaa",
        technique: NAME,
        place: LAMPS,
        common: &[],
        twin: Twin::Other("forward", &[("supersample", "4")]),
        methods: &[
            &[("msaa", "4"), AT_FRAME_SIZE],
            &[("msaa", "8"), AT_FRAME_SIZE],
            &[("msaa", "4"), ("sample-shading", "on"), AT_FRAME_SIZE],
            &[("msaa", "4"), ("sample-format", "half"), AT_FRAME_SIZE],
        ],
        must: Must::Near(EDGES),
    },
];
