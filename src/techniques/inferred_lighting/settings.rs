//! The settings of inferred lighting.

use super::assignment::{Assignment, StippleSize};
use super::blend_names;
use super::choices::{Alpha, AlphaFilter, LightFetch, LightFilter};
use super::encoding::{FIXED_LIMIT, PackingFormat};
use super::light::Volumes;
use super::light::store::{Fresnel, Highlight, Sums};
use crate::settings::{
    BRDF, Brdf, CULL_BY, Changes, DEPTH_PREPASS, DIRECT_SHADOW, GEOMETRY, INSTRUMENT, Kind, MOTION_INTERVAL,
    MOTION_VECTORS, NORMAL_THRESHOLD, Setting, TEXELS, Unread, Values, WORKGROUP,
};

/// Its rows of the table.
pub const SETTINGS: &[Setting] = &[
    INSTRUMENT,
    BRDF,
    GEOMETRY,
    DIRECT_SHADOW,
    DEPTH_PREPASS,
    Setting { unread: |values| Unread::unless(values, "volumes", &[Volumes::Tiled], "there are no tiles"), ..CULL_BY },
    TEXELS,
    WORKGROUP,
    NORMAL_THRESHOLD,
    Setting {
        key: "light-size",
        kind: Kind::Pair { min: 1, max: 16384 },
        auto: true,
        default: "auto",
        unit: "px",
        paper: "Kircher 2009, 2.2",
        help: "Width and height of the geometry pass and the light pass; auto: 0.625 of the frame, so 800x450 for \
               1280x720",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "extras",
        kind: Kind::Choice(&["on", "off"]),
        default: "on",
        paper: "Kircher 2009, 2.1",
        help: "Write roughness and material id in the geometry pass, 4 bytes a texel; off: every highlight is as wide \
               as --light-roughness says",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "light-roughness",
        kind: Kind::Number { min: 0.0, max: 1.0 },
        default: "0.5",
        paper: "Kircher 2009, 2.2",
        help: "Roughness of every surface in the light pass with --extras off",
        unread: |values| Unread::unless(values, "extras", &["off"], "each texel has its own roughness"),
        ..Setting::changing(Changes::Picture)
    },
    MOTION_VECTORS,
    MOTION_INTERVAL,
    Setting {
        key: "volumes",
        kind: Kind::Choice(Volumes::WORDS),
        default: "tiled",
        paper: "Kircher 2009, 2.2",
        help: "How texels find their lights: by a list of lights for each tile, in one dispatch (tiled); or by one \
               draw for each light, over the whole frame (quad), within the rectangle that bounds its reach (scissor), \
               where its volume meets a surface (stencil, depth-fail), or within both limits (both); auto: both, but \
               without the stencil for lights smaller than --stencil-least",
        ..Setting::changing(Changes::Nothing)
    },
    Setting {
        key: "stencil-least",
        kind: Kind::Integer { min: 0, max: 1 << 28 },
        default: "4096",
        unit: "texels",
        paper: "Kircher 2009, 2.2",
        help: "Number of texels in a light's rectangle from which --volumes auto draws it with the stencil (lavapipe: \
               the stencil pays from some 16384 on, and below makes no difference)",
        unread: |values| Unread::unless(values, "volumes", &[Volumes::Auto], "all lights are drawn in the same way"),
        ..Setting::changing(Changes::Nothing)
    },
    Setting {
        key: "shadow-volumes",
        kind: Kind::Integer { min: 0, max: 65_536 },
        default: "0",
        unit: "lights",
        paper: "Kircher 2009, 4, 7",
        help: "Number of lights that cast stencil shadow volumes of all closed opaque and MASK surfaces, instead of \
               the rays of --direct-shadow: directional lights first, then those of most flux; not with --volumes \
               tiled",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "l-buffer",
        kind: Kind::Choice(Sums::WORDS),
        default: "float",
        paper: "Kircher 2009, 2.2, 5.1",
        help: "How the L-buffer sums up light: in 32 bits and packed once, as --highlight says (float) or to 16 bits of \
               fixed point (fixed); or blended in half floats, as in the paper (half)",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "highlight",
        kind: Kind::Choice(Highlight::WORDS),
        auto: true,
        default: "auto",
        paper: "Kircher 2009, 2.2",
        help: "What the L-buffer keeps of highlights, in 8 bytes a texel with the light: three channels of each, with \
               Fresnel's factor of each light over F0, which --extras knows (rgb); two numbers, one for F0 and one for \
               F90, coloured as the diffuse light (split); or one number so coloured, the paper's (intensity). auto: \
               rgb; with --extras off split; where there are four channels only (--l-buffer fixed, --light-fetch \
               sampler) intensity",
        unread: |values| Unread::unless(values, "brdf", &[Brdf::Ggx, Brdf::BlinnPhong], "nothing mirrors"),
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "fresnel",
        kind: Kind::Choice(Fresnel::WORDS),
        default: "light",
        paper: "Kircher 2009, 2.2",
        help: "Fresnel's factor in --highlight intensity: that of each light's angle, over F0 (light), or that of normal \
               incidence, as in the paper (normal)",
        unread: |values| {
            let has_four = values.is("l-buffer", Sums::Fixed) || values.is("light-fetch", LightFetch::Sampler);
            let is_one = has_four && values.unless_auto("highlight", Values::choice::<Highlight>).is_none();
            let unmirrored = Unread::unless(values, "brdf", &[Brdf::Ggx, Brdf::BlinnPhong], "nothing mirrors");
            let whole =
                || Unread::unless(values, "highlight", &[Highlight::Intensity], "it has the factor of each light");
            unmirrored.or_else(|| if is_one { None } else { whole() })
        },
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "light-range",
        kind: Kind::Number { min: 0.001, max: 65504.0 },
        default: "32",
        unit: "lx",
        paper: "Kircher 2009, 5.1",
        help: "Most light that --l-buffer fixed can hold; brighter texels are clamped to it, and counted",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "packing",
        kind: Kind::Choice(PackingFormat::WORDS),
        default: "words",
        paper: "Kircher 2009, 5",
        help: "Format in which the geometry pass writes a texel's two 16-bit numbers: one word (words), the bytes of \
               four channels (rgba8), or two channels of fixed point (fixed)",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "fixed-range",
        kind: Kind::Number { min: 1.0, max: FIXED_LIMIT },
        default: "32",
        paper: "Kircher 2009, 5.1",
        help: "Factor by which --packing fixed scales numbers from -1 to 1 into its format, which goes from -32 to 32; \
               32 uses every step of it, 1 a 32nd of them",
        unread: |values| Unread::unless(values, "packing", &[PackingFormat::Fixed], "it packs without fixed point"),
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "light-filter",
        kind: Kind::Choice(LightFilter::WORDS),
        default: "dsf",
        paper: "Kircher 2009, 3",
        help: "How four texels of the light buffer become the light of a pixel: by the discontinuity sensitive filter, \
               which takes those of the pixel's object and normal group (dsf); whatever they show, bilinear or the \
               nearest one; or by normal and distance from the tangent plane, with weights that fall off (bilateral, a \
               joint bilateral filter) or that are 0 or 1 (discontinuity: Segovia 2006, 4.5)",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "light-fetch",
        kind: Kind::Choice(LightFetch::WORDS),
        default: "texels",
        paper: "Kircher 2009, 7.1",
        help: "How the four texels of a solid surface's pixel are read where all of them belong to that surface: one \
               by one (texels), or blended by the sampler in a single fetch, with the device's precision of position \
               (sampler)",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "light-rings",
        kind: Kind::Integer { min: 0, max: 1 },
        default: "1",
        unit: "texels",
        paper: "Kircher 2009, 3",
        help: "How far beyond the four texels a surface looks for its own where none of the four is: one texel more (1), \
               or not at all, as in the paper (0)",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "depth-threshold",
        kind: Kind::Number { min: 0.0, max: 1.0 },
        default: "0.05",
        paper: "Kircher 2009, 3.1",
        help: "Most by which a sample of the filter may differ, as a part of the pixel's depth: in depth, or, where \
               normals decide, in distance from the tangent plane",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "alpha",
        kind: Kind::Choice(Alpha::WORDS),
        default: "blend",
        paper: "Kircher 2009, 4, 6",
        help: "How BLEND surfaces are drawn: stippled into the light buffer and blended (blend), or as solid surfaces \
               where their alpha is at least 0.5 (test)",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "stipple",
        kind: Kind::Choice(StippleSize::WORDS),
        auto: true,
        default: "auto",
        unit: "px",
        paper: "Kircher 2009, 4",
        help: "Texels at which BLEND surfaces are lit: one in four (2x2, which leaves 3 layers over the solid one) or \
               one in sixteen (4x4, 15 layers). auto: 4x4 where with 2x2 they would share layers on more than 0.07 of the \
               screen",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "assignment",
        kind: Kind::Choice(Assignment::WORDS),
        default: "overlap",
        paper: "Kircher 2009, 4, 7.1",
        help: "How BLEND surfaces share the layers of the stipple: those that overlap on the screen get different \
               ones, or those that they share least with, nearest first (overlap, not the paper's); in rotation from \
               the nearest on (depth); or as --stipple-layers says, the rest in rotation in the order of the file \
               (static)",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "stipple-layers",
        kind: Kind::Text("NAME=LAYER,...|none"),
        default: blend_names::NONE,
        paper: "Kircher 2009, 4",
        help: "Layers of the stipple for --assignment static, 1 to 3 or 15, for BLEND surfaces by the name of their \
               node or material; these go before quincunx_stipple_layer in the extras of a file's nodes and materials",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "decals",
        kind: Kind::Text("NAME,...|none"),
        default: blend_names::NONE,
        paper: "Kircher 2009, 5.2",
        help: "BLEND surfaces, by the name of their node or material, that lie on others: their normals are blended into \
               those, and they are lit with them instead of in a layer of the stipple; --packing fixed has channels \
               that can be blended",
        unread: |values| Unread::unless(values, "alpha", &[Alpha::Blend], "BLEND surfaces are solid"),
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "alpha-filter",
        kind: Kind::Choice(AlphaFilter::WORDS),
        default: "cone",
        paper: "Kircher 2009, 4",
        help: "Weights of the four samples nearest to a fragment of a BLEND surface: falling to 0 at --cone-radius \
               (cone), or bilinear",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "cone-radius",
        kind: Kind::Number { min: 0.1, max: 64.0 },
        default: "2",
        unit: "texels",
        paper: "Kircher 2009, 4",
        help: "Radius of --alpha-filter cone, in texels of the light buffer; it is doubled with --stipple 4x4",
        unread: |values| Unread::unless(values, "alpha-filter", &[AlphaFilter::Cone], "its weights have no radius"),
        ..Setting::changing(Changes::Picture)
    },
];
