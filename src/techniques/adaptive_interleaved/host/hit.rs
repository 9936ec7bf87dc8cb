//! What each pixel sees, by a ray through its middle: place and shading normal as the G-buffer gives them back
//! (glsl/passes/gbuffer.frag and gbuffer.glsl).

use crate::bvh::{Bvh, Hit, HitPlace};
use crate::error::{Error, Result};
use crate::frame::ViewRay;
use crate::gpu::shader::structs::FrameBlock;
use crate::interrupt;
use crate::passes::{decode, encode};
use crate::scene::{AlphaMode, Scene};
use crate::settings::PositionStorage;
use crate::shading::material::{MeshPoint, VertexFrame, is_hole, normal_at};
use crate::techniques::adaptive_interleaved::components::Point;
use glam::{Vec2, Vec3};
use rayon::prelude::*;

/// What all pixels see, row-major.
///
/// Errors: Ctrl-C (exit code 130).
pub fn points(scene: &Scene, bvh: &Bvh, frame: &FrameBlock, position: PositionStorage) -> Result<Vec<Point>> {
    let nothing = Point { pixel: [0; 2], position_ws: Vec3::ZERO, normal_ws: Vec3::ZERO, has_surface: false };
    let mut points = vec![nothing; frame.width_px as usize * frame.height_px as usize];
    let viewer = Viewer { scene, bvh, frame, position };
    points.par_chunks_mut(frame.width_px as usize).enumerate().try_for_each(|(y, row)| {
        interrupt::check()?;
        for (x, point) in (0u32..).zip(row) {
            let pixel = [x, y as u32];
            *point = viewer.seen(pixel).unwrap_or(Point { pixel, ..nothing });
        }
        Ok::<(), Error>(())
    })?;
    Ok(points)
}

struct Viewer<'a> {
    scene: &'a Scene,
    bvh: &'a Bvh,
    frame: &'a FrameBlock,
    position: PositionStorage,
}

impl Viewer<'_> {
    fn seen(&self, pixel: [u32; 2]) -> Option<Point> {
        let middle = Vec2::from_array(pixel.map(|side| side as f32 + 0.5));
        let ray = ViewRay::through(self.frame, middle);
        let hit =
            self.bvh.closest_hit(ray.origin, ray.direction, ray.limit, |hit| self.is_drawn(hit, ray.direction))?;
        let place @ HitPlace { mesh, draw, material, vertices, weights } = self.bvh.place(self.scene, &hit);
        let [a, b, c] = vertices.map(|vertex| draw.world_from_object.transform_point3(mesh.positions[vertex]));
        let vertex_frame = VertexFrame::on(mesh, draw, vertices, weights);
        let is_front = self.bvh.is_front(&hit, ray.direction);
        let normal_ws = normal_at(self.scene, material, &mesh_point(&place), &vertex_frame, is_front);
        let words = encode::normal(normal_ws);
        Some(Point {
            pixel,
            position_ws: self.position.stored(self.frame, a * weights[0] + b * weights[1] + c * weights[2]),
            normal_ws: Vec3::from_array(decode::normal(words)),
            has_surface: words != [0; 2],
        })
    }

    fn is_drawn(&self, hit: &Hit, direction: Vec3) -> bool {
        let place = self.bvh.place(self.scene, hit);
        let is_masked = matches!(place.material.alpha, AlphaMode::Mask { .. });
        !(self.bvh.is_culled_back(hit, direction)
            || is_masked && is_hole(self.scene, place.material, &mesh_point(&place)))
    }
}

fn mesh_point(place: &HitPlace<'_>) -> MeshPoint {
    MeshPoint::on(place.mesh, place.vertices, place.weights)
}
