//! How wide the border of shading space is around the frame (`--guard-band`; Clarberg & Munkberg 2014, section 6, where it is 64
//! of the frame's 1280 pixels).
//!
//! Shading space is the picture in the middle of the exposure from the middle of the lens. What a sample sees at the frame's rim lies
//! beyond it there, by as much as it moves in half of the exposure and as the lens spreads it. `auto` is the farthest that
//! triangles in the picture lie out, when the shutter opens and when it closes. Triangles are cut at the rim of the sharp picture:
//! what only a rim of the lens sees is not looked at by itself. What lies farther out than the border is shaded sample by sample.
//! It takes some 0.1 s of a processor for the 528,000 triangles of `arena`, and nothing where nothing is blurred.

use super::eyes::{Sight, metre};
use super::mid_exposure::MidExposure;
use crate::lens::Lens;
use crate::scene::{Draw, Scene};
use crate::settings::Values;
use crate::techniques::Inputs;
use crate::units::Extent;
use glam::{Mat4, Vec2, Vec3, Vec4, Vec4Swizzles};
use rayon::prelude::*;

/// The paper's border as a part of the frame's longer side, the widest that `auto` comes to.
const WIDEST: f64 = 64.0 / 1280.0;

/// Room for the rounding of places at the rim, pixels; and how far out is no more than that.
const ROUNDING_PX: u32 = 1;
const ROUNDED_PX: f64 = 0.01;

/// Triangles that a thread looks at in a row.
const TRIANGLES_AT_ONCE: usize = 4096;

/// Pixels of shading space on each side of the frame: `--guard-band`; auto: as `room` is wide, up to a twentieth of the frame's
/// longer side, and one for rounding.
pub fn width_px(values: &Values, inputs: &Inputs<'_>, lens: Option<Lens>, exposure: Option<&MidExposure>) -> u32 {
    let auto = || {
        let scale = values.number("shading-scale");
        let frame = inputs.view.extent;
        let widest = f64::from(frame.width.max(frame.height)) * WIDEST;
        let room = match lens.is_some() || exposure.is_some() {
            true => f64::from(room_px(inputs, lens, exposure)),
            false => 0.0,
        };
        (room.min(widest) * scale - ROUNDED_PX).ceil().max(0.0) as u32 + ROUNDING_PX
    };
    values.unless_auto("guard-band", Values::integer).map_or_else(auto, |width| width as u32)
}

/// How far out of the frame what its pixels see lies in the middle of the exposure, pixels of the frame; infinite where that is
/// behind the eye.
fn room_px(inputs: &Inputs<'_>, lens: Option<Lens>, exposure: Option<&MidExposure>) -> f32 {
    let close_view = exposure.map_or(inputs.view, |exposure| &exposure.closing.view);
    let [open, close] = Sight::of_exposure(inputs.view, close_view, lens);
    let closing = inputs.scene.closing.as_deref().unwrap_or(inputs.scene);
    let blur = Blur::new(inputs.view.extent, metre(inputs.view), lens);
    let opened = Moment { scene: inputs.scene, sight: &open };
    let closed = Moment { scene: closing, sight: &close };
    let at_opening = blur.room_px(&opened, &closed);
    match exposure {
        Some(_) => at_opening.max(blur.room_px(&closed, &opened)),
        None => at_opening,
    }
}

/// An end of the exposure.
struct Moment<'a> {
    scene: &'a Scene,
    sight: &'a Sight,
}

impl Moment<'_> {
    /// Places and the matrices that take them to clip space and to a distance before the eye.
    fn drawn(&self, draw: usize) -> (&[Vec3], Mat4, Vec4) {
        let Draw { mesh, world_from_object, .. } = &self.scene.draws[draw];
        let depth = world_from_object.transpose() * self.sight.depth;
        (&self.scene.meshes[*mesh].positions, self.sight.clip_from_world * *world_from_object, depth)
    }
}

/// A point that is seen at one end of the exposure.
#[derive(Clone, Copy)]
struct Point {
    /// In clip space at this end, and at the other.
    here: Vec4,
    there: Vec4,
    /// Metres before the eye at this end.
    depth: f32,
}

impl Point {
    fn mix(self, other: Self, part: f32) -> Self {
        Self {
            here: self.here.lerp(other.here, part),
            there: self.there.lerp(other.there, part),
            depth: self.depth + (other.depth - self.depth) * part,
        }
    }

    /// Distances to the near plane and the frame's four sides, times something positive; inside is 0 and above.
    fn inside(&self) -> [f32; 5] {
        let [x, y, z, w] = self.here.to_array();
        // Depth is reversed: w at the near plane.
        [w - z, w + x, w - x, w + y, w - y]
    }
}

/// What a lens and a frame make of places.
struct Blur {
    /// Half of the frame's sides, pixels.
    half_px: Vec2,
    /// Growth of clip space for a metre to the right, and for one up, times the lens's radius.
    reach: Vec2,
    inverse_focus: f32,
}

impl Blur {
    fn new(frame: Extent, metre: Vec2, lens: Option<Lens>) -> Self {
        Self {
            half_px: 0.5 * Vec2::new(frame.width as f32, frame.height as f32),
            reach: metre * lens.map_or(0.0, |lens| lens.reach()),
            inverse_focus: lens.map_or(0.0, |lens| 1.0 / lens.focus),
        }
    }

    /// How far out what the frame sees at `here` lies halfway to `there`.
    fn room_px(&self, here: &Moment<'_>, there: &Moment<'_>) -> f32 {
        let of_draw = |draw: usize| {
            let ((from, clip_here, depth), (to, clip_there, _)) = (here.drawn(draw), there.drawn(draw));
            let point = |vertex: &u32| Point {
                here: clip_here * from[*vertex as usize].extend(1.0),
                there: clip_there * to[*vertex as usize].extend(1.0),
                depth: depth.dot(from[*vertex as usize].extend(1.0)),
            };
            let indices = &here.scene.meshes[here.scene.draws[draw].mesh].indices;
            let of_triangles = |triangles: &[u32]| {
                let rooms = triangles.chunks_exact(3).map(|triangle| {
                    let corners = [&triangle[0], &triangle[1], &triangle[2]].map(point);
                    seen(corners).into_iter().map(|point| self.out_px(&point)).fold(0.0, f32::max)
                });
                rooms.fold(0.0, f32::max)
            };
            indices.par_chunks(3 * TRIANGLES_AT_ONCE).map(of_triangles).reduce(|| 0.0, f32::max)
        };
        (0..here.scene.draws.len()).into_par_iter().map(of_draw).reduce(|| 0.0, f32::max)
    }

    /// How far out a point in the frame may be seen to lie in the middle of the exposure.
    fn out_px(&self, point: &Point) -> f32 {
        let middle = point.here.midpoint(point.there);
        if middle.w <= 0.0 {
            return f32::INFINITY;
        }
        let spread = self.reach * ((1.0 - point.depth * self.inverse_focus).abs() / point.here.w);
        ((middle.xy().abs() / middle.w + spread - 1.0) * self.half_px).max_element()
    }
}

/// The corners of what the frame sees of a triangle.
fn seen(corners: [Point; 3]) -> Vec<Point> {
    let sides = corners.map(|corner| corner.inside());
    if (0..5).any(|plane| sides.iter().all(|inside| inside[plane] < 0.0)) {
        return Vec::new();
    }
    let mut polygon = corners.to_vec();
    for plane in (0..5).filter(|plane| sides.iter().any(|inside| inside[*plane] < 0.0)) {
        polygon = (0..polygon.len())
            .flat_map(|at| {
                let (from, to) = (polygon[at], polygon[(at + 1) % polygon.len()]);
                let [before, after] = [from, to].map(|point| point.inside()[plane]);
                let crossing = (before < 0.0) != (after < 0.0);
                let entry = crossing.then(|| from.mix(to, before / (before - after)));
                [(before >= 0.0).then_some(from), entry].into_iter().flatten()
            })
            .collect();
    }
    polygon
}
