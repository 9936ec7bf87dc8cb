//! The disc of places from which a lens sees.

use super::clipped::{Clipped, ROUNDING};
use crate::frame::View;
use glam::{DMat4, DVec2, DVec3, DVec4};

/// A disc around the camera's place, or beside it, in the plane of the lens.
#[derive(Clone, Copy, Debug)]
pub struct LensDisc {
    /// Metres to the camera's right of its middle.
    pub aside_m: f32,
    pub radius_m: f32,
    /// From the lens to the plane in focus, along the view, metres.
    pub focus_m: f32,
}

/// What a lens does to the places of points in clip space.
pub struct Disc {
    /// Clip-space units for a metre of the picture's plane.
    scale: DVec2,
    aside_m: f64,
    radius_m: f64,
    focus_m: f64,
    view_from_object: DMat4,
}

impl Disc {
    pub fn new(lens: LensDisc, view: &View, world_from_object: DMat4) -> Self {
        Self {
            scale: view.clip_scale().as_dvec2().abs(),
            aside_m: lens.aside_m.into(),
            radius_m: lens.radius_m.into(),
            focus_m: lens.focus_m.into(),
            view_from_object: view.camera.world_from_view.as_dmat4().inverse() * world_from_object,
        }
    }

    /// `point`, at `position` in object space, as the middle of the disc sees it, with as much more reach as its rim has.
    pub fn seen(&self, position: DVec3, point: Clipped) -> Clipped {
        let depth = -self.view_from_object.transform_point3(position).z;
        // Nothing in the plane in focus, and more the farther from it.
        let spread = 1.0 - depth / self.focus_m;
        let rounding = 2.0 * ROUNDING * (self.aside_m.abs() + self.radius_m) * (1.0 + depth.abs() / self.focus_m);
        Clipped {
            at: point.at - DVec4::X * (self.scale.x * self.aside_m * spread),
            error: point.error + (self.scale * rounding).extend(0.0).extend(0.0),
            reach: point.reach + self.scale * (self.radius_m * spread.abs()),
        }
    }
}
