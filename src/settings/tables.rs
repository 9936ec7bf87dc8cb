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
        help: "Width and height of the picture",
    },
    Setting {
        key: "camera",
        symbol: "",
        kind: Kind::Text("INDEX|NAME"),
        default: "0",
        unit: "",
        paper: "",
        help: "Camera of the scene, by index or name; `framing`: one that frames the whole scene from three quarters \
               above, on the side that most front faces look to; a scene without a camera gets this one",
    },
    Setting {
        key: "time",
        symbol: "",
        kind: Kind::Number { min: 0.0, max: 1e9 },
        default: "0",
        unit: "s",
        paper: "",
        help: "Moment of the animations that is drawn; nothing else moves",
    },
    Setting {
        key: "animation",
        symbol: "",
        kind: Kind::Text("all|none|INDEX|NAME"),
        default: "all",
        unit: "",
        paper: "",
        help: "Animations of the file to play: all of them at once, none (the rest pose), or one by index or name",
    },
    Setting {
        key: "seed",
        symbol: "",
        kind: Kind::Integer { min: 0, max: u32::MAX as u64 },
        default: "1",
        unit: "",
        paper: "",
        help: "Seed of everything that is scattered or sampled",
    },
    Setting {
        key: "lights",
        symbol: "",
        kind: Kind::Text("N[:SEED]"),
        default: "0",
        unit: "",
        paper: "",
        help: "Scatter N point lights within the scene's bounds, in addition to its own lights",
    },
    Setting {
        key: "exposure",
        symbol: "",
        kind: Kind::NumberOrAuto { min: *EXPOSURES_EV.start(), max: *EXPOSURES_EV.end() },
        default: "0",
        unit: "EV",
        paper: "",
        help: "Exposure of PNG output; at 0, white diffuse under radiance 1 is 1.0; auto: brings the log average of \
               the light in the picture to 0.18 (Reinhard et al. 2002), and with --frames uses the exposure of the \
               first frame that is not black; stages that --aov writes beside a PNG stay at exposure 0 then",
    },
    Setting {
        key: "tonemap",
        symbol: "",
        kind: Kind::Choice(&["clip", "reinhard", "aces"]),
        default: "clip",
        unit: "",
        paper: "",
        help: "Tone-mapping operator of PNG output",
    },
    Setting {
        key: "exr",
        symbol: "",
        kind: Kind::Choice(&["float", "half"]),
        default: "float",
        unit: "",
        paper: "",
        help: "Precision of the numbers in EXR files",
    },
    Setting {
        key: "background",
        symbol: "",
        kind: Kind::Color,
        default: "0",
        unit: "",
        paper: "",
        help: "Radiance where no surface is",
    },
    Setting {
        key: "ambient",
        symbol: "",
        kind: Kind::Text("R,G,B|auto"),
        default: "auto",
        unit: "",
        paper: "",
        help: "Radiance that reaches surfaces from all directions; auto: 0 where the scene has lights, 0.3 with the \
               default rig",
    },
    Setting {
        key: "rig",
        symbol: "",
        kind: Kind::Choice(&["default", "always", "none"]),
        default: "default",
        unit: "",
        paper: "",
        help: "Add a key light of 3 lux from the camera's upper left and an ambient radiance of 0.3; default: only to \
               a scene without punctual lights in which emissive surfaces, if there are any, make less than half of it \
               visible; always: in addition to the scene's own lights; none: never",
    },
    Setting {
        key: "sun",
        symbol: "",
        kind: Kind::Choice(&["on", "off"]),
        default: "on",
        unit: "",
        paper: "",
        help: "Whether directional lights shine",
    },
    Setting {
        key: "light-cutoff",
        symbol: "",
        kind: Kind::Number { min: 0.0, max: 1e6 },
        default: "0.002",
        unit: "lux",
        paper: "",
        help: "Irradiance at which a punctual light without a range of its own is cut off; 0: never",
    },
    Setting {
        key: "allocation",
        symbol: "",
        kind: Kind::Choice(&["linear", "dedicated", "tlsf"]),
        default: "linear",
        unit: "",
        paper: "",
        help: "How memory is allocated for resources: as ranges one after the other in shared memory blocks (linear), \
               as one memory block for each (dedicated), or as ranges in shared memory blocks wherever there is room \
               (tlsf)",
    },
    Setting {
        key: "alias",
        symbol: "",
        kind: Kind::Choice(&["greedy", "optimal", "off"]),
        default: "greedy",
        unit: "",
        paper: "",
        help: "How resources of a frame that never live in the same pass share bytes: placed by the best of a few \
               orders (greedy), by a search for the least sum (optimal), or not at all (off)",
    },
    Setting {
        key: "submit-ms",
        symbol: "",
        kind: Kind::NumberOrAuto { min: 0.0, max: 1e6 },
        default: "auto",
        unit: "ms",
        paper: "",
        help: "Longest time of one submit, as far as the work can be divided, because GPU drivers abort submits that \
               take seconds: passes are submitted one by one, dispatches in bands of rows and paths in groups of \
               samples, each as large as took this long before; 0: a frame is one submit; auto: 100 on GPUs, 0 on \
               software drivers; the same picture",
    },
    Setting {
        key: "memory-budget",
        symbol: "",
        kind: Kind::Bytes,
        default: "none",
        unit: "",
        paper: "",
        help: "Most bytes that the memory blocks of one heap may sum up to; an allocation beyond it is refused; none: \
               the heap's size",
    },
    Setting {
        key: "texture-limit",
        symbol: "",
        kind: Kind::IntegerOrAuto { min: 0, max: 16384 },
        default: "auto",
        unit: "px",
        paper: "",
        help: "Longest side of a texture in pixels; larger textures start at a coarser mip level; 0: no limit; auto: \
               no limit, or, where the scene would take more than three quarters of the heap or of --memory-budget, \
               the greatest power of two with which it does not",
    },
];

/// The reflectance model of surfaces.
pub const BRDF: Setting = Setting {
    key: "brdf",
    symbol: "",
    kind: Kind::Choice(&["lambert", "blinn-phong", "ggx"]),
    default: "ggx",
    unit: "",
    paper: "",
    help: "Reflectance model of surfaces under direct light",
};

/// Workgroup size of every compute shader whose invocations are pixels.
pub const WORKGROUP: Setting = Setting {
    key: "workgroup",
    symbol: "",
    kind: Kind::Pair { min: 1, max: 256 },
    default: "64x1",
    unit: "",
    paper: "",
    help: "Width and height of compute workgroups, in invocations",
};

/// How near virtual point lights count.
pub const VPL_CLAMP: Setting = Setting {
    key: "vpl-clamp",
    symbol: "",
    kind: Kind::Length,
    default: "2%",
    unit: "m",
    paper: "",
    help: "Least distance at which a virtual point light is evaluated; surfaces nearer than this get no more light",
};

/// Whether emissive triangles light others.
pub const EMISSIVE: Setting = Setting {
    key: "emissive",
    symbol: "",
    kind: Kind::Choice(&["auto", "on", "off"]),
    default: "auto",
    unit: "",
    paper: "",
    help: "Whether emissive triangles light other surfaces; auto: off where the scene has punctual lights, because \
           maps carry both",
};

/// Which triangles of solid surfaces are drawn.
pub const GEOMETRY: Setting = Setting {
    key: "geometry",
    symbol: "",
    kind: Kind::Choice(&["culled", "all"]),
    default: "culled",
    unit: "",
    paper: "",
    help: "Solid surfaces to draw, nearest first: only the clusters of triangles that the camera may see (culled), or \
           all of them (the plain way to the same picture)",
};

/// Which punctual lights cast shadow rays.
pub const DIRECT_SHADOW: Setting = Setting {
    key: "direct-shadow",
    symbol: "",
    kind: Kind::Choice(&["none", "sun", "ray"]),
    default: "sun",
    unit: "",
    paper: "",
    help: "Lights that cast shadows by rays: none, directional lights (sun), or every punctual light (ray)",
};

/// Whether shaders count.
pub const INSTRUMENT: Setting = Setting {
    key: "instrument",
    symbol: "",
    kind: Kind::Choice(&["auto", "on", "off"]),
    default: "auto",
    unit: "",
    paper: "Clarberg 2014, 4.1",
    help: "Whether shaders count what is shaded, listed and missing; auto: on, except where times are measured (bench, \
           --profile), because threads that count wait for each other",
};

/// What makes the lists of tiled culling.
pub const CULL_BY: Setting = Setting {
    key: "cull-by",
    symbol: "",
    kind: Kind::Choice(&["auto", "invocation", "workgroup"]),
    default: "auto",
    unit: "",
    paper: "",
    help: "What makes a tile's list of lights: one invocation, or a workgroup that shares out the tile's pixels and \
           the lights; auto: an invocation on software drivers, a workgroup elsewhere; the same lists",
};

/// Settings that are not read without light lists for tiles.
pub const CULL_CONDITIONS: &[Condition] = &[Condition {
    key: CULL_BY.key,
    unread: |values| Unread::unless(values, "cull", &["tiled"], "there are no tiles"),
}];

/// How much two normals of one surface may differ.
pub const NORMAL_THRESHOLD: Setting = Setting {
    key: "normal-threshold",
    symbol: "",
    kind: Kind::Number { min: 0.0, max: 2.0 },
    default: "0.3",
    unit: "",
    paper: "Segovia 2006, 4.5",
    help: "Difference of two normals, as 1 - cos of the angle between them, above which two neighbouring pixels lie \
           across a discontinuity",
};

/// How many pixels a thread works on.
pub const TEXELS: Setting = Setting {
    key: "texels",
    symbol: "",
    kind: Kind::Choice(&["auto", "1", "2", "4", "8", "16", "32"]),
    default: "auto",
    unit: "px",
    paper: "",
    help: "Most pixels that one thread shades, compares or filters one after the other, reading once what they share; \
           1 is the plain way to the same picture; fewer are used where lights cast shadow rays; auto: 32 on lavapipe \
           of Mesa 22, 16 on other software drivers, 1 elsewhere",
};

/// Which punctual lights surfaces have that are shaded where they are drawn (`lights::object_lists`).
pub const LIGHT_LISTS: &[Setting] = &[Setting {
    key: "light-lists",
    symbol: "",
    kind: Kind::Choice(&["object", "none"]),
    default: "object",
    unit: "",
    paper: "Kircher 2009, 5",
    help: "Punctual lights that are evaluated for a surface shaded while it is drawn (every surface of forward, and \
           BLEND surfaces): those whose range reaches the box around its object, or around a piece of a BLEND surface \
           (object), or every light (none, the plain way to the same picture)",
}];

/// Settings of what is drawn with several samples a pixel (`passes::resolve`).
pub const MULTISAMPLE: &[Setting] = &[Setting {
    key: "msaa",
    symbol: "",
    kind: Kind::Choice(&["1", "4", "8"]),
    default: "1",
    unit: "",
    paper: "Kircher 2009, 3",
    help: "Samples of a pixel that are tested for coverage and depth and then averaged; each surface is shaded once a \
           pixel",
}];

/// Whether techniques that draw the scene with its materials draw depth first.
pub const DEPTH_PREPASS: Setting = Setting {
    key: "depth-prepass",
    symbol: "",
    kind: Kind::Choice(&["on", "off"]),
    default: "on",
    unit: "",
    paper: "",
    help: "Draw depth first, so that no surface is shaded that another one hides; the same picture (with --msaa 1 to \
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
        help: "How the G-buffer stores positions: as half floats (the paper's), as 16-bit fractions of the scene's box \
               (unorm16), as the depth buffer, or as 32-bit floats (the most exact, for comparison)",
    },
    GEOMETRY,
    Setting {
        key: "cull",
        symbol: "",
        kind: Kind::Choice(&["none", "tiled"]),
        default: "none",
        unit: "",
        paper: "",
        help: "Lights that are evaluated for a pixel in direct lighting: all of them (none), or a list for each tile \
               of 16x16 pixels (tiled); the same picture",
    },
    CULL_BY,
    DIRECT_SHADOW,
    TEXELS,
    WORKGROUP,
];
