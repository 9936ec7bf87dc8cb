//! Stereo: two eyes that share one deep shading buffer (`--stereo`; Clarberg & Munkberg 2014, section 7, has several views as
//! future work), and the pictures of either.
//!
//! Why this way: eyes whose pictures agree in the plane in focus are places in the plane of a lens, off-axis projections as that
//! of every tuple. So the tuples of the left eye and of the right one lie in one unit disk, as those of a wide lens do (tuples.rs),
//! and all that holds for each place on a lens, such as hulls and polygons, holds for both. Shading space is seen from between the eyes:
//! what both see at a pixel of it is listed and shaded once. One eye alone (`--stereo-eyes`) has a shading space of its own.
//!
//! writes  stereo.right  image, RGBA32F, frame extent: the right eye's picture, a stage; the left one's is the frame's

use super::choices::Choices;
use crate::error::Result;
use crate::gpu::{Access, Buffer, Commands, Edge, Gpu, Image, readback};
use crate::passes::accumulate::{self, Accumulate};
use crate::picture::{Aov, AovChannels};
use crate::plan::{Plan, Resources};
use crate::techniques::deep_shading::resources::{COLOR, full, stored};
use crate::units::Extent;
use std::sync::Arc;

pub const RIGHT: &str = "stereo.right";

/// Name before those of the passes over the right eye's pictures of runs.
fn right_eye() -> String {
    full("stereo")
}

/// The right eye's picture, of a run and of all.
pub fn plan(plan: &mut Plan, choices: &Choices, frame: Extent) {
    if !choices.has_right_eye() {
        return;
    }
    if choices.run_count > 1 {
        stored(plan, RIGHT, frame);
        accumulate::plan(plan, &right_eye(), frame);
    } else {
        plan.picture(full(RIGHT), frame);
    }
}

/// The pass after all others.
pub fn plan_pass(plan: &mut Plan, choices: &Choices) {
    if choices.has_right_eye() && choices.run_count > 1 {
        accumulate::plan_pass(plan, &right_eye(), &full(RIGHT));
    }
}

/// Pictures that the resolve writes.
pub fn resolved(choices: &Choices) -> impl Iterator<Item = (String, Access)> {
    let right = choices.has_right_eye().then_some(RIGHT);
    [COLOR].into_iter().chain(right).map(|name| (full(name), Access::ComputeWrite))
}

pub struct RightEye {
    /// Picture of one run.
    pub color: Image,
    accumulate: Option<Accumulate>,
}

impl RightEye {
    /// None: there is one eye.
    pub fn new(gpu: &Arc<Gpu>, resources: &mut Resources, choices: &Choices) -> Result<Option<Self>> {
        if !choices.has_right_eye() {
            return Ok(None);
        }
        let accumulate = match choices.run_count {
            1 => None,
            _ => Some(Accumulate::new(gpu, &right_eye(), resources)?),
        };
        Ok(Some(Self { color: resources.image(&full(RIGHT)), accumulate }))
    }

    /// `frame`: the block of glsl/frame.glsl; `resolved`: `color`.
    pub fn record(&self, cmd: &mut Commands, frame: &Buffer, resolved: Edge<'_, Image>) -> Result<()> {
        let Some(accumulate) = &self.accumulate else { return Ok(()) };
        accumulate.record(cmd, &right_eye(), frame, resolved)
    }

    /// The mean of all runs.
    ///
    /// Errors: memory for the copy (exit code 4).
    pub fn stage(&self, gpu: &Arc<Gpu>) -> Result<Aov> {
        let picture = self.accumulate.as_ref().map_or(&self.color, |accumulate| &accumulate.color);
        let pixels: Vec<[f32; 4]> = bytemuck::pod_collect_to_vec(&readback::image(gpu, picture, Access::ComputeWrite)?);
        let colors = pixels.into_iter().map(|[red, green, blue, _]| [red, green, blue]);
        Ok(Aov { name: RIGHT.to_owned(), channels: AovChannels::Rgb(colors.collect()) })
    }
}
