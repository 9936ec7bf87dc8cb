//! The same rays through the same tree on the host, on as many threads as it has.

use super::Query;
use crate::bench::rounds::Probe;
use crate::bvh::Bvh;
use crate::error::Result;
use crate::gpu::shader::structs::RayBlock;
use glam::Vec3;
use rayon::prelude::*;
use std::hint::black_box;
use std::rc::Rc;
use std::time::Instant;

/// Distances that differ by less than this part of themselves are the same: some steps of a float.
const TIE: f32 = 1e-5;
/// Rays that a thread takes at once.
const CHUNK: usize = 1024;

/// A walk of all rays.
pub struct HostWalk<'a> {
    bvh: &'a Bvh,
    rays: Rc<[RayBlock]>,
    pub query: Query,
}

impl<'a> HostWalk<'a> {
    pub fn new(bvh: &'a Bvh, rays: Rc<[RayBlock]>, query: Query) -> Self {
        Self { bvh, rays, query }
    }

    /// What each ray meets, as the shader writes it.
    pub fn hits(&self) -> Vec<u32> {
        let (bvh, query) = (self.bvh, self.query);
        let one = |ray: &RayBlock| {
            let (origin, direction, limit) = parts(ray);
            match query {
                Query::Any => u32::from(bvh.occluded(origin, direction, limit)),
                Query::Nearest => {
                    bvh.closest_hit(origin, direction, limit, |_| true).map_or(0, |hit| hit.triangle as u32 + 1)
                }
            }
        };
        self.rays.par_chunks(CHUNK).flat_map_iter(|rays| rays.iter().map(one)).collect()
    }

    /// Rays for which `found` is neither what this walk meets nor, for the nearest, a triangle at the same distance.
    pub fn differing(&self, found: &[u32]) -> usize {
        let expected = self.hits();
        let is_tie = |ray: &RayBlock, found: u32, expected: u32| {
            if self.query == Query::Any || found == 0 || expected == 0 {
                return false;
            }
            let (origin, direction, limit) = parts(ray);
            let distance = |hit: u32| {
                let hit = self.bvh.hit_of(hit as usize - 1, origin, direction, limit);
                hit.map_or(f32::INFINITY, |hit| hit.distance)
            };
            let [found, expected] = [found, expected].map(distance);
            (found - expected).abs() <= TIE * expected
        };
        let all = self.rays.iter().zip(found.iter().zip(&expected));
        all.filter(|(ray, (found, expected))| found != expected && !is_tie(ray, **found, **expected)).count()
    }
}

/// Origin, direction, and how far it reaches.
fn parts(ray: &RayBlock) -> (Vec3, Vec3, f32) {
    let [x, y, z, limit] = ray.origin_limit;
    let [dx, dy, dz, _] = ray.direction;
    (Vec3::new(x, y, z), Vec3::new(dx, dy, dz), limit)
}

impl Probe for HostWalk<'_> {
    fn measure(&self) -> Result<Vec<f64>> {
        let started = Instant::now();
        black_box(self.hits());
        Ok(vec![started.elapsed().as_secs_f64() * 1e3])
    }
}
