//! Where shading space is seen from: the middle of the lens, or the midpoint between two eyes.

use crate::frame::View;
use crate::gpu::shader::structs::FrameBlock;
use crate::lens::Lens;
use glam::{Mat4, Vec2, Vec3, Vec4};

/// What the middle of the lens sees at one moment.
pub struct Sight {
    pub clip_from_world: Mat4,
    /// Row whose product with a point is its distance before the plane of the eye, metres.
    pub depth: Vec4,
}

impl Sight {
    /// When the shutter opens and when it closes.
    pub fn of_exposure(open: &View, close: &View, lens: Option<Lens>) -> [Self; 2] {
        let metre = metre(open).x;
        [open, close].map(|view| {
            let (clip, depth) = (view.clip_from_world(), depth_row(view));
            Self { clip_from_world: lens.map_or(clip, |lens| clip_from(clip, depth, metre, lens)), depth }
        })
    }
}

/// Growth of clip space for a metre to the right and for one up.
pub fn metre(view: &View) -> Vec2 {
    let clip = view.clip_from_world();
    Vec2::from_array([0, 1].map(|row| clip.row(row).truncate().length()))
}

fn depth_row(view: &View) -> Vec4 {
    let forward: Vec3 = -view.camera.world_from_view.z_axis.truncate();
    forward.extend(-forward.dot(view.eye()))
}

/// `clip_from_world` as seen from the midpoint between the eyes. `clip`: the camera's; `depth`: row whose product with
/// a point is its distance before the camera; `metre`: growth of clip space's x for one metre to the right.
fn clip_from(clip: Mat4, depth: Vec4, metre: f32, lens: Lens) -> Mat4 {
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
