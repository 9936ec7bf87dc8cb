//! The rows of drawing with whole materials, which two techniques read.

use super::shadow_maps::MAPPED_DIRECT_SHADOW;
use super::tables::{BRDF, DEPTH_PREPASS, GEOMETRY};
use super::{Changes, Kind, Setting};
use crate::choice::choices;

choices! {
    /// The buffer from which solid surfaces read the lights (`--light-buffer`).
    pub enum LightBuffer {
        "uniform" => Uniform,
        "storage" => Storage,
    }
}

/// Settings of what is drawn with its whole material (`passes::forward`); `LIGHT_LISTS` and `SHADOW_MAPS` go with them.
pub const FORWARD: &[Setting] = &[
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
    BRDF,
    GEOMETRY,
    MAPPED_DIRECT_SHADOW,
];
