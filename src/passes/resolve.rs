//! Resolve: the samples of a picture to their mean (`--msaa`). No shader: rendering that draws nothing, whose end resolves.
//! reads  a picture of several samples a pixel, RGBA32F      writes  a plain one
//!
//! A pass of its own, so that its time is measured apart: software drivers copy either way. The mean is of linear
//! light, and the samples are 32-bit floats, because lavapipe stores halves by cutting their last bits off.

use crate::caps::{Ability, Need};
use crate::error::Result;
use crate::gpu::{Access, ColorTarget, Commands, Edge, Image, Traffic};
use crate::settings::Values;

/// Samples a pixel that `--msaa` asks for.
pub fn samples(values: &Values) -> u32 {
    values.integer("msaa") as u32
}

/// What `--msaa` needs of a device.
pub fn needs(values: &Values) -> Option<Need> {
    let samples = samples(values);
    let (ability, instead) = match samples {
        4 => (Ability::FourSamples, "--msaa 1 works everywhere"),
        8 => (Ability::EightSamples, "--msaa 4 works on more devices, --msaa 1 everywhere"),
        _ => return None,
    };
    Some(Need { of: format!("--msaa {samples}"), ability, instead })
}

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
