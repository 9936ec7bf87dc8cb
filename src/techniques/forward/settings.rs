//! The settings that only this technique reads.

use super::choices::LightBuffer;
use crate::settings::{BRDF, Changes, DEPTH_PREPASS, GEOMETRY, Kind, MAPPED_DIRECT_SHADOW, Setting};

pub const SETTINGS: &[Setting] = &[
    Setting {
        key: "light-buffer",
        kind: Kind::Choice(LightBuffer::WORDS),
        auto: true,
        default: "auto",
        help: "Buffer from which solid surfaces read the lights: a uniform buffer, which holds 1024, or a storage \
               buffer; the same picture; auto: uniform where they fit",
        ..Setting::changing(Changes::Nothing)
    },
    DEPTH_PREPASS,
    Setting {
        key: "supersample",
        kind: Kind::Integer { min: 1, max: 8 },
        default: "1",
        help: "Draw and average N x N frames, each moved by a part of a pixel: the reference for edges",
        ..Setting::changing(Changes::Samples)
    },
    BRDF,
    GEOMETRY,
    MAPPED_DIRECT_SHADOW,
];
