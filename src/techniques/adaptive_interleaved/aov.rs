//! Guidance as heat maps (Dubla 2009, figures 3 to 5), iterations, rays, and each component's irradiance before and
//! after its filter, read back after a frame.

use super::choices::{Choices, ComponentChoice};
use super::counters::{self, words};
use super::frame::AdaptiveFrame;
use super::settings::{Component, Mode};
use super::steps::ComponentSteps;
use crate::choice::Choice;
use crate::error::Result;
use crate::gpu::{Access, Buffer, Gpu, readback};
use crate::passes::decode;
use crate::picture::{Aov, AovChannels};
use crate::techniques::adaptive_interleaved::resources::IRRADIANCE_BYTES;
use std::sync::Arc;

const FLAGS: &str = "discontinuity.flags";

macro_rules! names {
    ($($key:literal),*) => {
        &[
            "gbuffer.normal",
            "gbuffer.color",
            "gbuffer.color.id",
            FLAGS,
            $(concat!("guidance.", $key),)*
            $(concat!("guidance.", $key, ".iterations"),)*
            $(concat!("rays.", $key),)*
            $(concat!("irradiance.", $key),)*
            $(concat!("filter.irradiance.", $key),)*
        ]
    };
}

/// Names that `--aov` takes: those of the G-buffer, where the filter stops, then five of each component.
pub const AOVS: &[&str] = names!("id", "ss", "pm", "ao");

/// What a stage shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Stage {
    /// Part of the most further iterations that a tile asks for, as a colour.
    Guidance,
    /// Iterations of a tile's texels.
    Iterations,
    /// Shadow rays of a texel.
    Rays,
    /// Irradiance before the filter, of airlight radiance.
    Irradiance,
    /// Irradiance after it.
    Filtered,
}

/// The stage and the component of a name; None of those that are no component's.
fn stage_of(name: &str) -> Option<(Stage, Component)> {
    let (stage, key) = match name.split('.').collect::<Vec<_>>()[..] {
        ["guidance", key] => (Stage::Guidance, key),
        ["guidance", key, "iterations"] => (Stage::Iterations, key),
        ["rays", key] => (Stage::Rays, key),
        ["irradiance", key] => (Stage::Irradiance, key),
        ["filter", "irradiance", key] => (Stage::Filtered, key),
        _ => return None,
    };
    Some((stage, Component::from_word(key)?))
}

/// Those that the settings leave out, with the reason.
pub fn left_out(choices: &Choices) -> Vec<(&'static str, String)> {
    let mut left_out = Vec::new();
    if choices.components.iter().all(ComponentChoice::is_reduced) {
        left_out.push((FLAGS, "no component is estimated at every pixel; --id-scale 1 does so".to_owned()));
    }
    for name in AOVS {
        let Some((stage, component)) = stage_of(name) else { continue };
        let key = component.name();
        if choices.components.iter().all(|choice| choice.component != component) {
            left_out.push((*name, format!("{key} is not estimated here; --components {key} asks for it")));
        } else if matches!(stage, Stage::Guidance | Stage::Iterations) && choices.mode == Mode::Igi {
            left_out.push((*name, "--mode igi refines no tile; adaptive and max do".to_owned()));
        }
    }
    left_out
}

/// Reads `name` back, which the settings make.
///
/// Errors: memory for the copy (exit code 4).
pub fn read(frame: &AdaptiveFrame, gpu: &Arc<Gpu>, name: &str) -> Result<Aov> {
    let is_made = "a stage that the settings leave out is refused";
    if name == FLAGS {
        let flags = frame.smoothing.flags().expect(is_made);
        let channels = AovChannels::YU32(words(gpu, flags, Access::ComputeRead)?);
        return Ok(Aov { name: name.to_owned(), channels });
    }
    let Some((stage, component)) = stage_of(name) else {
        return frame.gbuffer.aov(gpu, name).unwrap_or_else(|| unreachable!("there is no stage {name}"));
    };
    let mut components = frame.components.iter().enumerate();
    let (index, steps) = components.find(|(_, steps)| steps.buffers.component == component).expect(is_made);
    let params = &steps.buffers.params;
    let channels = match stage {
        Stage::Guidance => {
            let most = (params.most - params.base).max(1) as f32;
            let shown = |further| heat(further as f32 / most);
            AovChannels::Rgb(of_tiles(frame, steps, &counters::further_iterations(steps, gpu)?, shown))
        }
        Stage::Iterations => {
            let further = counters::further_iterations(steps, gpu)?;
            AovChannels::YU32(of_tiles(frame, steps, &further, |further| params.base + further))
        }
        Stage::Rays => {
            let rays = words(gpu, &steps.buffers.rays, steps.last_write())?;
            AovChannels::YU32(of_texels(frame, steps, |[x, y]| rays[(y * params.width + x) as usize]))
        }
        Stage::Irradiance => {
            let buffer = &steps.buffers.irradiance;
            let bytes = readback::buffer(gpu, buffer, buffer.bytes, Access::ComputeRead)?;
            let texels: Vec<[f32; 3]> = decode::words(&bytes).map(decode::halves).collect();
            AovChannels::Rgb(of_texels(frame, steps, |[x, y]| texels[(y * params.width + x) as usize]))
        }
        Stage::Filtered => AovChannels::Rgb(layer(frame, gpu, &frame.smoothing.filtered, index)?),
    };
    Ok(Aov { name: name.to_owned(), channels })
}

/// Blue for none, red for all, as the paper's figures have it.
fn heat(part: f32) -> [f32; 3] {
    [part, 0.0, 1.0 - part]
}

/// Each pixel with what its tile has.
fn of_tiles<T>(frame: &AdaptiveFrame, steps: &ComponentSteps, tiles: &[u32], shown: impl Fn(u32) -> T) -> Vec<T> {
    of_texels(frame, steps, |texel| shown(tiles[steps.buffers.params.tile_of(texel) as usize]))
}

/// Each pixel with what its component's texel has, which is that of several pixels where there are fewer.
fn of_texels<T>(frame: &AdaptiveFrame, steps: &ComponentSteps, shown: impl Fn([u32; 2]) -> T) -> Vec<T> {
    let (extent, scale) = (frame.gbuffer.extent(), steps.buffers.params.scale);
    let pixels = (0..extent.height).flat_map(|y| (0..extent.width).map(move |x| [x, y]));
    pixels.map(|pixel| shown(pixel.map(|side| side / scale))).collect()
}

/// One component's irradiance.
fn layer(frame: &AdaptiveFrame, gpu: &Arc<Gpu>, buffer: &Buffer, index: usize) -> Result<Vec<[f32; 3]>> {
    let bytes = readback::buffer(gpu, buffer, buffer.bytes, Access::ComputeRead)?;
    let layer_bytes = (frame.gbuffer.extent().pixel_count() * IRRADIANCE_BYTES) as usize;
    Ok(decode::words(&bytes[index * layer_bytes..][..layer_bytes]).map(decode::halves).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_component_has_its_stages() {
        let stages: Vec<(Stage, Component)> = AOVS.iter().filter_map(|name| stage_of(name)).collect();
        for word in Component::WORDS {
            let component = Component::from_word(word).unwrap();
            for stage in [Stage::Guidance, Stage::Iterations, Stage::Rays, Stage::Irradiance, Stage::Filtered] {
                assert_eq!(stages.iter().filter(|known| **known == (stage, component)).count(), 1, "{stage:?} {word}");
            }
        }
        assert_eq!([heat(0.0), heat(1.0)], [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]]);
    }
}
