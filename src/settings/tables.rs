//! The rows that several techniques read: those of every picture, those of shading with a G-buffer, and single ones.

use super::{Condition, Kind, Setting, Unread};
use crate::picture::tonemap::EXPOSURES_EV;

/// Settings that every technique and every picture has.
pub const COMMON: &[Setting] = &[
    Setting {
        key: "size",
        symbol: "",
        kind: Kind::Pair { min: 1, max: 16384 },
        default: "1280x720",
        unit: "px",
        paper: "",
        help: "width and height of the picture",
    },
    Setting {
        key: "camera",
        symbol: "",
        kind: Kind::Text("INDEX|NAME"),
        default: "0",
        unit: "",
        paper: "",
        help: "the scene's camera; framing: one that frames the scene, from three quarters above before the side that most front faces                look to, as a scene without a camera gets it",
    },
    Setting {
        key: "time",
        symbol: "",
        kind: Kind::Number { min: 0.0, max: 1e9 },
        default: "0",
        unit: "s",
        paper: "",
        help: "the moment of the animations that is drawn; nothing else moves",
    },
    Setting {
        key: "animation",
        symbol: "",
        kind: Kind::Text("all|none|INDEX|NAME"),
        default: "all",
        unit: "",
        paper: "",
        help: "which animations of a file play, all of them at once or one; none: the rest pose",
    },
    Setting {
        key: "seed",
        symbol: "",
        kind: Kind::Integer { min: 0, max: u32::MAX as u64 },
        default: "1",
        unit: "",
        paper: "",
        help: "seeds everything that is scattered or sampled",
    },
    Setting {
        key: "lights",
        symbol: "",
        kind: Kind::Text("N[:SEED]"),
        default: "0",
        unit: "",
        paper: "",
        help: "scatter N point lights in the scene's bounds, beside its own",
    },
    Setting {
        key: "exposure",
        symbol: "",
        kind: Kind::NumberOrAuto { min: *EXPOSURES_EV.start(), max: *EXPOSURES_EV.end() },
        default: "0",
        unit: "EV",
        paper: "",
        help: "of PNGs: at 0, white diffuse under radiance 1 is 1.0; auto: brings the log average of what shines to 0.18                (Reinhard et al. 2002), of --frames as the first frame that is not black; stages beside a PNG stay at 0 then",
    },
    Setting {
        key: "tonemap",
        symbol: "",
        kind: Kind::Choice(&["clip", "reinhard", "aces"]),
        default: "clip",
        unit: "",
        paper: "",
        help: "of PNGs",
    },
    Setting {
        key: "exr",
        symbol: "",
        kind: Kind::Choice(&["float", "half"]),
        default: "float",
        unit: "",
        paper: "",
        help: "precision of EXR files",
    },
    Setting {
        key: "background",
        symbol: "",
        kind: Kind::Color,
        default: "0",
        unit: "",
        paper: "",
        help: "radiance where no surface is",
    },
    Setting {
        key: "ambient",
        symbol: "",
        kind: Kind::Text("R,G,B|auto"),
        default: "auto",
        unit: "",
        paper: "",
        help: "radiance from everywhere; auto: 0 where the scene has lights, 0.3 with the default rig",
    },
    Setting {
        key: "rig",
        symbol: "",
        kind: Kind::Choice(&["default", "always", "none"]),
        default: "default",
        unit: "",
        paper: "",
        help: "a key light of 3 lux from the camera's upper left and an ambient of 0.3: default, for a scene without punctual lights of which \
               emissive surfaces, if any, let less than half be seen; always, beside what it has",
    },
    Setting {
        key: "sun",
        symbol: "",
        kind: Kind::Choice(&["on", "off"]),
        default: "on",
        unit: "",
        paper: "",
        help: "directional lights",
    },
    Setting {
        key: "light-cutoff",
        symbol: "",
        kind: Kind::Number { min: 0.0, max: 1e6 },
        default: "0.002",
        unit: "lux",
        paper: "",
        help: "a punctual light without range ends where it gives this irradiance; 0: never",
    },
    Setting {
        key: "allocation",
        symbol: "",
        kind: Kind::Choice(&["linear", "dedicated", "tlsf"]),
        default: "linear",
        unit: "",
        paper: "",
        help: "how resources come by their memory: ranges one after the other in shared memory blocks, a memory block \
               each, or ranges in shared memory blocks wherever there is room",
    },
    Setting {
        key: "alias",
        symbol: "",
        kind: Kind::Choice(&["greedy", "optimal", "off"]),
        default: "greedy",
        unit: "",
        paper: "",
        help: "resources of a frame that never live in the same pass share bytes: placed by the best of a few orders, by a \
               search for the least sum, or never",
    },
    Setting {
        key: "submit-ms",
        symbol: "",
        kind: Kind::NumberOrAuto { min: 0.0, max: 1e6 },
        default: "auto",
        unit: "ms",
        paper: "",
        help: "what a submit takes at most, as far as work can be cut: passes go one by one and dispatches in bands of rows, as many together \
               as took that long before, samples of paths too; drivers of GPUs end what takes seconds. 0: a frame is one submit; auto: 100 on GPUs, 0 on software \
               drivers; the same picture",
    },
    Setting {
        key: "memory-budget",
        symbol: "",
        kind: Kind::Bytes,
        default: "none",
        unit: "",
        paper: "",
        help: "what memory blocks in one heap may sum up to; what would pass it is refused; none: the heap's size",
    },
    Setting {
        key: "texture-limit",
        symbol: "",
        kind: Kind::IntegerOrAuto { min: 0, max: 16384 },
        default: "auto",
        unit: "px",
        paper: "",
        help: "greatest side of a texture: larger ones begin at a coarser level; 0: no limit; auto: none, or where the scene \
               would take more than three quarters of the heap or of --memory-budget the greatest power of two with which it does not",
    },
];

/// What a surface does with light.
pub const BRDF: Setting = Setting {
    key: "brdf",
    symbol: "",
    kind: Kind::Choice(&["lambert", "blinn-phong", "ggx"]),
    default: "ggx",
    unit: "",
    paper: "",
    help: "of direct light",
};

/// Of every compute shader whose invocations are pixels.
pub const WORKGROUP: Setting = Setting {
    key: "workgroup",
    symbol: "",
    kind: Kind::Pair { min: 1, max: 256 },
    default: "64x1",
    unit: "",
    paper: "",
    help: "shape of compute workgroups",
};

/// How near virtual point lights count.
pub const VPL_CLAMP: Setting = Setting {
    key: "vpl-clamp",
    symbol: "",
    kind: Kind::Length,
    default: "2%",
    unit: "m",
    paper: "",
    help: "least distance of a virtual point light: nearer surfaces get no more light",
};

/// Whether emissive triangles light others.
pub const EMISSIVE: Setting = Setting {
    key: "emissive",
    symbol: "",
    kind: Kind::Choice(&["auto", "on", "off"]),
    default: "auto",
    unit: "",
    paper: "",
    help: "emissive triangles light other surfaces; auto: off where the scene has punctual lights, because maps carry both",
};

/// What is drawn of solid surfaces.
pub const GEOMETRY: Setting = Setting {
    key: "geometry",
    symbol: "",
    kind: Kind::Choice(&["culled", "all"]),
    default: "culled",
    unit: "",
    paper: "",
    help: "what is drawn of solid surfaces, nearest first: the clusters of triangles that the camera may see, or all (the \
           plain way to the same picture)",
};

/// Which punctual lights cast shadow rays.
pub const DIRECT_SHADOW: Setting = Setting {
    key: "direct-shadow",
    symbol: "",
    kind: Kind::Choice(&["none", "sun", "ray"]),
    default: "sun",
    unit: "",
    paper: "",
    help: "shadow rays to no light, to directional lights, or to every punctual light",
};

/// Whether shaders count.
pub const INSTRUMENT: Setting = Setting {
    key: "instrument",
    symbol: "",
    kind: Kind::Choice(&["auto", "on", "off"]),
    default: "auto",
    unit: "",
    paper: "Clarberg 2014, 4.1",
    help: "what is shaded, listed and missing is counted; auto: but in what is timed (bench, --profile), because threads that \
           count wait for each other",
};

/// What makes the lists of tiled culling.
pub const CULL_BY: Setting = Setting {
    key: "cull-by",
    symbol: "",
    kind: Kind::Choice(&["auto", "invocation", "workgroup"]),
    default: "auto",
    unit: "",
    paper: "",
    help: "a tile's list of lights is made by one invocation, or by a workgroup that shares its pixels and the lights; auto: \
           an invocation on software drivers; the same lists",
};

/// What a G-buffer without lists for tiles leaves unread.
pub const CULL_CONDITIONS: &[Condition] = &[Condition {
    key: CULL_BY.key,
    unread: |values| Unread::unless(values, "cull", &["tiled"], "there are no tiles"),
}];

/// What two normals of one surface differ by.
pub const NORMAL_THRESHOLD: Setting = Setting {
    key: "normal-threshold",
    symbol: "",
    kind: Kind::Number { min: 0.0, max: 2.0 },
    default: "0.3",
    unit: "",
    paper: "Segovia 2006, 4.5",
    help: "a neighbour is across a discontinuity where 1 - cos of the angle between the normals is greater",
};

/// How many pixels a thread works on.
pub const TEXELS: Setting = Setting {
    key: "texels",
    symbol: "",
    kind: Kind::Choice(&["auto", "1", "2", "4", "8", "16", "32"]),
    default: "auto",
    unit: "px",
    paper: "",
    help: "pixels that a thread shades, compares or filters one after the other at most, reading once what they share; 1 \
           is the plain way to the same picture; fewer where their lights cast shadow rays; auto: 32 on lavapipe of Mesa \
           22, 16 on other software drivers, else 1",
};

/// Which punctual lights surfaces have that are shaded where they are drawn (`lights::object_lists`).
pub const LIGHT_LISTS: &[Setting] = &[Setting {
    key: "light-lists",
    symbol: "",
    kind: Kind::Choice(&["object", "none"]),
    default: "object",
    unit: "",
    paper: "Kircher 2009, 5",
    help: "punctual lights of a surface that is shaded where it is drawn (every surface of forward, and what blends): those \
           whose range reaches the box around its object, or around a piece of what blends, or every light (the plain way \
           to the same picture)",
}];

/// Settings of what is drawn with several samples a pixel (`passes::resolve`).
pub const MULTISAMPLE: &[Setting] = &[Setting {
    key: "msaa",
    symbol: "",
    kind: Kind::Choice(&["1", "4", "8"]),
    default: "1",
    unit: "",
    paper: "Kircher 2009, 3",
    help: "places of a pixel that are tested for coverage and depth and averaged; a surface is shaded once a pixel",
}];

/// Of techniques that draw the scene with its materials.
pub const DEPTH_PREPASS: Setting = Setting {
    key: "depth-prepass",
    symbol: "",
    kind: Kind::Choice(&["on", "off"]),
    default: "on",
    unit: "",
    paper: "",
    help: "depth is drawn first, so that no surface is shaded that another one hides; the same picture (with --msaa 1 to \
           the bit)",
};

/// Settings of shading with a G-buffer, which several techniques read.
pub const SHADING: &[Setting] = &[
    BRDF,
    Setting {
        key: "position",
        symbol: "",
        kind: Kind::Choice(&["half", "unorm16", "depth", "float"]),
        default: "unorm16",
        unit: "",
        paper: "Segovia 2006, 4.1",
        help: "how the G-buffer holds positions: half floats (the paper's), 16-bit fractions of the scene's box, the depth \
               buffer, or 32-bit floats (the oracle)",
    },
    GEOMETRY,
    Setting {
        key: "cull",
        symbol: "",
        kind: Kind::Choice(&["none", "tiled"]),
        default: "none",
        unit: "",
        paper: "",
        help: "of direct light: every light on every pixel, or a list of lights for each tile of 16x16; the same picture",
    },
    CULL_BY,
    DIRECT_SHADOW,
    TEXELS,
    WORKGROUP,
];
