//! The thin lens of `--aperture` and `--focus`, which blurs what lies before and behind the plane in focus.
//!
//! Of a perspective camera the lens lies around the eye. An orthographic camera has one around each place that its parallel
//! rays come from, so that what is out of focus is blurred alike all over the picture.

use crate::bvh::Bvh;
use crate::frame::View;
use crate::scene::{Projection, Scene};
use crate::settings::Values;

/// A lens that is open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Half of `--aperture`, metres.
    pub radius: f32,
    /// From the lens to the plane in focus, along the view, metres.
    pub focus: f32,
}

impl Lens {
    /// What the settings say; None: `--aperture 0`, a pinhole. `bvh`: over `scene`.
    ///
    /// `--focus auto` is the plane of what the middle of the picture sees, holes of MASK surfaces taken as solid; where it
    /// sees nothing, of the middle of the scene's box, and where that is not before the camera, half of the scene's diagonal.
    pub fn new(values: &Values, view: &View, scene: &Scene, bvh: &Bvh) -> Option<Self> {
        let radius = 0.5 * values.number("aperture") as f32;
        let focus = || values.number_or_auto("focus").map_or_else(|| seen(view, scene, bvh), |focus| focus as f32);
        (radius > 0.0).then(|| Self { radius, focus: focus() })
    }
}

/// How far before the camera lies what the middle of the picture sees.
fn seen(view: &View, scene: &Scene, bvh: &Bvh) -> f32 {
    let (z_near, z_far) = match view.camera.projection {
        Projection::Perspective { z_near, z_far, .. } => (z_near, z_far.unwrap_or(f32::MAX)),
        Projection::Orthographic { z_near, z_far, .. } => (z_near, z_far),
    };
    let forward = -view.camera.world_from_view.z_axis.truncate();
    let origin = view.eye() + forward * z_near;
    let hit = bvh.closest_hit(origin, forward, z_far - z_near, |hit| !bvh.is_culled_back(hit, forward));
    let bounds = scene.lasting_bounds();
    let middle = (bounds.center() - view.eye()).dot(forward);
    match hit {
        Some(hit) => z_near + hit.distance,
        None if middle > z_near => middle,
        None => (0.5 * bounds.diagonal()).max(1e-3),
    }
}
