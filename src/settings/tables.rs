//! The rows that several techniques read: those of every picture, those of shading with a G-buffer, and single ones.

use super::memory::{ALIAS, ALLOCATION, IMAGE_TILING, MEMORY_BLOCK, MEMORY_BUDGET, TOUCHED};
use super::tree::TREE_GROWTH;
use super::{Changes, Kind, Setting, Unread, Values};
use crate::choice::choices;
use crate::picture::image_file::ExrPrecision;
use crate::picture::tonemap::{EXPOSURES_EV, ToneMap};

/// Settings that every technique and every picture has.
pub const COMMON: &[Setting] = &[
    Setting {
        key: "size",
        kind: Kind::Pair { min: 1, max: 16384 },
        default: "1280x720",
        unit: "px",
        help: "Width and height of the picture",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "camera",
        kind: Kind::Text("INDEX|NAME"),
        default: "0",
        help: "Camera of the scene, by index or name; `framing`: one that frames the whole scene from three quarters \
               above, on the side that most front faces look to; a scene without a camera gets this one",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "time",
        kind: Kind::Number { min: 0.0, max: 1e9 },
        default: "0",
        unit: "s",
        help: "Moment of the animations that is drawn; nothing else moves",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "animation",
        kind: Kind::Text("all|none|INDEX|NAME"),
        default: "all",
        help: "Animations of the file to play: all of them at once, none (the rest pose), or one by index or name",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "seed",
        kind: Kind::Integer { min: 0, max: u32::MAX as u64 },
        default: "1",
        help: "Seed of everything that is scattered or sampled",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "lights",
        kind: Kind::Text("N[:SEED]"),
        default: "0",
        help: "Scatter N point lights within the scene's bounds, in addition to its own lights",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "exposure",
        kind: Kind::Number { min: *EXPOSURES_EV.start(), max: *EXPOSURES_EV.end() },
        auto: true,
        default: "0",
        unit: "EV",
        help: "Exposure of PNG output; at 0, white diffuse under radiance 1 is 1.0; auto: brings the log average of \
               the light in the picture to 0.18 (Reinhard et al. 2002), and with --frames uses the exposure of the \
               first frame that is not black; stages that --aov writes beside a PNG stay at exposure 0 then",
        ..Setting::changing(Changes::File)
    },
    Setting {
        key: "tonemap",
        kind: Kind::Choice(ToneMap::WORDS),
        default: "clip",
        help: "Tone-mapping operator of PNG output",
        ..Setting::changing(Changes::File)
    },
    Setting {
        key: "exr",
        kind: Kind::Choice(ExrPrecision::WORDS),
        default: "float",
        help: "Precision of the numbers in EXR files",
        ..Setting::changing(Changes::File)
    },
    Setting {
        key: "background",
        kind: Kind::Color,
        default: "0",
        help: "Radiance where no surface is",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "ambient",
        kind: Kind::Text("R,G,B|auto"),
        default: "auto",
        help: "Radiance that reaches surfaces from all directions; auto: 0 where the scene has lights, 0.3 with the \
               default rig",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "rig",
        kind: Kind::Choice(Rig::WORDS),
        default: "default",
        help: "Add a key light of 3 lux from the camera's upper left and an ambient radiance of 0.3; default: only to \
               a scene without punctual lights in which emissive surfaces, if there are any, make less than half of it \
               visible; always: in addition to the scene's own lights; none: never",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "sun",
        kind: Kind::Choice(&["on", "off"]),
        default: "on",
        help: "Whether directional lights shine",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "light-cutoff",
        kind: Kind::Number { min: 0.0, max: 1e6 },
        default: "0.002",
        unit: "lux",
        help: "Irradiance at which a punctual light without a range of its own is cut off; 0: never",
        ..Setting::changing(Changes::Picture)
    },
    ALLOCATION,
    MEMORY_BLOCK,
    IMAGE_TILING,
    ALIAS,
    Setting {
        key: "submit-ms",
        kind: Kind::Number { min: 0.0, max: 1e6 },
        auto: true,
        default: "auto",
        unit: "ms",
        help: "Longest time of one submit, as far as the work can be divided, because GPU drivers abort submits that \
               take seconds: passes are submitted one by one, dispatches in bands of rows and paths in groups of \
               samples, each as large as took this long before; 0: a frame is one submit; auto: 100 on GPUs, 0 on \
               software drivers; the same picture",
        ..Setting::changing(Changes::Nothing)
    },
    TREE_GROWTH,
    MEMORY_BUDGET,
    TOUCHED,
    Setting {
        key: "texture-limit",
        kind: Kind::Integer { min: 0, max: 16384 },
        auto: true,
        default: "auto",
        unit: "px",
        help: "Longest side of a texture in pixels; larger textures start at a coarser mip level; 0: no limit; auto: \
               no limit, or, where the scene would take more than three quarters of the heap or of --memory-budget, \
               the greatest power of two with which it does not",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "texture-gutters",
        kind: Kind::Choice(Gutters::WORDS),
        default: "fill",
        help: "What a texture's coarser levels take in that no triangle shows, such as the ground between the charts of an \
               atlas: nothing, they are means of what is shown and take after it beside it (fill); or all of it, as \
               most programs have them, so that it shows at the charts' edges (keep)",
        unread: at_finest_level,
        ..Setting::changing(Changes::Picture)
    },
    ANISOTROPY,
];

pub const ANISOTROPY: Setting = Setting {
    key: "anisotropy",
    kind: Kind::Integer { min: 1, max: 16 },
    default: "1",
    help: "How many times as long as wide the part of a texture may be that a pixel averages, where a surface is seen at \
           a slant; 1: as long as wide, and blurred across by as much as it is long",
    unread: at_finest_level,
    ..Setting::changing(Changes::Picture)
};

/// What only coarser levels of textures have is unread where rays read none.
fn at_finest_level(values: &Values) -> Option<Unread> {
    let is_finest = values.get("texture-level") == Some("0");
    is_finest.then(|| Unread::at(values, "texture-level", "--texture-level cone", "rays read the finest level"))
}

choices! {
    /// What coarser levels of a texture take in that no triangle shows (`--texture-gutters`).
    pub enum Gutters {
        /// Nothing.
        "fill" => Fill,
        "keep" => Keep,
    }
}

choices! {
    /// When the default rig lights a scene (`--rig`).
    pub enum Rig {
        "default" => Default,
        "always" => Always,
        "none" => None,
    }
}

choices! {
    /// Which BRDF direct light uses (`--brdf`); the number is the shader's.
    pub enum Brdf {
        "lambert" => Lambert = 0,
        "blinn-phong" => BlinnPhong = 1,
        "ggx" => Ggx = 2,
    }
}

/// The reflectance model of surfaces.
pub const BRDF: Setting = Setting {
    key: "brdf",
    kind: Kind::Choice(Brdf::WORDS),
    default: "ggx",
    help: "Reflectance model of surfaces under direct light",
    ..Setting::changing(Changes::Picture)
};

/// Workgroup size of every compute shader whose invocations are pixels.
pub const WORKGROUP: Setting = Setting {
    key: "workgroup",
    kind: Kind::Pair { min: 1, max: 256 },
    auto: true,
    default: "auto",
    help: "Width and height of compute workgroups, in invocations; auto: 64x1 on software drivers, 16x16 on GPUs that \
           allow it; the same picture",
    ..Setting::changing(Changes::Nothing)
};

/// Whether emissive triangles light others.
pub const EMISSIVE: Setting = Setting {
    key: "emissive",
    kind: Kind::Choice(&["on", "off"]),
    auto: true,
    default: "auto",
    help: "Whether emissive triangles light other surfaces; auto: off where the scene has punctual lights, because \
           maps carry both",
    ..Setting::changing(Changes::Picture)
};

choices! {
    /// What is drawn of the solid draws, front to back (`--geometry`, `--shadow-casters`).
    pub enum GeometryChoice {
        /// The clusters that the view may see.
        "culled" => Culled,
        /// Every cluster: the oracle.
        "all" => All,
    }
}

/// Which triangles of solid surfaces are drawn.
pub const GEOMETRY: Setting = Setting {
    key: "geometry",
    kind: Kind::Choice(GeometryChoice::WORDS),
    default: "culled",
    help: "Solid surfaces to draw, nearest first: only the clusters of triangles that the camera may see (culled), or \
           all of them (the plain way to the same picture)",
    ..Setting::changing(Changes::Nothing)
};

choices! {
    /// Which lights cast shadow rays (`--direct-shadow`); the number is the shader's.
    pub enum DirectShadow {
        "none" => None = 0,
        "sun" => Sun = 1,
        "ray" => Ray = 2,
        /// No light by rays, all by shadow maps (`passes::shadow_maps`).
        "map" => Map = 3,
    }
}

/// The words of `DirectShadow` without the last: techniques without shadow maps have no `map`.
const TRACED_SHADOW: &[&str] = DirectShadow::WORDS.split_at(DirectShadow::WORDS.len() - 1).0;

/// Which punctual lights cast shadow rays.
pub const DIRECT_SHADOW: Setting = Setting {
    key: "direct-shadow",
    kind: Kind::Choice(TRACED_SHADOW),
    default: "sun",
    help: "Lights that cast shadows by rays: none, directional lights (sun), or every punctual light (ray)",
    ..Setting::changing(Changes::Picture)
};

/// Whether shaders count.
pub const INSTRUMENT: Setting = Setting {
    key: "instrument",
    kind: Kind::Choice(&["on", "off"]),
    auto: true,
    default: "auto",
    paper: "Clarberg 2014, 4.1",
    help: "Whether shaders count what is shaded, listed and missing; auto: on, except where times are measured (bench, \
           --profile), because threads that count wait for each other",
    ..Setting::changing(Changes::Nothing)
};

choices! {
    /// What makes a tile's list of lights (`--cull-by`).
    pub enum CullBy {
        /// Reads the tile's pixels and tries its lights one after the other.
        "invocation" => Invocation,
        /// Shares them among its threads.
        "workgroup" => Workgroup,
    }
}

/// What makes the lists of tiled culling.
pub const CULL_BY: Setting = Setting {
    key: "cull-by",
    kind: Kind::Choice(CullBy::WORDS),
    auto: true,
    default: "auto",
    help: "What makes a tile's list of lights: one invocation, or a workgroup that shares out the tile's pixels and \
           the lights; auto: an invocation on software drivers, a workgroup elsewhere; the same lists",
    unread: |values| Unread::unless(values, CULL.key, &[CullChoice::Tiled], "there are no tiles"),
    ..Setting::changing(Changes::Nothing)
};

/// How much two normals of one surface may differ.
pub const NORMAL_THRESHOLD: Setting = Setting {
    key: "normal-threshold",
    kind: Kind::Number { min: 0.0, max: 2.0 },
    default: "0.3",
    paper: "Segovia 2006, 4.5",
    help: "Difference of two normals, as 1 - cos of the angle between them, above which two neighbouring pixels lie \
           across a discontinuity",
    ..Setting::changing(Changes::Picture)
};

/// How far a neighbour of one surface may lie off a pixel's plane.
pub const POSITION_THRESHOLD: Setting = Setting {
    key: "position-threshold",
    kind: Kind::Length,
    default: "0.5%",
    unit: "m",
    paper: "Segovia 2006, 4.5",
    help: "Distance from a pixel's tangent plane above which a neighbour lies across a discontinuity",
    ..Setting::changing(Changes::Picture)
};

/// How many pixels a thread works on.
pub const TEXELS: Setting = Setting {
    key: "texels",
    kind: Kind::Choice(&["1", "2", "4", "8", "16", "32"]),
    auto: true,
    default: "auto",
    unit: "px",
    help: "Most pixels that one thread shades, compares or filters one after the other, reading once what they share; \
           1 is the plain way to the same picture; fewer are used where lights cast shadow rays; auto: 32 on lavapipe \
           of Mesa 22, 16 on other software drivers, 1 elsewhere",
    ..Setting::changing(Changes::Nothing)
};

choices! {
    /// Which lists of lights there are for surfaces that are shaded where they are drawn (`--light-lists`).
    pub enum ListChoice {
        /// A list for each draw, or piece of one.
        "object" => Object,
        /// One list of every light for all draws: the oracle.
        "none" => None,
    }
}

/// Which punctual lights surfaces have that are shaded where they are drawn (`lights::object_lists`).
pub const LIGHT_LISTS: &[Setting] = &[Setting {
    key: "light-lists",
    kind: Kind::Choice(ListChoice::WORDS),
    default: "object",
    paper: "Kircher 2009, 5",
    help: "Punctual lights that are evaluated for a surface shaded while it is drawn (every surface of forward, and \
           BLEND surfaces): those whose range reaches the box around its object, or around a piece of a BLEND surface \
           (object), or every light (none, the plain way to the same picture)",
    ..Setting::changing(Changes::Nothing)
}];

choices! {
    /// What holds a channel of a sample (`--sample-format`).
    pub enum SampleFormat {
        "float" => Float,
        "half" => Half,
    }
}

/// Settings of what is drawn with several samples a pixel (`passes::resolve`).
pub const MULTISAMPLE: &[Setting] = &[
    Setting {
        key: "msaa",
        kind: Kind::Choice(&["1", "4", "8"]),
        default: "1",
        paper: "Kircher 2009, 3",
        help: "Samples of a pixel that are tested for coverage and depth and then averaged; each surface is shaded \
               once a pixel, or as --sample-shading says",
        ..Setting::changing(Changes::Samples)
    },
    Setting {
        key: "sample-shading",
        kind: Kind::Choice(&["off", "on"]),
        default: "off",
        paper: "Kircher 2009, 3",
        help: "Shade each surface once for each sample of --msaa that it covers, at the sample's place: without the \
               artefacts of one place for all of a pixel, and with holes of MASK surfaces as smooth as edges, at the \
               price of as many more fragments",
        unread: |values| Unread::with(values, "msaa", &["1"], "a pixel has one sample"),
        ..Setting::changing(Changes::Samples)
    },
    Setting {
        key: "sample-format",
        kind: Kind::Choice(SampleFormat::WORDS),
        default: "float",
        help: "What holds a channel of a sample of --msaa: a float of 32 bits, or one of 16, in half the memory, up to \
               65504 and rounded to 11 bits (lavapipe cuts what lies beyond them off); their mean has 32 bits",
        unread: |values| Unread::with(values, "msaa", &["1"], "a pixel has one sample"),
        ..Setting::changing(Changes::Picture)
    },
];

/// Whether techniques that draw the scene with its materials draw depth first.
pub const DEPTH_PREPASS: Setting = Setting {
    key: "depth-prepass",
    kind: Kind::Choice(&["on", "off"]),
    default: "on",
    help: "Draw depth first, so that no surface is shaded that another one hides; the same picture (with --msaa 1 to \
           the bit)",
    ..Setting::changing(Changes::Nothing)
};

choices! {
    /// How a G-buffer keeps positions (`--position`).
    pub enum PositionStorage {
        "half" => Half,
        "unorm16" => Unorm16,
        "depth" => Depth,
        "float" => Float,
    }
}

choices! {
    /// Which lights direct lighting evaluates for a pixel (`--cull`).
    pub enum CullChoice {
        "none" => None,
        "tiled" => Tiled,
    }
}

/// How the G-buffer stores positions.
pub const POSITION: Setting = Setting {
    key: "position",
    kind: Kind::Choice(PositionStorage::WORDS),
    default: "unorm16",
    paper: "Segovia 2006, 4.1",
    help: "How the G-buffer stores positions: as half floats (the paper's), as 16-bit fractions of the scene's box \
           (unorm16), as the depth buffer, or as 32-bit floats (the most exact, for comparison)",
    ..Setting::changing(Changes::Picture)
};

/// Which lights direct lighting evaluates for a pixel.
pub const CULL: Setting = Setting {
    key: "cull",
    kind: Kind::Choice(CullChoice::WORDS),
    default: "none",
    help: "Lights that are evaluated for a pixel in direct lighting: all of them (none), or a list for each tile \
           of 16x16 pixels (tiled); the same picture",
    ..Setting::changing(Changes::Nothing)
};

/// Settings of shading with a G-buffer, which several techniques read.
pub const SHADING: &[Setting] = &[BRDF, POSITION, GEOMETRY, CULL, CULL_BY, DIRECT_SHADOW, TEXELS, WORKGROUP];
