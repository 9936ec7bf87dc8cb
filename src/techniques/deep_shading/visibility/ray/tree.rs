//! The tree of the scene's triangles that primary rays walk, both ends of the exposure in it.
//!
//! It lies where x and y are those of clip space and z is the distance before the eye. There a corner goes on a straight line
//! from one end of the exposure to the other, as the rasterising kinds of visibility move it, also where the camera turns;
//! and what a place on the lens sees in one place of the picture lies on a straight line, under perspective and without.

use super::super::super::primitives::Primitives;
use crate::bvh::boxes;
use crate::error::Result;
use crate::gpu::shader::structs::{BvhNodeBlock, DeepBlock};
use crate::resident::Geometry;
use crate::scene::Scene;
use glam::{Mat4, Vec3, Vec3A, Vec4};
use obvhs::triangle::Triangle;

/// Boxes are wider than their triangles by this part of their places: what rounding of slopes may take away.
const WIDENED: f32 = 1.0 / 1_048_576.0;

/// Where points are at one end of the exposure.
pub struct End {
    clip_from_world: Mat4,
    depth_row: Vec4,
}

impl End {
    /// When the shutter opens, and when it closes.
    pub fn both(deep: &DeepBlock) -> [Self; 2] {
        let end = |clip: &[[f32; 4]; 4], depth: [f32; 4]| Self {
            clip_from_world: Mat4::from_cols_array_2d(clip),
            depth_row: Vec4::from_array(depth),
        };
        [end(&deep.open_clip_from_world, deep.open_depth), end(&deep.close_clip_from_world, deep.close_depth)]
    }

    pub fn clip(&self, position_ws: Vec3) -> Vec4 {
        self.clip_from_world * position_ws.extend(1.0)
    }

    fn place(&self, position_ws: Vec3) -> Vec3 {
        self.clip(position_ws).truncate().truncate().extend(self.depth_row.dot(position_ws.extend(1.0)))
    }
}

/// Corners of a draw's triangle in world space, `vertices` of its mesh.
pub fn corners_ws(moment: &Scene, draw: u32, vertices: [u32; 3]) -> [Vec3; 3] {
    let draw = &moment.draws[draw as usize];
    let positions = &moment.meshes[draw.mesh].positions;
    vertices.map(|vertex| draw.world_from_object.transform_point3(positions[vertex as usize]))
}

/// A ray's hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    pub primitive: u32,
    pub draw: u32,
    /// Vertices of the draw's mesh.
    pub vertices: [u32; 3],
    /// Before the eye, metres.
    pub depth: f32,
    /// Weights of the corners, whose sum is 1.
    pub weights: Vec3,
    /// The corners run counter-clockwise on the screen.
    pub is_front: bool,
}

/// One of the scene's triangles at both ends.
struct Swept {
    corners: [[Vec3; 3]; 2],
    primitive: u32,
    draw: u32,
    vertices: [u32; 3],
}

pub struct SweptTree {
    nodes: Vec<BvhNodeBlock>,
    /// In the order of leaves.
    swept: Vec<Swept>,
}

/// A straight line before the eye: where it is at depth 0, and how far it goes aside a metre of depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    pub origin: Vec3,
    pub direction: Vec3,
    /// 0: the shutter opens; 1: it closes.
    pub time: f32,
}

impl SweptTree {
    /// Over everything that `scene` draws. `ends` of its cameras.
    ///
    /// Errors: more triangles than a tree is built over (exit code 2).
    pub fn new(scene: &Scene, primitives: &Primitives, ends: &[End; 2]) -> Result<Self> {
        crate::bvh::require_fitting(scene)?;
        let closing = scene.closing.as_deref().unwrap_or(scene);
        let mut swept = Vec::new();
        // In the order in which the device has them, which ids are of.
        let geometry = Geometry::of(scene);
        for call in geometry.calls(scene) {
            let indices = call.first_index..call.first_index + call.index_count;
            for first in indices.step_by(3) {
                let vertices = [0, 1, 2].map(|corner| geometry.indices[(first + corner) as usize]);
                let places = |end: usize| {
                    let moment = [scene, closing][end];
                    corners_ws(moment, call.draw, vertices).map(|corner| ends[end].place(corner))
                };
                let primitive = primitives.id(call.draw, first);
                swept.push(Swept { corners: [places(0), places(1)], primitive, draw: call.draw, vertices });
            }
        }
        let at_end = |end: usize| -> Vec<Triangle> {
            let triangle = |[v0, v1, v2]: [Vec3A; 3]| Triangle { v0, v1, v2 };
            swept.iter().map(|of| triangle(of.corners[end].map(Vec3A::from))).collect()
        };
        let (mut nodes, order) = boxes::over(&at_end(0), &at_end(1));
        for BvhNodeBlock { min_count, max_first } in &mut nodes {
            for axis in 0..3 {
                let by = WIDENED * min_count[axis].abs().max(max_first[axis].abs());
                min_count[axis] -= by;
                max_first[axis] += by;
            }
        }
        let mut waiting: Vec<Option<Swept>> = swept.into_iter().map(Some).collect();
        let swept = order.into_iter().map(|index| waiting[index as usize].take().expect("a leaf's alone")).collect();
        Ok(Self { nodes, swept })
    }

    /// The first hit of a ray between two depths; among hits at one depth the least id. `accept` may let it pass.
    pub fn first(&self, ray: &Ray, [near, far]: [f32; 2], accept: impl Fn(&RayHit) -> bool) -> Option<RayHit> {
        let mut first: Option<RayHit> = None;
        boxes::walk(&self.nodes, ray.origin, ray.direction, far, |index, limit| {
            let met = self.swept[index].met(ray).filter(|met| met.depth >= near && met.depth <= limit)?;
            let is_behind = first.is_some_and(|held| (held.depth, held.primitive) < (met.depth, met.primitive));
            if is_behind || !accept(&met) {
                return None;
            }
            first = Some(met);
            Some(met.depth)
        });
        first
    }
}

impl Swept {
    /// Neighbours compute the areas at their edge from the same corners, which differ by the sign alone: no ray falls between
    /// them (the test of covers.glsl; Woop et al. 2013).
    fn met(&self, ray: &Ray) -> Option<RayHit> {
        let [a, b, c] = [0, 1, 2].map(|corner| {
            let [open, close] = [self.corners[0][corner], self.corners[1][corner]];
            let at = open * (1.0 - ray.time) + close * ray.time - ray.origin;
            (at.truncate() - at.z * ray.direction.truncate()).extend(at.z)
        });
        let across = |from: Vec3, to: Vec3| from.x * to.y - from.y * to.x;
        let areas = Vec3::new(across(b, c), across(c, a), across(a, b));
        let area = areas.x + areas.y + areas.z;
        if area == 0.0 || !(areas.cmpge(Vec3::ZERO).all() || areas.cmple(Vec3::ZERO).all()) {
            return None;
        }
        let weights = areas / area;
        let depth = weights.dot(Vec3::new(a.z, b.z, c.z));
        let Self { primitive, draw, vertices, .. } = *self;
        Some(RayHit { primitive, draw, vertices, depth, weights, is_front: area < 0.0 })
    }
}
