//! The rays that `bench rays` casts, seeded: from points on the scene's triangles, in the order in which the tree has them.

use crate::bvh::Bvh;
use crate::gpu::shader::structs::RayBlock;
use crate::sampling::pcg::Pcg32;
use crate::scene::Scene;
use glam::Vec3;

/// Where rays go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rays {
    /// From random points into random directions above their surface: what paths do after a surface.
    Incoherent,
    /// From neighbouring points towards one point above the middle of the scene: what shadow rays of one light do.
    Coherent,
}

/// Rays begin this part of the scene's diagonal off their surface.
const OFFSET: f32 = 1e-4;
/// Coherent rays end at the middle of the box, this part of the way up its height.
const HEIGHT: f32 = 0.9;

impl Rays {
    pub const ALL: [Self; 2] = [Self::Incoherent, Self::Coherent];

    /// Name in rows.
    pub fn name(self) -> &'static str {
        match self {
            Self::Incoherent => "incoherent",
            Self::Coherent => "coherent",
        }
    }

    /// `count` rays over the triangles of `bvh`, which has at least one.
    pub fn cast(self, scene: &Scene, bvh: &Bvh, count: u32, seed: u64) -> Vec<RayBlock> {
        let (bounds, triangle_count) = (scene.bounds(), bvh.triangles.len() as u64);
        let diagonal = bounds.diagonal();
        let [low, high] = [bounds.min, bounds.max];
        let light = bounds.center().with_y(low.y + HEIGHT * (high.y - low.y));
        let mut random = Pcg32::new(seed, self as u64);
        (0..count)
            .map(|index| {
                let triangle = match self {
                    Self::Incoherent => random.below(triangle_count as u32) as usize,
                    Self::Coherent => (u64::from(index) * triangle_count / u64::from(count)) as usize,
                };
                let (point, normal) = point_on(bvh, triangle, [random.unit(), random.unit()]);
                let (direction, limit) = match self {
                    Self::Incoherent => (above(normal, &mut random), 2.0 * diagonal),
                    Self::Coherent => {
                        let away = light - point;
                        (away.normalize_or(Vec3::Y), away.length() - OFFSET * diagonal)
                    }
                };
                let side = if normal.dot(direction) < 0.0 { -normal } else { normal };
                RayBlock {
                    origin_limit: (point + side * OFFSET * diagonal).extend(limit).to_array(),
                    direction: direction.extend(0.0).to_array(),
                }
            })
            .collect()
    }
}

/// An even point of a triangle (of two unit numbers), and its unit normal; up where it has no area.
fn point_on(bvh: &Bvh, triangle: usize, [u, v]: [f32; 2]) -> (Vec3, Vec3) {
    let three = |[x, y, z, _]: [f32; 4]| Vec3::new(x, y, z);
    let block = &bvh.triangles[triangle];
    let (edge1, edge2) = (three(block.edge1), three(block.edge2));
    let root = u.sqrt();
    let point = three(block.corner) + edge1 * (root * (1.0 - v)) + edge2 * (root * v);
    (point, edge1.cross(edge2).normalize_or(Vec3::Y))
}

/// A unit direction, even over the half of the sphere around `normal`.
fn above(normal: Vec3, random: &mut Pcg32) -> Vec3 {
    let (z, turn) = (2.0 * random.unit() - 1.0, std::f32::consts::TAU * random.unit());
    let direction = Vec3::new((1.0 - z * z).sqrt() * turn.cos(), (1.0 - z * z).sqrt() * turn.sin(), z);
    if direction.dot(normal) < 0.0 { -direction } else { direction }
}
