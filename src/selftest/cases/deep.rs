//! Deep shading buffers: every way to find, to list, to shade and to resolve samples, beside shading each of them where
//! it is seen.

use super::super::case::{Group, Place, Settings, Twin};
use super::super::judge::Bounds;
use crate::selftest::cases::bounds::{AGAIN, CUT, EVERYTHING, ROUNDING, SAME, WHOLE};
use crate::selftest::judge::Must;

const NAME: &str = "deep_shading";
const CORNELL: Place = Place::Scene("cornell");
const HALL: Place = Place::Scene("hall:triangles=8000");
const LAMPS: Place = Place::Scene("lamps:objects=12,lights=12");
const FENCE: Place = Place::Scene("fence:lights=6");
const FEW: (&str, &str) = ("spp", "2");
const LENS: (&str, &str) = ("aperture", "0.2");
const STOCHASTIC: (&str, &str) = ("visibility", "stochastic");
const RAY: (&str, &str) = ("visibility", "ray");
const SAME_SAMPLES: (&str, &str) = ("pixel-samples", "shared");
const FRAGMENT: (&str, &str) = ("shade-by", "fragment");
const ALONE: Twin = Twin::Method(&[("lists", "none")]);

const SAMPLES: Bounds = Bounds {
    apart: 0.1,
    rmse: 0.08,
    flip: 0.06,
    mean: 0.012,
    why: "rasterised samples lie on a device's grid in a pixel, which may be as coarse as a sixteenth, others where floats \
          say: those along edges see the other surface",
};
const PLACES: Bounds = Bounds {
    apart: 0.02,
    rmse: 0.02,
    flip: 0.01,
    mean: 0.002,
    why: "rasterisers snap corners to a grid in a pixel, as coarse as a sixteenth, before they interpolate; levels of textures are \
          then differences between neighbouring pixels",
};
const SHARED: Bounds = Bounds {
    apart: 0.5,
    rmse: 0.05,
    flip: 0.1,
    mean: 0.02,
    why: "a baseline shades elsewhere on a triangle than a list does, which highlights show",
};

const LISTS: &[Settings] = &[
    &[("lists", "linked")],
    &[("compaction", "off")],
    &[("address-buffer", "off")],
    &[("compaction", "off"), ("duplicates", "tolerated")],
    &[("compaction", "off"), ("address-buffer", "off")],
    &[("texels", "1")],
    &[("texels", "4"), ("cull-lights", "off")],
    &[("texels", "16"), ("cull-lights", "on")],
    &[("list-access", "descriptors")],
    &[("list-access", "addresses")],
    &[("list-access", "addresses"), ("compaction", "off"), ("address-buffer", "off")],
    &[("shading", "indirect-gbuffer")],
    &[("shading", "indirect-gbuffer"), ("shading-cache", "64")],
];

/// Where fragments shade, not entries.
const DRAWN: &[Settings] = &[
    &[],
    &[("compaction", "off")],
    &[("zmax", "on")],
    &[("shaded-triangles", "all")],
    &[("list-access", "addresses")],
    &[("compaction", "off"), ("address-buffer", "off"), ("zmax", "on")],
];

/// What makes a triangle as large as the pixels that it touches. The device's own method runs here and where it is
/// asked for by name.
const CONSERVATIVE: &[Settings] =
    &[&[("conservative", "geometry")], &[("conservative", "vertex")], &[("conservative", "hardware")]];

pub const GROUPS: &[Group] = &[
    Group {
        name: "repeat",
        technique: NAME,
        place: CORNELL,
        common: &[FEW, LENS],
        twin: Twin::Method(&[]),
        methods: AGAIN,
        must: SAME,
    },
    Group {
        name: "lists",
        technique: NAME,
        place: CORNELL,
        common: &[FEW, LENS],
        twin: ALONE,
        methods: LISTS,
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "drawn",
        technique: NAME,
        place: CORNELL,
        common: &[FEW, LENS, FRAGMENT],
        twin: ALONE,
        methods: DRAWN,
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "conservative",
        technique: NAME,
        place: CORNELL,
        common: &[FEW, LENS, FRAGMENT],
        twin: ALONE,
        methods: CONSERVATIVE,
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "conservative-sharp",
        technique: NAME,
        place: HALL,
        common: &[FEW, FRAGMENT],
        twin: ALONE,
        methods: CONSERVATIVE,
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "conservative-lens",
        technique: NAME,
        place: HALL,
        common: &[FEW, LENS, ("guard-band", "8"), ("shading-scale", "0.5"), FRAGMENT],
        twin: ALONE,
        methods: CONSERVATIVE,
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "barycentrics",
        technique: NAME,
        place: HALL,
        common: &[FEW, FRAGMENT, ("direct-shadow", "none")],
        twin: ALONE,
        methods: &[
            &[("conservative", "hardware"), ("barycentrics", "interpolated")],
            &[("conservative", "hardware"), ("barycentrics", "device")],
        ],
        must: Must::Near(PLACES),
    },
    Group {
        name: "control",
        technique: NAME,
        place: LAMPS,
        common: &[FEW, LENS, FRAGMENT],
        twin: Twin::Nothing,
        methods: &[&[("conservative", "none")]],
        must: Must::LackSamples,
    },
    Group {
        name: "moving",
        technique: NAME,
        place: FENCE,
        common: &[FEW, ("camera", "rotor"), ("shutter", "0,0.1")],
        twin: ALONE,
        methods: &[
            &[],
            &[FRAGMENT, ("conservative", "geometry")],
            &[FRAGMENT, ("conservative", "vertex")],
            &[FRAGMENT, ("conservative", "hardware")],
            &[EVERYTHING[0]],
            // Nobody filters as many samples as are asked for, unless that is asked for, too.
            &[("reconstruct", "off")],
        ],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "filtered",
        technique: NAME,
        place: CORNELL,
        common: &[FEW, LENS, ("reconstruct", "on")],
        twin: ALONE,
        methods: &[&[], &[("list-access", "addresses")]],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "foveated",
        technique: NAME,
        place: CORNELL,
        common: &[FEW, LENS, ("shading-warp", "foveated")],
        twin: ALONE,
        methods: &[&[], &[FRAGMENT, ("conservative", "geometry")], &[FRAGMENT, ("conservative", "vertex")]],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "coarse",
        technique: NAME,
        place: HALL,
        common: &[FEW, ("aperture", "1"), ("shading-rate", "blur"), ("blur-pixels", "1"), FRAGMENT],
        twin: ALONE,
        methods: CONSERVATIVE,
        must: Must::Equal(ROUNDING),
    },
    Group {
        // A lens whose blur is narrower than a pixel.
        name: "coarse-in-focus",
        technique: NAME,
        place: CORNELL,
        common: &[FEW, ("aperture", "0.001")],
        twin: Twin::Method(&[("shading-rate", "full")]),
        methods: &[&[("shading-rate", "blur")]],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "stereo",
        technique: NAME,
        place: CORNELL,
        common: &[FEW, ("stereo", "0.1")],
        twin: ALONE,
        methods: &[&[], &[FRAGMENT, ("conservative", "vertex")]],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "visibility",
        technique: NAME,
        place: CORNELL,
        common: &[FEW, LENS],
        twin: Twin::Method(&[("visibility", "repeat-frame"), ("vertices", "fetched")]),
        methods: &[
            &[("visibility", "repeat-frame"), ("vertices", "indexed")],
            &[("visibility", "repeat-draw"), ("layer-from", "vertex")],
            &[("visibility", "repeat-draw"), ("layer-from", "geometry")],
            &[("visibility", "instancing"), ("layer-from", "vertex")],
            &[("visibility", "instancing"), ("layer-from", "geometry")],
            &[("visibility", "replicate")],
        ],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "samples",
        technique: NAME,
        place: LAMPS,
        common: &[FEW, LENS],
        twin: Twin::Method(&[("visibility", "repeat-frame")]),
        methods: &[
            &[STOCHASTIC, SAME_SAMPLES, ("sample-tests", "layers"), ("polygon-from", "vertex")],
            &[RAY, SAME_SAMPLES],
        ],
        must: Must::Near(SAMPLES),
    },
    Group {
        name: "own-samples",
        technique: NAME,
        place: LAMPS,
        common: &[FEW, LENS, ("pixel-samples", "own")],
        twin: Twin::Method(&[RAY]),
        methods: &[
            &[STOCHASTIC, ("sample-tests", "layers"), ("coverage-test", "full")],
            &[STOCHASTIC, ("sample-tests", "layers"), ("coverage-test", "reduced")],
            &[STOCHASTIC, ("sample-tests", "loop"), ("coverage-test", "reduced")],
        ],
        must: Must::Near(SAMPLES),
    },
    Group {
        name: "stochastic",
        technique: NAME,
        place: FENCE,
        common: &[FEW, STOCHASTIC, ("camera", "rotor"), ("shutter", "0,0.1")],
        twin: Twin::Method(&[("sample-tests", "layers"), ("polygon-from", "vertex"), ("lists", "none")]),
        methods: &[
            &[("sample-tests", "layers"), ("polygon-from", "vertex")],
            &[("sample-tests", "loop"), ("polygon-from", "vertex")],
            &[("sample-tests", "layers"), ("polygon-from", "geometry")],
            &[("sample-tests", "loop"), ("polygon-from", "geometry")],
        ],
        must: Must::Near(ROUNDING),
    },
    Group {
        name: "ray-lists",
        technique: NAME,
        place: CORNELL,
        common: &[FEW, LENS, RAY],
        twin: ALONE,
        methods: &[&[("lists", "linked")], &[("lists", "direct")], &[("lists", "direct"), ("compaction", "off")]],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "bands",
        technique: NAME,
        place: CORNELL,
        common: &[FEW, LENS],
        twin: Twin::Method(WHOLE),
        methods: CUT,
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "baselines",
        technique: NAME,
        place: LAMPS,
        common: &[("spp", "4"), LENS, ("brdf", "lambert")],
        twin: Twin::Method(&[("shading", "deep")]),
        methods: &[
            &[("shading", "ssaa")],
            &[("shading", "msaa"), ("pass-samples", "1")],
            &[("shading", "msaa"), ("pass-samples", "4")],
            &[("shading", "texture-space")],
        ],
        must: Must::Near(SHARED),
    },
    Group {
        name: "baselines-8",
        technique: NAME,
        place: LAMPS,
        common: &[("spp", "8"), LENS, ("brdf", "lambert")],
        twin: Twin::Method(&[("shading", "deep")]),
        methods: &[&[("shading", "msaa"), ("pass-samples", "8")]],
        must: Must::Near(SHARED),
    },
    Group {
        name: "shadow-maps",
        technique: NAME,
        place: CORNELL,
        common: &[FEW, ("direct-shadow", "map"), ("shadow-map-size", "128"), ("shadow-filter", "gather")],
        twin: Twin::Method(&[("lists", "none"), ("shadow-casters", "all")]),
        methods: &[&[], &[("shadow-casters", "all")]],
        must: Must::Equal(ROUNDING),
    },
    Group {
        name: "shadow-filter",
        technique: NAME,
        place: LAMPS,
        common: &[FEW, ("direct-shadow", "map"), ("shadow-map-size", "128")],
        twin: Twin::Method(&[("shadow-filter", "gather")]),
        methods: &[&[("shadow-filter", "bilinear")], &[("shadow-filter", "nearest")]],
        must: Must::Near(SHARED),
    },
];
