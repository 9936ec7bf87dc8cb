//! Where both eyes see from: the middle between them, and its lens.

use crate::gpu::shader::structs::FrameBlock;
use crate::lens::Lens;
use glam::{Mat4, Vec4};

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
