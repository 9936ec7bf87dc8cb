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
use super::plan::{COLOR, stored};
use super::{NAME, full};
use crate::error::{Error, Result};
use crate::gpu::shader::structs::FrameBlock;
use crate::gpu::{Access, Buffer, Commands, Gpu, Image, readback};
use crate::lens::Lens;
use crate::passes::accumulate::{self, Accumulate};
use crate::plan::{Plan, Resources};
use crate::report::image_file::{Aov, AovChannels};
use crate::settings::Values;
use crate::units::Extent;
use glam::{Mat4, Vec4};
use std::sync::Arc;

pub const RIGHT: &str = "stereo.right";

/// Name before those of the passes over the right eye's pictures of runs.
fn right_eye() -> String {
    full("stereo")
}

/// Errors: both eyes, and what knows of one (exit code 2).
pub fn require_both(values: &Values) -> Result<()> {
    if values.number("stereo") == 0.0 || values.text("stereo-eyes") != "both" {
        return Ok(());
    }
    let why = match values.text("shading") {
        "msaa" => "--shading msaa: it draws a pixel's samples at once, which are one eye's",
        _ if values.is_on("reconstruct") => "--reconstruct on: it filters what one eye sees",
        _ => return Ok(()),
    };
    Err(Error::request(format!("--stereo {} with {why}", values.text("stereo")))
        .within(NAME)
        .note("--stereo-eyes left and --stereo-eyes right have the picture of one eye each"))
}

/// `clip_from_world` as seen from the midpoint between the eyes. `clip`: the camera's; `depth`: row whose product with
/// a point is its distance before the camera; `metre`: growth of clip space's x for one metre to the right.
pub fn clip_from(clip: Mat4, depth: Vec4, metre: f32, lens: Lens) -> Mat4 {
    // As visibility/seen.glsl moves what a place on the lens sees.
    let mut rows = clip.transpose();
    rows.x_axis += lens.middle() * metre * (depth / lens.focus - Vec4::W);
    rows.transpose()
}

/// `frame` with its eye, which is the camera's, moved to the midpoint between the eyes.
pub fn seen_from(frame: FrameBlock, lens: Option<Lens>) -> FrameBlock {
    let Some(lens) = lens else { return frame };
    let [eye, right, forward] = [frame.eye_ws, frame.right_ws, frame.forward_ws].map(Vec4::from);
    // Rays that are parallel lean towards the same place in the plane in focus.
    let is_perspective = eye.w > 0.0;
    let leaning = (forward - right * (lens.middle() / lens.focus)).normalize();
    FrameBlock {
        eye_ws: (eye + right * lens.middle()).to_array(),
        forward_ws: if is_perspective { frame.forward_ws } else { leaning.to_array() },
        ..frame
    }
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

    /// After the resolve. `frame`: the block of glsl/frame.glsl.
    pub fn record(&self, cmd: &mut Commands, frame: &Buffer) -> Result<()> {
        let Some(accumulate) = &self.accumulate else { return Ok(()) };
        accumulate.record(cmd, &right_eye(), frame, self.color.from(Access::ComputeWrite))
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
