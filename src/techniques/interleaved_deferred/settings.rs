//! The settings of interleaved deferred shading.

use super::choices::{BlendLights, Direct, StopAt, VplShadow};
use super::run_settings::is_filtered_once;
use super::split_method::{Form, ShadeBy, Split, StorageKind};
use super::vpl_shadow::unrolled::{MapIndex, MapShape};
use crate::passes::filter::{Filter, WalkEnd};
use crate::settings::{
    BRDF, CULL, CULL_BY, Changes, DIRECT_SHADOW, EMISSIVE, GEOMETRY, GeometryChoice, Kind, NORMAL_THRESHOLD, POSITION,
    POSITION_THRESHOLD, SHADOW_BIAS_M, SHADOW_CASTERS, SHADOW_SLOPE_BIAS, Setting, TEXELS, Unread, VPL_BRDF, VPL_CLAMP,
    Values, WORKGROUP,
};

/// Its rows of the table.
pub const SETTINGS: &[Setting] = &[
    Setting {
        key: "pattern",
        symbol: "n x m",
        kind: Kind::Pair { min: 1, max: 64 },
        default: "4x4",
        unit: "px",
        paper: "Segovia 2006, 3",
        help: "Size of the interleaved pattern; each of its pixels has a light subset of its own",
        unread: |values| Unread::with(values, "split", &[Split::None], "every pixel has all lights"),
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "split",
        kind: Kind::Choice(Split::WORDS),
        default: "one-pass",
        paper: "Segovia 2006, 3.1-3.3, 4.2",
        help: "How pixels get the light subset of their place in the pattern. Without subsets: every light on every \
               pixel (none), or all lights at one pixel of each pattern (subsample). Without a copy: one draw for each \
               subset, its pixels chosen by a test (stencil, depth); each pixel looping over its own subset (branch); \
               pixels of one subset together, at the pattern's stride, in a dispatch for each (indirect) or one for \
               all (remap). With a copy into n x m sub-buffers and back: in one pass (one-pass), in two passes by \
               blocks (two-pass), through workgroup memory (tile), into the layers of an image (layered), or by \
               fragment programs and look-up textures (fragment)",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "storage",
        kind: Kind::Choice(StorageKind::WORDS),
        auto: true,
        default: "auto",
        paper: "Segovia 2006, figure 3",
        help: "Where sub-buffers lie: in storage buffers, two texels a thread, or tiled in images; auto: images where \
               --split knows nothing else, otherwise buffers on software drivers and images elsewhere",
        unread: without_copy,
        ..Setting::changing(Changes::Nothing)
    },
    Setting {
        key: "copy",
        kind: Kind::Choice(Form::WORDS),
        default: "pull",
        help: "What a thread of a copy stands for: a texel that it writes (pull) or a texel that it reads (push), or a \
               pair of such texels in buffers",
        unread: without_copy,
        ..Setting::changing(Changes::Nothing)
    },
    Setting {
        key: "shade-by",
        kind: Kind::Choice(ShadeBy::WORDS),
        default: "dispatch",
        paper: "Segovia 2006, 4.3",
        help: "What shades sub-buffers: a compute shader (dispatch), or, as in the paper, a draw each, in a viewport that is the \
               sub-buffer (viewport) or of a quad on it (quad), which need --storage image; the same bits",
        unread: without_copy,
        ..Setting::changing(Changes::Nothing)
    },
    Setting {
        key: "sub-buffer-color",
        kind: Kind::Choice(&["off", "on"]),
        auto: true,
        default: "auto",
        paper: "Segovia 2006, 4.1, 4.2",
        help: "Whether sub-buffers have the surfaces' colour, 8 bytes a pixel beside position and normal: on is what the paper moves, \
               24 bytes a pixel with --position half or unorm16; off leaves it out, which irradiance does not need; auto: on with \
               --vpl-brdf ggx alone, which reads it",
        unread: without_copy,
        ..Setting::changing(Changes::Nothing)
    },
    Setting {
        key: "block",
        symbol: "p x q",
        kind: Kind::Sides { min: 1, max: 1024 },
        default: "16",
        unit: "px",
        paper: "Segovia 2006, 3.3",
        help: "Size of a block for --split two-pass and tile, and for fragment in two passes; rounded up to whole \
               patterns",
        unread: without_blocks,
        ..Setting::changing(Changes::Nothing)
    },
    Setting {
        key: "fragment-passes",
        kind: Kind::Integer { min: 1, max: 2 },
        default: "2",
        paper: "Segovia 2006, 3.2, 4.2",
        help: "Passes of --split fragment: 1 uses one look-up texture, 2 splits into blocks and then translates the \
               blocks",
        unread: |values| Unread::unless(values, "split", &[Split::Fragment], "it has no fragment programs"),
        ..Setting::changing(Changes::Nothing)
    },
    Setting {
        key: "vpls",
        kind: Kind::Integer { min: 1, max: 65_536 },
        default: "256",
        paper: "Segovia 2006, 6",
        help: "Number of virtual point lights, made by Instant Radiosity",
        ..Setting::changing(Changes::Samples)
    },
    Setting {
        key: "vpl-bounces",
        kind: Kind::Integer { min: 1, max: 16 },
        default: "1",
        paper: "Segovia 2006, 6.2",
        help: "Most surfaces that one light walk lands on",
        ..Setting::changing(Changes::Picture)
    },
    VPL_CLAMP,
    VPL_BRDF,
    Setting {
        key: "vpl-shadow",
        kind: Kind::Choice(VplShadow::WORDS),
        default: "none",
        paper: "Segovia 2006, 4.3",
        help: "What stops virtual point lights: nothing, as in the paper's shading without shadow maps (SNSM), or solid surfaces, by a \
               shadow ray from each surface to each light of its subset (ray) or by a shadow map of each light (map, the paper's SSM)",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "vpl-shadow-size",
        kind: Kind::Integer { min: 16, max: 4096 },
        default: "128",
        unit: "px",
        paper: "Segovia 2006, 4.3",
        help: "Texels across a face of a virtual light's shadow map, made even; a hemicube has three times its square",
        unread: without_vpl_maps,
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "vpl-shadow-shape",
        kind: Kind::Choice(MapShape::WORDS),
        default: "hemicube",
        paper: "Segovia 2006, 4.3",
        help: "A virtual light's shadow map: the face before it and the near halves of four more, unrolled in one image, which is all \
               that it lights (hemicube), six faces unrolled (cube), or six layers of an array, each drawn by itself (layers); a \
               texel of one is a texel of the others, up to how a device rounds corners",
        unread: without_vpl_maps,
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "vpl-shadow-index",
        kind: Kind::Choice(MapIndex::WORDS),
        default: "arithmetic",
        paper: "Segovia 2006, 4.3",
        help: "How a direction from a virtual light comes to its texel of an unrolled shadow map: by arithmetic, or, as in the paper, by a \
               look-up in a small cube of texels' places (cube-map); the same texels, up to how a device rounds the look-up",
        unread: |values| {
            let is_unrolled = [MapShape::Hemicube, MapShape::Cube];
            without_vpl_maps(values)
                .or_else(|| Unread::unless(values, "vpl-shadow-shape", &is_unrolled, "a layer is found by its number"))
        },
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "vpl-shadow-maps",
        kind: Kind::Integer { min: 1, max: 65_536 },
        auto: true,
        default: "auto",
        help: "Shadow maps of virtual lights that are held at once, in one image; the lights take turns; auto: as many as 64 MiB or \
               what is left of --memory-budget hold",
        unread: without_vpl_maps,
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "vpl-shadow-detail",
        kind: Kind::Number { min: 0.0, max: 16.0 },
        default: "0",
        unit: "px",
        help: "Texels of a virtual light's shadow map that a surface in it may be off by: solid surfaces are drawn by the coarsest \
               triangles whose finer ones are as near; 0: by all of theirs",
        unread: |values| {
            without_vpl_maps(values)
                .or_else(|| Unread::with(values, "shadow-casters", &[GeometryChoice::All], "all triangles are drawn"))
        },
        ..Setting::changing(Changes::Picture)
    },
    // FLIP of cornell, hall and a map against shadow rays, maps of 128, is 0.0037, 0.0194 and 0.0005 with these two; 0.0036, 0.0207
    // and 0.0009 with 2 texels and 0.03 %, 0.1, 0.1 and 0.011 without a slope's part. A map is asked once, so that a texel is enough.
    Setting { default: "0.1%", unread: without_vpl_maps, ..SHADOW_BIAS_M },
    Setting {
        default: "1",
        help: "Slope bias: surfaces in a shadow map are moved away from the light by the change of their depth over \
               this many texels; 1 is the reach of one comparison",
        unread: without_vpl_maps,
        ..SHADOW_SLOPE_BIAS
    },
    Setting { unread: without_vpl_maps, ..SHADOW_CASTERS },
    EMISSIVE,
    Setting {
        key: "direct",
        kind: Kind::Choice(Direct::WORDS),
        default: "full",
        paper: "Segovia 2006, 4.6",
        help: "How the scene's own lights are shaded: on every pixel by --brdf (full), in the subsets by --vpl-brdf \
               (interleaved), or not at all (none)",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "blend-lights",
        kind: Kind::Choice(BlendLights::WORDS),
        default: "subset",
        help: "Virtual point lights that shade BLEND surfaces, which no filter smooths: those of the pixel's subset, \
               or all",
        unread: is_even,
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "direct-pattern",
        symbol: "i x j",
        kind: Kind::Pair { min: 1, max: 64 },
        auto: true,
        default: "auto",
        unit: "px",
        paper: "Segovia 2006, 4.6",
        help: "Pattern of the scene's own lights with --direct interleaved; it divides --pattern and is made of \
               clusters of its sub-buffers; with fewer pixels to share the lights, each has more of them; auto: \
               --pattern",
        unread: |values| {
            Unread::unless(values, "direct", &[Direct::Interleaved], "no punctual light is in a subset")
                .or_else(|| sums_all(values))
        },
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "filter",
        kind: Kind::Choice(Filter::WORDS),
        default: "gauss",
        paper: "Segovia 2006, 4.5",
        help: "Filter of the interleaved irradiance; a picture that is not interleaved (--split none, or pattern 1x1) \
               is not filtered",
        unread: is_even,
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "kernel",
        kind: Kind::Integer { min: 5, max: 17 },
        default: "5",
        unit: "px",
        paper: "Segovia 2006, tables 2 and 3",
        help: "Taps of the filter in one direction, an odd number",
        unread: is_unfiltered,
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "fuse",
        kind: Kind::Choice(&["off", "on"]),
        default: "off",
        help: "Merge passes of --filter gauss: the composite runs over the filter's columns, and a one-pass gather \
               that pulls over its rows; the same pixels with fewer passes, and fewer stages to time and to look at",
        unread: |values| {
            let is_gauss =
                || Unread::unless(values, "filter", &[Filter::Gauss], "no pass walks rows and columns of buffers");
            is_even(values).or_else(is_gauss).or_else(|| is_filtered_once(values))
        },
        ..Setting::changing(Changes::Nothing)
    },
    Setting {
        key: "sigma",
        kind: Kind::Number { min: 0.0, max: 64.0 },
        default: "0",
        unit: "px",
        help: "Standard deviation of the filter; 0: a third of the kernel, which weighs the pixels of a 4x4 pattern \
               most evenly",
        unread: is_unfiltered,
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "discontinuity",
        kind: Kind::Choice(StopAt::WORDS),
        default: "directional",
        paper: "Segovia 2006, 4.5",
        help: "Discontinuity at which the filter stops: one in the direction of the filter (directional), or one in \
               any of the three directions (any, the paper's single flag, which leaves pixels along an edge \
               unfiltered)",
        unread: is_unfiltered,
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "walk-end",
        kind: Kind::Choice(WalkEnd::WORDS),
        default: "flag",
        paper: "Segovia 2006, 5.4",
        help: "How a walk of --filter gauss ends at a discontinuity: the texels beyond weigh nothing (flag), or dynamic branching \
               leaves the loop (branch), which the paper found no faster",
        unread: |values| {
            is_even(values).or_else(|| Unread::unless(values, "filter", &[Filter::Gauss], "it walks in another way"))
        },
        ..Setting::changing(Changes::Nothing)
    },
    Setting { unread: is_unfiltered, ..NORMAL_THRESHOLD },
    Setting { unread: is_unfiltered, ..POSITION_THRESHOLD },
];

/// `settings::SHADING`, of which direct light alone reads `--brdf` and `--cull`.
pub const SHADING: &[Setting] = &[
    Setting { unread: without_direct, ..BRDF },
    POSITION,
    GEOMETRY,
    Setting { unread: without_direct, ..CULL },
    CULL_BY,
    DIRECT_SHADOW,
    TEXELS,
    WORKGROUP,
];

/// Every pixel that is shaded has all lights.
fn sums_all(values: &Values) -> Option<Unread> {
    Unread::with(values, "split", &[Split::None, Split::Subsample], "every light is summed")
}

fn without_vpl_maps(values: &Values) -> Option<Unread> {
    Unread::unless(values, "vpl-shadow", &[VplShadow::Map], "virtual lights have no shadow maps")
}

/// Nothing is interleaved that a filter would smooth.
fn is_even(values: &Values) -> Option<Unread> {
    sums_all(values).or_else(|| Unread::with(values, "pattern", &["1x1"], "nothing is interleaved"))
}

fn is_unfiltered(values: &Values) -> Option<Unread> {
    is_even(values)
        .or_else(|| Unread::unless(values, "filter", &[Filter::Gauss, Filter::GaussFast], "nothing is filtered"))
}

fn without_direct(values: &Values) -> Option<Unread> {
    Unread::with(values, "direct", &[Direct::None], "there is no direct light")
}

fn without_copy(values: &Values) -> Option<Unread> {
    Unread::unless(values, "split", Split::COPYING, "it copies nothing")
}

fn without_blocks(values: &Values) -> Option<Unread> {
    let splits = [Split::TwoPass, Split::Tile, Split::Fragment];
    Unread::unless(values, "split", &splits, "it has no blocks").or_else(|| {
        let draws = values.is("split", Split::Fragment);
        let passes = || Unread::unless(values, "fragment-passes", &["2"], "one pass has no blocks");
        if draws { passes() } else { None }
    })
}
