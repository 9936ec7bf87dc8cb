//! The tree that rays walk, for the host and for compute shaders (glsl/bvh.glsl, glsl/bvh_walk.glsl).
//!
//! This file lays it out as the shaders read it and walks it on the host, as the shaders' twin. MASK surfaces are in it: the caller of `closest_hit` decides about holes, shadow rays of `occluded`
//! take them as solid. BLEND surfaces stop no light of the techniques that rasterise, and are in the whole tree only,
//! whose triangles say what a ray must ask of them (TRIANGLE_ bits).

pub mod boxes;
pub mod flat;
mod lazy;
mod moving;
pub mod nodes;
mod refit;
pub mod shadow;

pub use lazy::{LazyBvh, TreeUse};

use crate::error::{Error, Result};
use crate::gpu::shader::bvh::{TRIANGLE_MIRRORED, TRIANGLE_SINGLE_SIDED, TRIANGLE_TESTED};
use crate::gpu::shader::structs::{BvhNodeBlock, BvhTriangleBlock};
use crate::progress::Stage;
use crate::scene::{AlphaMode, Draw, Material, Mesh, Scene};
use glam::Vec3;
use obvhs::triangle::Triangle;

/// Its tree takes some 16 GiB.
const MOST_TRIANGLES: u64 = 1 << 26;

/// Boxes and triangles in leaf order.
pub struct Bvh {
    pub nodes: Vec<BvhNodeBlock>,
    pub triangles: Vec<BvhTriangleBlock>,
    /// The same when the shutter closes; boxes hold both, and so all between. Empty where nothing moves.
    pub closing: Vec<BvhTriangleBlock>,
    /// Where each of `triangles` comes from.
    pub sources: Vec<Source>,
}

/// Triangle `triangle` of draw `draw`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Source {
    pub draw: u32,
    pub triangle: u32,
}

/// The first triangle that a ray meets.
#[derive(Clone, Copy, Debug)]
pub struct Hit {
    /// In lengths of the direction.
    pub distance: f32,
    /// Index into `Bvh::triangles`.
    pub triangle: usize,
    /// Weights of the second and the third corner.
    pub barycentric: [f32; 2],
}

/// What the scene knows of a hit.
#[derive(Clone, Copy, Debug)]
pub struct HitPlace<'a> {
    pub mesh: &'a Mesh,
    pub draw: &'a Draw,
    pub material: &'a Material,
    /// Vertices of the triangle, and their weights, which add up to 1.
    pub vertices: [usize; 3],
    pub weights: [f32; 3],
}

impl Bvh {
    /// Builds the tree over everything opaque or masked, in world space.
    ///
    /// Errors: more triangles than a tree is built over (exit code 2).
    pub fn build(scene: &Scene) -> Result<Self> {
        Self::of(scene, |material| material.alpha != AlphaMode::Blend)
    }

    /// Builds the tree over everything, BLEND surfaces included, in world space.
    ///
    /// Errors: as `build`.
    pub fn whole(scene: &Scene) -> Result<Self> {
        Self::of(scene, |_| true)
    }

    fn of(scene: &Scene, holds: impl Fn(&Material) -> bool) -> Result<Self> {
        require_fitting(scene)?;
        let _stage = Stage::begin("building the tree of triangles");
        let mut corners = Vec::new();
        let mut closing = Vec::new();
        let mut sources = Vec::new();
        for (draw_index, draw) in scene.draws.iter().enumerate() {
            let mesh = &scene.meshes[draw.mesh];
            if !holds(&scene.materials[mesh.material]) {
                continue;
            }
            for triangle in 0..mesh.triangle_count() {
                corners.push(triangle_in_world(scene, draw, triangle));
                sources.push(Source { draw: draw_index as u32, triangle: triangle as u32 });
                if let Some(scene) = &scene.closing {
                    closing.push(triangle_in_world(scene, &scene.draws[draw_index], triangle));
                }
            }
        }
        if corners.is_empty() {
            return Ok(Self::empty());
        }
        let (nodes, order) = boxes::over(&corners, &closing);
        let order: Vec<usize> = order.into_iter().map(|index| index as usize).collect();
        let block = |index: &usize, from: &[Triangle]| block_of(scene, &sources[*index], &from[*index]);
        let triangles = order.iter().map(|index| block(index, &corners)).collect();
        let is_moving = !closing.is_empty();
        let closing = order.iter().filter(|_| is_moving).map(|index| block(index, &closing)).collect();
        Ok(Self { nodes, triangles, closing, sources: order.iter().map(|index| sources[*index]).collect() })
    }

    /// A tree that no ray meets: one leaf with a triangle of no area, which has no source.
    pub fn empty() -> Self {
        let node = BvhNodeBlock { min_count: [0.0, 0.0, 0.0, f32::from_bits(1)], max_first: [0.0; 4] };
        let triangle = BvhTriangleBlock { corner: [0.0; 4], edge1: [0.0; 4], edge2: [0.0; 4] };
        Self { nodes: vec![node], triangles: vec![triangle], closing: Vec::new(), sources: Vec::new() }
    }

    /// The nearest triangle along a ray, both of its sides, nearer than `limit`; `accept` may let a ray pass.
    pub fn closest_hit(&self, origin: Vec3, direction: Vec3, limit: f32, accept: impl Fn(&Hit) -> bool) -> Option<Hit> {
        let mut best: Option<Hit> = None;
        boxes::walk(&self.nodes, origin, direction, limit, |triangle, limit| {
            let hit = self.hit_of(triangle, origin, direction, limit)?;
            if !accept(&hit) {
                return None;
            }
            best = Some(hit);
            Some(hit.distance)
        });
        best
    }

    /// Where a ray meets one of `triangles`, nearer than `limit`.
    pub fn hit_of(&self, triangle: usize, origin: Vec3, direction: Vec3, limit: f32) -> Option<Hit> {
        let (distance, barycentric) = intersect(self.triangles.get(triangle)?, origin, direction, limit)?;
        Some(Hit { distance, triangle, barycentric })
    }

    /// Where in `scene`, over which the tree is, a hit lies.
    pub fn place<'a>(&self, scene: &'a Scene, hit: &Hit) -> HitPlace<'a> {
        let source = self.sources[hit.triangle];
        let draw = &scene.draws[source.draw as usize];
        let mesh = &scene.meshes[draw.mesh];
        let [u, v] = hit.barycentric;
        HitPlace {
            mesh,
            draw,
            material: &scene.materials[mesh.material],
            vertices: mesh.corners(source.triangle as usize),
            weights: [1.0 - u - v, u, v],
        }
    }

    /// Whether a ray of this direction meets the front of a surface.
    pub fn is_front(&self, hit: &Hit, direction: Vec3) -> bool {
        let triangle = &self.triangles[hit.triangle];
        let three = |[x, y, z, _]: [f32; 4]| Vec3::new(x, y, z);
        let is_mirrored = triangle.corner[3].to_bits() & TRIANGLE_MIRRORED != 0;
        (three(triangle.edge1).cross(three(triangle.edge2)).dot(direction) < 0.0) != is_mirrored
    }

    /// Whether a ray of this direction meets the back of a single-sided surface, which is not drawn.
    pub fn is_culled_back(&self, hit: &Hit, direction: Vec3) -> bool {
        let flags = self.triangles[hit.triangle].corner[3].to_bits();
        flags & TRIANGLE_SINGLE_SIDED != 0 && !self.is_front(hit, direction)
    }

    /// Whether anything lies on the ray before `limit`.
    pub fn occluded(&self, origin: Vec3, direction: Vec3, limit: f32) -> bool {
        let mut met = false;
        boxes::walk(&self.nodes, origin, direction, limit, |triangle, limit| {
            met |= intersect(&self.triangles[triangle], origin, direction, limit).is_some();
            // A limit of 0 ends the walk: no box is entered any more.
            met.then_some(0.0)
        });
        met
    }
}

/// Errors: more triangles than a tree is built over (exit code 2).
pub fn require_fitting(scene: &Scene) -> Result<()> {
    let count = scene.triangle_count();
    if count <= MOST_TRIANGLES {
        return Ok(());
    }
    Err(Error::request(format!("rays are cast among up to {MOST_TRIANGLES} triangles, and the scene draws {count}"))
        .note("`--technique deferred --direct-shadow none` casts none"))
}

/// Triangle `triangle` of a draw, in world space.
fn triangle_in_world(scene: &Scene, draw: &Draw, triangle: usize) -> Triangle {
    let corners = scene.meshes[draw.mesh].triangle(triangle);
    let [v0, v1, v2] = corners.map(|corner| draw.world_from_object.transform_point3(corner).into());
    Triangle { v0, v1, v2 }
}

/// The triangle of `source` at these corners, in world space, as rays read it.
fn block_of(scene: &Scene, source: &Source, corners: &Triangle) -> BvhTriangleBlock {
    let Triangle { v0, v1, v2 } = *corners;
    let four = |v: glam::Vec3A, w: f32| [v.x, v.y, v.z, w];
    let flags = f32::from_bits(flags_of(scene, source));
    BvhTriangleBlock { corner: four(v0, flags), edge1: four(v1 - v0, 0.0), edge2: four(v2 - v0, 0.0) }
}

/// TRIANGLE_ bits of a triangle.
fn flags_of(scene: &Scene, source: &Source) -> u32 {
    let draw = &scene.draws[source.draw as usize];
    let material = &scene.materials[scene.meshes[draw.mesh].material];
    let bit = |is_set: bool, bit: u32| if is_set { bit } else { 0 };
    bit(material.alpha != AlphaMode::Opaque, TRIANGLE_TESTED)
        | bit(!material.double_sided, TRIANGLE_SINGLE_SIDED)
        | bit(draw.world_from_object.determinant() < 0.0, TRIANGLE_MIRRORED)
}

/// Distance and barycentrics, in the shader's order of operations.
fn intersect(triangle: &BvhTriangleBlock, origin: Vec3, direction: Vec3, limit: f32) -> Option<(f32, [f32; 2])> {
    let three = |[x, y, z, _]: [f32; 4]| Vec3::new(x, y, z);
    let (edge1, edge2) = (three(triangle.edge1), three(triangle.edge2));
    let p = direction.cross(edge2);
    let determinant = edge1.dot(p);
    if determinant == 0.0 {
        return None;
    }
    let inverse = 1.0 / determinant;
    let offset = origin - three(triangle.corner);
    let u = offset.dot(p) * inverse;
    let q = offset.cross(edge1);
    let v = direction.dot(q) * inverse;
    let distance = edge2.dot(q) * inverse;
    let inside = u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > 0.0 && distance < limit;
    inside.then_some((distance, [u, v]))
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use crate::scene::Mesh;
    use glam::{Mat4, Vec3A};
    use proptest::prelude::*;

    /// A field of small triangles around the origin.
    pub fn field(seed: u32, count: u32) -> Scene {
        let number = |index: u32, axis: u32| sobol_burley::sample(index, axis, seed) * 2.0 - 1.0;
        let mut mesh = Mesh::default();
        for triangle in 0..count {
            let center = Vec3::new(number(triangle, 0), number(triangle, 1), number(triangle, 2));
            for corner in 0..3 {
                let around = Vec3::new(
                    number(3 * triangle + corner, 3),
                    number(3 * triangle + corner, 4),
                    number(3 * triangle + corner, 5),
                );
                mesh.indices.push(mesh.positions.len() as u32);
                mesh.positions.push(center + 0.2 * around);
            }
        }
        let draws = vec![Draw { mesh: 0, world_from_object: Mat4::from_translation(Vec3::new(0.5, 0.0, 0.0)) }];
        Scene { meshes: vec![mesh], draws, materials: vec![Material::default()], ..Scene::default() }
    }

    proptest! {
        #[test]
        fn a_walk_meets_what_trying_every_triangle_meets(seed in 0u32..50, ray in 0u32..200) {
            let bvh = Bvh::build(&field(seed, 60)).unwrap();
            let number = |axis: u32| sobol_burley::sample(ray, axis, seed + 1000) * 2.0 - 1.0;
            let origin = 3.0 * Vec3::new(number(0), number(1), number(2));
            let direction = (Vec3::new(number(3), number(4), number(5)) - origin).normalize();
            let every = (0..bvh.triangles.len())
                .filter_map(|index| intersect(&bvh.triangles[index], origin, direction, 100.0))
                .map(|(distance, _)| distance)
                .fold(f32::INFINITY, f32::min);
            let hit = bvh.closest_hit(origin, direction, 100.0, |_| true);
            prop_assert_eq!(hit.map_or(f32::INFINITY, |hit| hit.distance), every);
            prop_assert_eq!(bvh.occluded(origin, direction, 100.0), every.is_finite());
        }
    }

    #[test]
    fn coincident_triangles_make_no_deep_tree() {
        let mut scene = field(1, 60);
        let mesh = &mut scene.meshes[0];
        mesh.indices = [0, 1, 2].repeat(5000).into_iter().chain(0..180).collect();
        let bvh = Bvh::build(&scene).unwrap();
        let inside = scene.meshes[0].triangle(0).into_iter().sum::<Vec3>() / 3.0 + Vec3::new(0.5, 0.0, 0.0);
        let direction = (inside - Vec3::splat(5.0)).normalize();
        assert!(bvh.occluded(Vec3::splat(5.0), direction, 100.0));
        let mut sources: Vec<u32> = bvh.sources.iter().map(|source| source.triangle).collect();
        sources.sort_unstable();
        assert!(sources.into_iter().eq(0..5060));
    }

    #[test]
    fn halving_meets_what_the_builder_meets() {
        let scene = field(3, 500);
        let bvh = Bvh::build(&scene).unwrap();
        let corners: Vec<Triangle> = bvh.triangles.iter().map(triangle_of).collect();
        let (nodes, order) = boxes::halved(&corners, &[]);
        let triangles = order.iter().map(|index| bvh.triangles[*index as usize]).collect();
        let other = Bvh { nodes, triangles, closing: Vec::new(), sources: Vec::new() };
        for ray in 0..200 {
            let number = |axis: u32| sobol_burley::sample(ray, axis, 9) * 2.0 - 1.0;
            let origin = 3.0 * Vec3::new(number(0), number(1), number(2));
            let direction = Vec3::new(number(3), number(4), number(5)) - origin;
            let hit = |bvh: &Bvh| bvh.closest_hit(origin, direction, 100.0, |_| true).map(|hit| hit.distance);
            assert_eq!(hit(&other), hit(&bvh), "{ray}");
        }
    }

    fn triangle_of(block: &BvhTriangleBlock) -> Triangle {
        let three = |[x, y, z, _]: [f32; 4]| Vec3A::new(x, y, z);
        let v0 = three(block.corner);
        Triangle { v0, v1: v0 + three(block.edge1), v2: v0 + three(block.edge2) }
    }

    #[test]
    fn an_empty_tree_stops_nothing() {
        assert!(!Bvh::empty().occluded(Vec3::ZERO, Vec3::X, 1e30));
        assert!(Bvh::build(&Scene::default()).unwrap().sources.is_empty());
    }
}
