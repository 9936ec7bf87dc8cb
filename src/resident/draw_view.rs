//! A view of one draw: what of it surely makes no fragment.

use super::clipped::{Clipped, ROUNDING, outside_one_plane};
use super::disc::{Disc, LensDisc};
use super::raster::{Coverage, Raster};
use super::{Cluster, DrawCall, Sides};
use crate::frame::View;
use crate::scene::{Bounds, Projection, Scene};
use glam::{DMat4, DVec2, DVec3, DVec4, Vec3};

/// Pixels by which a device may move a corner: Vulkan demands four bits below the pixel.
const SNAP_PX: f64 = 1.0 / 16.0;

/// A view of one draw.
pub struct DrawView<'a> {
    pub positions: &'a [Vec3],
    sides: Sides,
    mirrored: bool,
    coverage: Coverage,
    extent_px: DVec2,
    clip_from_object: DMat4,
    /// The same from the magnitudes of all numbers: what rounding is a part of.
    magnitude_from_object: DMat4,
    world_from_object: DMat4,
    eye_ws: DVec3,
    /// Direction of view of an orthographic camera, which has no eye.
    forward_ws: Option<DVec3>,
    /// None: a pinhole, where the camera is.
    disc: Option<Disc>,
}

impl<'a> DrawView<'a> {
    pub fn new(scene: &'a Scene, call: &DrawCall, view: &View, raster: Raster, lens: Option<LensDisc>) -> Self {
        let draw = &scene.draws[call.draw as usize];
        let (clip_from_world, world_from_object) =
            (view.clip_from_world().as_dmat4(), draw.world_from_object.as_dmat4());
        let magnitudes = |m: DMat4| DMat4::from_cols(m.x_axis.abs(), m.y_axis.abs(), m.z_axis.abs(), m.w_axis.abs());
        let forward_ws = match view.camera.projection {
            Projection::Perspective { .. } => None,
            Projection::Orthographic { .. } => Some(-view.camera.world_from_view.z_axis.truncate().as_dvec3()),
        };
        Self {
            positions: &scene.meshes[draw.mesh].positions,
            sides: call.sides,
            mirrored: call.mirrored,
            coverage: raster.coverage,
            extent_px: DVec2::new(f64::from(raster.extent.width), f64::from(raster.extent.height)),
            clip_from_object: clip_from_world * world_from_object,
            magnitude_from_object: magnitudes(clip_from_world) * magnitudes(world_from_object),
            world_from_object,
            eye_ws: view.eye().as_dvec3(),
            forward_ws,
            disc: lens.map(|lens| Disc::new(lens, view, world_from_object)),
        }
    }

    /// A point in object space, wherever on the lens it is seen from.
    pub fn clipped(&self, position: Vec3) -> Clipped {
        let at = position.as_dvec3();
        let position = at.extend(1.0);
        let point =
            self.point(self.clip_from_object * position, ROUNDING * (self.magnitude_from_object * position.abs()));
        self.disc.as_ref().map_or(point, |disc| disc.seen(at, point))
    }

    fn point(&self, at: DVec4, error: DVec4) -> Clipped {
        let reach = match self.coverage {
            Coverage::Middle => DVec2::ZERO,
            // Half a pixel.
            Coverage::Anywhere => at.w.abs() / self.extent_px,
        };
        Clipped { at, error, reach }
    }

    /// True: no triangle of the cluster can make a fragment. `indices`: the cluster's.
    pub fn sees_nothing_of(&self, cluster: &Cluster, indices: &[u32]) -> bool {
        let corners = cluster.bounds.corners().map(|corner| self.clipped(corner));
        if outside_one_plane(&corners) {
            return true;
        }
        if self.sides != Sides::Fronts {
            return false;
        }
        // No point of the box has a greater one than the worst corner.
        let error = corners.into_iter().fold(DVec4::ZERO, |most, corner| most.max(corner.error));
        indices.chunks_exact(3).all(|triangle| {
            let corners = [0, 1, 2].map(|corner| {
                let position = self.positions[triangle[corner] as usize];
                self.point(self.clip_from_object * position.as_dvec3().extend(1.0), error)
            });
            outside_one_plane(&corners) || self.faces_away(&corners)
        })
    }

    /// True: the triangle's back is seen, or it is too small to hold a pixel's middle, where middles count. Every corner
    /// must be inside the planes that clip: what is clipped falls into thin pieces, which a device may snap to another facing.
    fn faces_away(&self, corners: &[Clipped; 3]) -> bool {
        let surely_inside = |corner: &Clipped| {
            let errors = corner.errors();
            corner.inside().iter().zip(errors).all(|(inside, error)| *inside > error)
        };
        if !corners.iter().all(surely_inside) {
            return false;
        }
        let least_w = corners.iter().map(|corner| corner.at.w).fold(f64::INFINITY, f64::min);
        let error = corners[0].error;
        // Pixels by which rounding and snapping move a corner along one axis at most.
        let moved = self.extent_px.max_element() * (ROUNDING + (error.x.max(error.y) + error.w) / least_w) + SNAP_PX;
        let [a, b, c] =
            corners.map(|corner| (DVec2::new(corner.at.x, corner.at.y) / corner.at.w * 0.5 + 0.5) * self.extent_px);
        let (ab, ac) = (b - a, c - a);
        // Clockwise in a picture whose y points down is the back, and a mirror turns it round.
        let back = if self.mirrored { -ab.perp_dot(ac) } else { ab.perp_dot(ac) };
        // Each edge may change by twice what a corner moves, along both axes.
        let change = 2.0 * std::f64::consts::SQRT_2 * moved;
        if back > change * (ab.length() + ac.length() + change) {
            return true;
        }
        if self.coverage == Coverage::Anywhere {
            return false;
        }
        // Too small to know its side: no fragment either where it holds no pixel's middle.
        let (low, high) = (a.min(b).min(c) - moved - 0.5, a.max(b).max(c) + moved - 0.5);
        low.ceil().cmpgt(high.floor()).any()
    }

    /// Metres from the eye, or from its plane, to the nearest point of the box's own box in world space.
    pub fn distance(&self, bounds: &Bounds) -> f64 {
        let corners = bounds.corners().map(|corner| self.world_from_object.transform_point3(corner.as_dvec3()));
        match self.forward_ws {
            Some(forward) => {
                corners.iter().map(|corner| forward.dot(*corner - self.eye_ws)).fold(f64::INFINITY, f64::min)
            }
            None => {
                let low = corners.into_iter().fold(DVec3::INFINITY, DVec3::min);
                let high = corners.into_iter().fold(DVec3::NEG_INFINITY, DVec3::max);
                self.eye_ws.clamp(low, high).distance(self.eye_ws)
            }
        }
    }
}
