//! The settings that only this technique reads.

use crate::settings::{Changes, Kind, Setting};

pub const SETTINGS: &[Setting] = &[Setting {
    key: "supersample",
    kind: Kind::Integer { min: 1, max: 8 },
    default: "1",
    help: "Draw and average N x N frames, each moved by a part of a pixel: the reference for edges",
    ..Setting::changing(Changes::Samples)
}];
