//! Resolve: the samples of a picture to their mean (`--msaa`). No shader: rendering that draws nothing, whose end resolves.
//! reads  a picture of several samples a pixel, RGBA32F      writes  a plain one
//!
//! A pass of its own, so that its time is measured apart: software drivers copy either way. The mean is of linear
//! light, and the samples are 32-bit floats, because lavapipe stores halves by cutting their last bits off.

use crate::error::Result;
use crate::gpu::{Access, ColorTarget, Commands, Edge, Image, Traffic};

/// What the pass touches: both pictures by their full names.
pub fn touches(samples: &str, plain: &str) -> [(String, Access); 2] {
    [samples, plain].map(|name| (name.to_owned(), Access::ColorWrite))
}

/// Every pixel of `plain` becomes the mean of its samples.
pub fn record(cmd: &mut Commands, technique: &str, samples: Edge<'_, Image>, plain: &Image) -> Result<()> {
    let image = samples.resource;
    let traffic =
        Traffic { read_bytes: image.description.bytes(), written_bytes: plain.description.bytes(), invocations: None };
    cmd.pass(&format!("{technique}.resolve"), traffic, |cmd| {
        cmd.barriers([samples.to(Access::ColorWrite), plain.discard(Access::ColorWrite)]);
        cmd.begin_rendering(plain.description.extent, &[ColorTarget::new(image, None).resolved(plain)], None);
        cmd.end_rendering();
        Ok(())
    })
}
