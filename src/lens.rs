//! The thin lens of `--aperture` and `--focus`, which blurs what lies before and behind the plane in focus, and the two eyes of
//! `--stereo`, which are places in the plane of the lens: what lies in the plane in focus is in one place of both pictures.
//!
//! The lens of a perspective camera lies around the eye. An orthographic camera has one around each place that its
//! parallel rays come from, so that what is out of focus is blurred equally all over the picture.

use crate::bvh::Bvh;
use crate::frame::View;
use crate::scene::{Projection, Scene};
use crate::settings::{StereoEyes, Values};
use glam::Vec2;

/// A lens that is open, or that is not where the camera is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Half of `--aperture`, metres.
    pub radius: f32,
    /// From the lens to the plane in focus, along the view, metres.
    pub focus: f32,
    pub eyes: Eyes,
}

/// Lenses that see at once (`--stereo`, `--stereo-eyes`).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Eyes {
    /// So many metres to the camera's right.
    One { aside: f32 },
    /// So many metres to the camera's left and to its right; more than 0.
    Two { aside: f32 },
}

impl Eyes {
    fn of(values: &Values) -> Self {
        let aside = 0.5 * values.number("stereo") as f32;
        match values.choice("stereo-eyes") {
            StereoEyes::Left => Self::One { aside: -aside },
            StereoEyes::Right => Self::One { aside },
            StereoEyes::Both if aside > 0.0 => Self::Two { aside },
            StereoEyes::Both => Self::One { aside: 0.0 },
        }
    }
}

impl Lens {
    /// What the settings say; None: `--aperture 0`, a pinhole, where the camera is. `bvh`: over `scene`.
    ///
    /// `--focus auto` is the plane of what the middle of the picture sees, holes of MASK surfaces taken as solid; where it
    /// sees nothing, of the middle of the scene's box, and where that is not before the camera, half of the scene's diagonal.
    pub fn new(values: &Values, view: &View, scene: &Scene, bvh: &Bvh) -> Option<Self> {
        let (radius, eyes) = (0.5 * values.number("aperture") as f32, Eyes::of(values));
        let is_open = radius > 0.0 || eyes != Eyes::One { aside: 0.0 };
        is_open.then(|| Self { radius, focus: focus_m(values, view, scene, bvh), eyes })
    }

    /// The eye that the picture is of, the left one of two: metres to the camera's right.
    pub fn aside(&self) -> f32 {
        match self.eyes {
            Eyes::One { aside } => aside,
            Eyes::Two { aside } => -aside,
        }
    }

    /// The middle of all that sees, metres to the camera's right.
    pub fn middle(&self) -> f32 {
        match self.eyes {
            Eyes::One { aside } => aside,
            Eyes::Two { .. } => 0.0,
        }
    }

    /// The radius of a disc around that middle which has the lenses of all eyes in it, metres.
    pub fn reach(&self) -> f32 {
        match self.eyes {
            Eyes::One { .. } => self.radius,
            Eyes::Two { aside } => self.radius + aside,
        }
    }

    /// Where the eyes are on that disc, as parts of its radius to the right of its middle, the left one first: each has a lens
    /// that touches the disc's rim.
    pub fn places(&self) -> Vec<f32> {
        match self.eyes {
            Eyes::One { .. } => vec![0.0],
            Eyes::Two { aside } => [-aside, aside].map(|aside| aside / self.reach()).into(),
        }
    }
}

/// A place on the unit disc, evenly over it, of two numbers of 0 to 1.
pub fn on_unit_disc([u, v]: [f32; 2]) -> Vec2 {
    let (radius, turn) = (u.sqrt(), v * std::f32::consts::TAU);
    Vec2::new(radius * turn.cos(), radius * turn.sin())
}

/// `--focus` in metres, `auto` as `Lens::new` has it.
pub fn focus_m(values: &Values, view: &View, scene: &Scene, bvh: &Bvh) -> f32 {
    values.unless_auto("focus", Values::number).map_or_else(|| seen(view, scene, bvh), |focus| focus as f32)
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
