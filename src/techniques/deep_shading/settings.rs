//! The settings that only this technique reads.

use crate::sampling::sampler::Sampler;
use crate::settings::{
    APERTURE, BRDF, Changes, FOCUS, GEOMETRY, INSTRUMENT, Kind, MAPPED_DIRECT_SHADOW, SHUTTER, STEREO, STEREO_EYES,
    Setting, TEXELS, Unread, Values,
};
use crate::techniques::deep_shading::modes::barycentrics::Barycentrics;
use crate::techniques::deep_shading::modes::conservative::Conservative;
use crate::techniques::deep_shading::modes::coverage_test::CoverageTest;
use crate::techniques::deep_shading::modes::layer_from::LayerFrom;
use crate::techniques::deep_shading::modes::lists::{Duplicates, ListAccess, Lists, ShadedTriangles};
use crate::techniques::deep_shading::modes::pixel_samples::PixelSamples;
use crate::techniques::deep_shading::modes::polygon_from::PolygonFrom;
use crate::techniques::deep_shading::modes::sample_tests::SampleTests;
use crate::techniques::deep_shading::modes::shade_by::ShadeBy;
use crate::techniques::deep_shading::modes::shading_kind::ShadingKind;
use crate::techniques::deep_shading::modes::shading_rate::ShadingRate;
use crate::techniques::deep_shading::modes::vertices::Vertices;
use crate::techniques::deep_shading::modes::visibility::Visibility;
use crate::techniques::deep_shading::modes::warp::Warp;

/// Greatest side of the guard band: shading pixels have 16 bits a side.
const MOST_GUARD_PX: u64 = 4096;

/// The least `--shading-scale`.
pub const LEAST_SCALE: f64 = 0.05;

pub const SETTINGS: &[Setting] = &[
    Setting {
        key: "shading",
        kind: Kind::Choice(ShadingKind::WORDS),
        default: "deep",
        paper: "Clarberg 2014, 6",
        help: "What is shaded: the triangles in the lists (deep); or, as a baseline, every sample that is drawn \
               (ssaa); each triangle once for the samples of a pixel that see it, by stochastic rasterisation (msaa); by a \
               compute shader, the entries of a compact geometry buffer that samples point to (indirect-gbuffer; Liktor \
               and Dachsbacher 2012); or the texels of a texture of each draw, which is then drawn with that texture \
               (texture-space; Andersson et al. 2014; meshes need atlases)",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "shading-textures",
        kind: Kind::Integer { min: 1, max: 16 },
        default: "8",
        paper: "Clarberg 2014, 6",
        help: "Number of textures of --shading texture-space, which is how many draws are shaded and drawn at a time; \
               the same picture",
        unread: without_textures,
        ..Setting::changing(Changes::Nothing)
    },
    Setting {
        key: "shading-texture-size",
        kind: Kind::Choice(&["256", "512", "1024", "2048", "4096", "8192"]),
        default: "2048",
        unit: "px",
        paper: "Clarberg 2014, 6",
        help: "Texels along a side of the finest level of each texture of --shading texture-space: the most with which \
               a mesh's atlas is shaded",
        unread: without_textures,
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "shading-cache",
        kind: Kind::Integer { min: 1, max: 1 << 26 },
        auto: true,
        default: "auto",
        paper: "Clarberg 2014, 2",
        help: "Entries of the cache in which --shading indirect-gbuffer finds what has been seen before; what a full \
               cache forgets is shaded again, to the same picture; auto: as many as samples",
        unread: |values| Unread::unless(values, "shading", &[ShadingKind::IndirectGbuffer], "it has no cache"),
        ..Setting::changing(Changes::Nothing)
    },
    Setting {
        key: "pass-samples",
        kind: Kind::Choice(&["1", "4", "8"]),
        auto: true,
        default: "auto",
        paper: "Clarberg 2014, 6",
        help: "Samples a pixel that --shading msaa draws at once; --spp takes as many passes as it needs; auto: the \
               most of these that the device has and that divide --spp",
        unread: |values| Unread::unless(values, "shading", &[ShadingKind::Msaa], "samples are drawn one at a time"),
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "visibility",
        kind: Kind::Choice(Visibility::WORDS),
        auto: true,
        default: "auto",
        paper: "Clarberg 2014, 4.2",
        help: "How samples find the triangle that they see: the frame is drawn once for each tuple (repeat-frame); \
               each draw is (repeat-draw); each draw has an instance for each tuple (instancing); a geometry shader \
               makes a triangle for each tuple (replicate); a polygon around each triangle's blur is drawn, and a \
               shader tests the samples of its pixels (stochastic); or the host casts rays (ray); the same samples but for \
               --pixel-samples; auto: instancing on software drivers that write layers, with --shading deep and \
               indirect-gbuffer, stochastic with msaa, else repeat-frame",
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "layer-from",
        kind: Kind::Choice(LayerFrom::WORDS),
        auto: true,
        default: "auto",
        paper: "Clarberg 2014, 4.2",
        help: "Stage that writes the tuple's layer with --visibility repeat-draw and instancing: vertex shaders, or a \
               geometry shader that passes triangles through; the same samples; auto: vertex where the device can",
        unread: |values| Unread::unless(values, "shading", ShadingKind::OF_SPACE, "samples are drawn layer by layer"),
        ..Setting::changing(Changes::Nothing)
    },
    Setting {
        key: "vertices",
        kind: Kind::Choice(Vertices::WORDS),
        auto: true,
        default: "auto",
        paper: "Clarberg 2014, 4.2",
        help: "How --visibility repeat-frame, repeat-draw and instancing draw triangles: by the scene's indices, so that a \
               vertex is placed once for the triangles around it (indexed); or corner by corner, each of which looks its \
               index up (fetched, the plain way); the same samples; auto: indexed where fragments can ask for a triangle's \
               number",
        unread: |values| Unread::unless(values, "shading", ShadingKind::OF_SPACE, "each corner has its weights"),
        ..Setting::changing(Changes::Nothing)
    },
    Setting {
        key: "polygon-from",
        kind: Kind::Choice(PolygonFrom::WORDS),
        auto: true,
        default: "auto",
        paper: "Clarberg 2014, 4.2",
        help: "Stage that makes the polygon around a triangle's blur with --visibility stochastic: a geometry shader, once \
               for the polygon, or vertex shaders, each corner for itself; the same samples; auto: geometry where the \
               device can",
        unread: |values| {
            Unread::unless(
                values,
                "shading",
                &[ShadingKind::Deep, ShadingKind::IndirectGbuffer, ShadingKind::Ssaa, ShadingKind::TextureSpace],
                "its triangles come from vertex shaders",
            )
        },
        ..Setting::changing(Changes::Nothing)
    },
    Setting {
        key: "sample-tests",
        kind: Kind::Choice(SampleTests::WORDS),
        auto: true,
        default: "auto",
        paper: "Clarberg 2014, 4.2",
        help: "How --visibility stochastic tests samples: the polygon around a triangle's blur is drawn once, and each \
               fragment tests all samples of its pixel, of which 64-bit atomics keep the nearest (loop); or it is \
               drawn into a layer for each tuple, where a pixel is a sample (layers); the same picture; auto: loop \
               where the device can",
        unread: |values| {
            Unread::unless(
                values,
                "shading",
                ShadingKind::OF_SPACE,
                "samples are drawn and coloured layer by layer, or as many at a time as an image has",
            )
        },
        ..Setting::changing(Changes::Nothing)
    },
    Setting {
        key: "coverage-test",
        kind: Kind::Choice(CoverageTest::WORDS),
        default: "reduced",
        paper: "Clarberg 2014, 4.2",
        help: "How --visibility stochastic tests a sample against a triangle: by corners that are placed as for all else (full); \
               or by corners of which the transform is done once for all samples of a pixel (reduced, after Laine and Karras \
               2011); the same picture, but for samples on edges themselves",
        unread: |values| {
            let is_tested = values.is("shading", ShadingKind::Msaa);
            let why = "what is drawn is not tested";
            if is_tested { None } else { Unread::unless(values, "visibility", &[Visibility::Stochastic], why) }
        },
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "pixel-samples",
        kind: Kind::Choice(PixelSamples::WORDS),
        auto: true,
        default: "auto",
        paper: "Clarberg 2014, 4.2",
        help: "Whether pixels that have the same tuples have the same samples (shared), or each has samples of its own, tuples \
               whose digits a hash of the pixel turns (own): noise in place of a pattern, with --visibility stochastic and ray; \
               auto: own with these",
        ..Setting::changing(Changes::Samples)
    },
    Setting {
        key: "spp",
        symbol: "n",
        kind: Kind::Integer { min: 1, max: 64 },
        auto: true,
        default: "auto",
        paper: "8: Clarberg 2014, 6",
        help: "Samples a pixel in one set of buffers, for each eye with --stereo; auto: 32 where something is blurred, 8 \
               where nothing is, or the largest power of two that --sample-memory holds; of --tuples, if that is given, a divisor",
        ..Setting::changing(Changes::Samples)
    },
    Setting {
        key: "sample-memory",
        kind: Kind::Bytes,
        default: "2GiB",
        help: "Most bytes that --spp auto takes samples for, reckoned at 64 for each, which is the most that lists and the \
               filter hold of one; none: no bound",
        unread: |values| Unread::unless(values, "spp", &["auto"], "it says how many samples there are"),
        ..Setting::changing(Changes::Samples)
    },
    Setting {
        key: "tuples",
        symbol: "N",
        kind: Kind::Integer { min: 1, max: 2048 },
        auto: true,
        default: "auto",
        paper: "Clarberg 2014, 4.2",
        help: "Number of tuples, places in a pixel, on the lens and in time, that all samples share, spread over a \
               table of N/n pixels; a multiple of --spp; for each eye with --stereo; auto: --spp, all in every pixel, \
               doubled where something is blurred, to at most 32 and four times --spp",
        ..Setting::changing(Changes::Samples)
    },
    Setting {
        key: "sampler",
        kind: Kind::Choice(Sampler::WORDS),
        default: "sobol",
        paper: "Keller 2001, 2.2",
        help: "How tuples are spread over the pixels of their table, the lens and time: sobol, one scrambled sequence; \
               relaxed, blue noise; r2, the generalised golden ratio's; jittered, one in each of equal cells; random; ign, \
               turned by interleaved gradient noise; void-and-cluster, by blue noise masks; blue-errors, Sobol's with \
               errors that differ between neighbours",
        ..Setting::changing(Changes::Samples)
    },
    Setting {
        key: "accumulate",
        kind: Kind::Integer { min: 1, max: 4096 },
        default: "1",
        help: "Number of sets of --spp samples a pixel that are averaged to the picture, each with tuples of its own",
        ..Setting::changing(Changes::Samples)
    },
    Setting {
        key: "guard-band",
        kind: Kind::Integer { min: 0, max: MOST_GUARD_PX },
        auto: true,
        default: "64",
        unit: "px",
        paper: "Clarberg 2014, 6",
        help: "Width of the border of shading space around the frame, for what blur brings in; samples that are \
               farther out are shaded one by one; auto: as wide as blur brings things in, up to a twentieth of the \
               frame's longer side",
        unread: without_space,
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "shading-scale",
        kind: Kind::Number { min: LEAST_SCALE, max: 4.0 },
        default: "1",
        paper: "Clarberg 2014, 6",
        help: "Pixels of shading space along one pixel of the frame; below 1, shading is coarser than the frame",
        unread: |values| {
            Unread::unless(
                values,
                "shading",
                &[ShadingKind::Deep, ShadingKind::IndirectGbuffer, ShadingKind::TextureSpace],
                "it shades no pixels of shading space",
            )
        },
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "shading-rate",
        kind: Kind::Choice(ShadingRate::WORDS),
        default: "full",
        paper: "Clarberg 2014, 6",
        help: "How finely triangles are shaded: at each pixel of shading space (full); or coarser along an axis on which all \
               of a triangle is blurred, by lens or motion, up to 16 times, so that --blur-pixels lie across the blur (blur)",
        unread: without_space,
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "blur-pixels",
        kind: Kind::Number { min: 1.0, max: 64.0 },
        default: "8",
        unit: "px",
        help: "Pixels of shading space across the blur of a triangle with --shading-rate blur, at least",
        unread: |values| {
            without_space(values).or_else(|| {
                Unread::unless(values, "shading-rate", &[ShadingRate::Blur], "blur does not matter to shading")
            })
        },
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "shading-warp",
        kind: Kind::Choice(Warp::WORDS),
        default: "even",
        paper: "Clarberg 2014, 7",
        help: "Where shading space is finer: nowhere (even), or in its middle, which is as fine as an even one \
               (foveated); visibility stays as fine",
        unread: without_space,
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "warp-falloff",
        kind: Kind::Number { min: 0.01, max: 16.0 },
        default: "1",
        help: "Falloff c of --shading-warp foveated: at r, from 0 in the middle to 1 at the rim, a pixel of shading \
               space is 1 + c r times as wide across and (1 + c r)^2 times as long towards the rim; shading space then \
               has 1/(1 + c)^2 of the pixels",
        unread: without_space,
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "lists",
        kind: Kind::Choice(Lists::WORDS),
        default: "linked",
        paper: "Clarberg 2014, 4.3",
        help: "How the triangles to shade at each pixel of shading space are listed: in linked lists (linked); in \
               lists that rays fill at once, without a SPID a sample, with --visibility ray (direct); or not, each \
               sample being shaded where it is seen, at its shading point (none, the plain way to the same picture)",
        unread: without_lists,
        ..Setting::changing(Changes::Nothing)
    },
    Setting {
        key: "shade-by",
        kind: Kind::Choice(ShadeBy::WORDS),
        default: "compute",
        paper: "fragment: Clarberg 2014, 4.4",
        help: "What shades the triangles of lists: a compute shader, which goes through them material by material \
               (compute); or the fragments of a conservative pass over shading space, which find themselves in a list, as in \
               the paper (fragment); the same picture",
        unread: without_lists,
        ..Setting::changing(Changes::Nothing)
    },
    Setting { unread: without_lists, ..TEXELS },
    Setting {
        key: "cull-lights",
        kind: Kind::Choice(&["on", "off"]),
        default: "on",
        help: "Leave out lights whose range ends before all that a compute thread shades (--texels); the same picture",
        unread: without_lists,
        ..Setting::changing(Changes::Nothing)
    },
    Setting {
        key: "list-access",
        kind: Kind::Choice(ListAccess::WORDS),
        auto: true,
        default: "auto",
        help: "How shaders reach what is kept of each sample and shading pixel (lists and colours, what --reconstruct \
               filters, the buffers of --shading indirect-gbuffer): through descriptors, within the longest range that \
               the device binds, or by the buffers' addresses, at any length; the same picture; auto: addresses where \
               a buffer is longer than that range",
        unread: |values| Unread::unless(values, "shading", ShadingKind::OF_SPACE, "samples' colours are in images"),
        ..Setting::changing(Changes::Nothing)
    },
    Setting {
        key: "duplicates",
        kind: Kind::Choice(Duplicates::WORDS),
        default: "avoided",
        paper: "Clarberg 2014, 4.3",
        help: "What an insertion does when another one has changed the list first: it looks through the nodes added \
               since, so that no triangle is listed twice (avoided), or it does not (tolerated, the paper's way); the \
               same picture",
        unread: without_lists,
        ..Setting::changing(Changes::Nothing)
    },
    Setting {
        key: "compaction",
        kind: Kind::Choice(&["on", "off"]),
        default: "on",
        paper: "Clarberg 2014, 4.3",
        help: "Sort the lists and store their first M = 16 triangles in a row; the same picture",
        unread: without_lists,
        ..Setting::changing(Changes::Nothing)
    },
    Setting {
        key: "zmax",
        kind: Kind::Choice(&["on", "off"]),
        default: "off",
        paper: "on: Clarberg 2014, 3.1",
        help: "Leave out, by a depth test before a list is read, triangles that lie behind all that samples saw at that pixel \
               of shading space, with a depth more for each sample; the same picture, and sooner where all triangles are drawn \
               (--shaded-triangles all)",
        unread: without_fragments,
        ..Setting::changing(Changes::Nothing)
    },
    Setting {
        key: "address-buffer",
        kind: Kind::Choice(&["on", "off"]),
        default: "on",
        paper: "Clarberg 2014, 4.3",
        help: "Keep the address of each sample's colour; off: find it again by following links; the same picture",
        unread: without_lists,
        ..Setting::changing(Changes::Nothing)
    },
    Setting {
        key: "conservative",
        kind: Kind::Choice(Conservative::WORDS),
        auto: true,
        default: "auto",
        paper: "Clarberg 2014, 4.4",
        help: "How every pixel that a triangle touches gets drawn: its hull is drawn, from a geometry shader \
               (geometry) or from vertex shaders (vertex), or the device rasterises conservatively (hardware); the same \
               picture, or an error that says how many samples have no colour; \
               auto: geometry where there are such shaders, vertex elsewhere; none: only pixels whose middle the \
               triangle covers, to measure what the others cost and how much has no colour then",
        unread: without_fragments,
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "barycentrics",
        kind: Kind::Choice(Barycentrics::WORDS),
        default: "computed",
        paper: "Clarberg 2014, 5",
        help: "Where fragments that shade take their place on a triangle from: its corners, in one order of operations, to the \
               same bits however it was drawn (computed); the rasteriser, which interpolates the corners' weights \
               (interpolated); or the device, which has them for every fragment (device, \
               VK_KHR_fragment_shader_barycentric). The last two need triangles to be drawn as they are: --conservative \
               hardware or none. A pixel whose middle lies beside its triangle is computed",
        unread: without_fragments,
        ..Setting::changing(Changes::Picture)
    },
    Setting {
        key: "shaded-triangles",
        kind: Kind::Choice(ShadedTriangles::WORDS),
        default: "listed",
        paper: "all: Clarberg 2014, 4.4",
        help: "Triangles that are drawn into shading space: those that are in a list, for which insertion marks one \
               bit each (listed), or all of the scene, as in the paper (all); the same picture",
        unread: without_fragments,
        ..Setting::changing(Changes::Nothing)
    },
    Setting {
        key: "reconstruct",
        kind: Kind::Choice(&["on", "off"]),
        auto: true,
        default: "auto",
        paper: "on: Clarberg 2014, 4.5",
        help: "Filter what is blurred, in layers of depth, as far as its blur allows (not the paper's filter); off: \
               take the mean of each pixel's own samples; auto: on with --spp auto and \
               --shading deep, without --lists direct, --accumulate and the picture of both eyes",
        ..Setting::changing(Changes::Picture)
    },
];

/// Rows that other techniques have too.
pub const SHARED: &[Setting] =
    &[INSTRUMENT, APERTURE, FOCUS, STEREO, STEREO_EYES, SHUTTER, BRDF, GEOMETRY, MAPPED_DIRECT_SHADOW];

fn without_space(values: &Values) -> Option<Unread> {
    Unread::unless(values, "shading", ShadingKind::OF_SPACE, "it has no shading space")
}

fn without_lists(values: &Values) -> Option<Unread> {
    Unread::unless(values, "shading", &[ShadingKind::Deep], "it has no lists")
}

fn without_fragments(values: &Values) -> Option<Unread> {
    without_lists(values)
        .or_else(|| Unread::unless(values, "shade-by", &[ShadeBy::Fragment], "it draws nothing into shading space"))
}

fn without_textures(values: &Values) -> Option<Unread> {
    Unread::unless(values, "shading", &[ShadingKind::TextureSpace], "it has no textures of its own")
}
