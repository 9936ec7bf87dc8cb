//! The settings that only this technique reads.

use crate::settings::{
    APERTURE, BRDF, FOCUS, GEOMETRY, INSTRUMENT, Kind, MAPPED_DIRECT_SHADOW, SHUTTER, STEREO, STEREO_EYES, Setting,
};

/// Greatest side of the guard band: shading pixels have 16 bits a side.
const MOST_GUARD_PX: u64 = 4096;

/// The least `--shading-scale`.
pub const LEAST_SCALE: f64 = 0.05;

pub const SETTINGS: &[Setting] = &[
    Setting {
        key: "shading",
        symbol: "",
        kind: Kind::Choice(&["deep", "ssaa", "msaa", "indirect-gbuffer", "texture-space"]),
        default: "deep",
        unit: "",
        paper: "Clarberg 2014, 6",
        help: "what is shaded: what the lists have, or, as baselines, every sample that is drawn (ssaa), or what a pixel's samples see of a \
               triangle once, by stochastic rasterisation, which --visibility repeat-frame stands for too (msaa), or, by a compute shader, what samples point to \
               in a compact geometry buffer (indirect-gbuffer; Liktor and Dachsbacher 2012), or texels of a texture of each draw, which \
               is then drawn with it (texture-space; Andersson et al. 2014; meshes need atlases)",
    },
    Setting {
        key: "shading-textures",
        symbol: "",
        kind: Kind::Integer { min: 1, max: 16 },
        default: "8",
        unit: "",
        paper: "Clarberg 2014, 6",
        help: "textures of --shading texture-space: so many draws are shaded and drawn at a time; the same picture",
    },
    Setting {
        key: "shading-texture-size",
        symbol: "",
        kind: Kind::Choice(&["256", "512", "1024", "2048", "4096", "8192"]),
        default: "2048",
        unit: "px",
        paper: "Clarberg 2014, 6",
        help: "texels along a side of the finest level of each: the most that a mesh's atlas is shaded with",
    },
    Setting {
        key: "shading-cache",
        symbol: "",
        kind: Kind::IntegerOrAuto { min: 1, max: 1 << 26 },
        default: "auto",
        unit: "",
        paper: "Clarberg 2014, 2",
        help: "entries of the cache in which --shading indirect-gbuffer finds what has been seen before; what a full one forgets is \
               shaded again, to the same picture; auto: as many as samples",
    },
    Setting {
        key: "pass-samples",
        symbol: "",
        kind: Kind::Choice(&["auto", "1", "4", "8"]),
        default: "auto",
        unit: "",
        paper: "Clarberg 2014, 6",
        help: "samples a pixel that --shading msaa draws at once: --spp takes as many passes; auto: the most of these that the device \
               has and --spp is a multiple of",
    },
    Setting {
        key: "visibility",
        symbol: "",
        kind: Kind::Choice(&["repeat-frame", "repeat-draw", "instancing", "replicate", "stochastic", "ray"]),
        default: "repeat-frame",
        unit: "",
        paper: "Clarberg 2014, 4.2",
        help: "how samples find what they see: the frame is drawn once for each tuple, or each draw is, or each draw has an instance a \
               tuple, or a geometry shader makes a triangle for each tuple; or a polygon around each triangle's blur is drawn and its \
               pixels' samples are tested by a shader; or the host casts rays; the same samples",
    },
    Setting {
        key: "layer-from",
        symbol: "",
        kind: Kind::Choice(&["auto", "vertex", "geometry"]),
        default: "auto",
        unit: "",
        paper: "Clarberg 2014, 4.2",
        help: "which stage says the tuple's layer with --visibility repeat-draw and instancing: vertex shaders, or a geometry \
               shader that passes triangles through; the same samples; auto: vertex where the device can",
    },
    Setting {
        key: "polygon-from",
        symbol: "",
        kind: Kind::Choice(&["auto", "geometry", "vertex"]),
        default: "auto",
        unit: "",
        paper: "Clarberg 2014, 4.2",
        help: "which stage makes the polygon around a triangle's blur with --visibility stochastic (and around strays with ray): a \
               geometry shader, once, or vertex shaders, each corner for itself; the same samples; auto: geometry where the device can",
    },
    Setting {
        key: "sample-tests",
        symbol: "",
        kind: Kind::Choice(&["auto", "loop", "layers"]),
        default: "auto",
        unit: "",
        paper: "Clarberg 2014, 4.2",
        help: "how --visibility stochastic tests samples: the polygon around a triangle's blur is drawn once over the frame and its \
               fragments test all samples of their pixel, of which 64-bit atomics keep the nearest; or it is drawn into a layer of each \
               tuple, where a pixel is a sample; the same picture; auto: a loop where the device can",
    },
    Setting {
        key: "spp",
        symbol: "n",
        kind: Kind::Integer { min: 1, max: 64 },
        default: "8",
        unit: "",
        paper: "Clarberg 2014, 6",
        help: "samples a pixel in one set of buffers, of each eye with --stereo",
    },
    Setting {
        key: "tuples",
        symbol: "N",
        kind: Kind::IntegerOrAuto { min: 1, max: 2048 },
        default: "auto",
        unit: "",
        paper: "Clarberg 2014, 4.2",
        help: "places in a pixel, on the lens and in time that all samples share, spread over a table of N/n pixels; a multiple of \
               --spp; of each eye with --stereo; auto: four times --spp",
    },
    Setting {
        key: "accumulate",
        symbol: "",
        kind: Kind::Integer { min: 1, max: 4096 },
        default: "1",
        unit: "",
        paper: "",
        help: "sets of --spp samples a pixel, each with tuples of its own, that the picture is the mean of",
    },
    Setting {
        key: "guard-band",
        symbol: "",
        kind: Kind::Integer { min: 0, max: MOST_GUARD_PX },
        default: "64",
        unit: "px",
        paper: "Clarberg 2014, 6",
        help: "pixels of shading space around the frame's, for what blur brings in; samples that are farther out are shaded by \
               themselves",
    },
    Setting {
        key: "shading-scale",
        symbol: "",
        kind: Kind::Number { min: LEAST_SCALE, max: 4.0 },
        default: "1",
        unit: "",
        paper: "Clarberg 2014, 6",
        help: "pixels of shading space along a pixel of the frame: below 1 is shaded more coarsely",
    },
    Setting {
        key: "shading-warp",
        symbol: "",
        kind: Kind::Choice(&["even", "foveated"]),
        default: "even",
        unit: "",
        paper: "Clarberg 2014, 7",
        help: "where shading space is finer: nowhere, or in its middle (foveated), as fine there as an even one; what is seen stays as fine",
    },
    Setting {
        key: "warp-falloff",
        symbol: "",
        kind: Kind::Number { min: 0.01, max: 16.0 },
        default: "1",
        unit: "",
        paper: "",
        help: "c of --shading-warp foveated: a pixel of shading space is 1 + c r as wide as in the middle and the square of that along the \
               way to the rim, r of which is 1; shading space has 1/(1 + c)^2 of the pixels",
    },
    Setting {
        key: "lists",
        symbol: "",
        kind: Kind::Choice(&["linked", "direct", "none"]),
        default: "linked",
        unit: "",
        paper: "Clarberg 2014, 4.3",
        help: "linked lists of what is shaded at each pixel of shading space; direct: rays put triangles into them at once, without a \
               SPID a sample (--visibility ray); or none: every sample is shaded where it is seen, at its shading point (the plain \
               way to the same picture)",
    },
    Setting {
        key: "list-access",
        symbol: "",
        kind: Kind::Choice(&["auto", "descriptors", "addresses"]),
        default: "auto",
        unit: "",
        paper: "",
        help: "how shaders come to what is kept of each sample and shading pixel (lists and colours, what --reconstruct filters, the \
               buffers of --shading indirect-gbuffer): through descriptors, which reach as far as the device binds, or by the \
               buffers' addresses, however long they are; the same picture; auto: addresses where a buffer is longer than that",
    },
    Setting {
        key: "duplicates",
        symbol: "",
        kind: Kind::Choice(&["avoided", "tolerated"]),
        default: "avoided",
        unit: "",
        paper: "Clarberg 2014, 4.3",
        help: "whether an insertion that another one was quicker than looks at what is new in its list; the same picture",
    },
    Setting {
        key: "compaction",
        symbol: "M",
        kind: Kind::Choice(&["on", "off"]),
        default: "on",
        unit: "",
        paper: "Clarberg 2014, 4.3",
        help: "lists are sorted, and their first 16 triangles lie in a row; the same picture",
    },
    Setting {
        key: "zmax",
        symbol: "",
        kind: Kind::Choice(&["on", "off"]),
        default: "on",
        unit: "",
        paper: "Clarberg 2014, 3.1",
        help: "what lies behind all that samples saw at a pixel of shading space is left out before its list is read; the same picture",
    },
    Setting {
        key: "address-buffer",
        symbol: "",
        kind: Kind::Choice(&["on", "off"]),
        default: "on",
        unit: "",
        paper: "Clarberg 2014, 4.3",
        help: "where each sample's colour lies is kept, or found again by following links; the same picture",
    },
    Setting {
        key: "conservative",
        symbol: "",
        kind: Kind::Choice(&["auto", "geometry", "vertex", "hardware", "none"]),
        default: "auto",
        unit: "",
        paper: "Clarberg 2014, 4.4",
        help: "how every pixel that a triangle touches is drawn: its hull from a geometry shader or from vertex shaders, or the \
               device's own conservative rasterisation, which nobody has seen run yet; the same picture, or an error that says how many \
               samples have no colour; auto: geometry where there are such shaders, else vertex; none: only pixels whose middle it covers, to measure what the others cost and what is without colour then",
    },
    Setting {
        key: "shaded-triangles",
        symbol: "",
        kind: Kind::Choice(&["listed", "all"]),
        default: "listed",
        unit: "",
        paper: "Clarberg 2014, 4.4 (all)",
        help: "what shading space is drawn with: triangles that a list has, which insertion marks with a bit each, or all of the scene, as in \
               the paper (and with --lists direct); the same picture",
    },
    Setting {
        key: "reconstruct",
        symbol: "",
        kind: Kind::Choice(&["on", "off"]),
        default: "off",
        unit: "",
        paper: "Clarberg 2014, 4.5",
        help: "what is blurred is filtered in layers of depth, as far as its blur allows, in place of the mean of each pixel's own \
               samples; not the paper's filter",
    },
    INSTRUMENT,
    APERTURE,
    FOCUS,
    STEREO,
    STEREO_EYES,
    SHUTTER,
    BRDF,
    GEOMETRY,
    MAPPED_DIRECT_SHADOW,
];
