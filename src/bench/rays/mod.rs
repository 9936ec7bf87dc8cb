//! `bench rays`: how many rays a second the walks of the tree do on the device, beside a walk of the same tree on the host's
//! threads, the same rays in turn. Shader: glsl/bench/rays.comp.
//!
//! Every walk is held against the host's: their hits may differ where a ray meets an edge, and nowhere else. Of triangles
//! that a ray meets at one distance, such as those of a shared edge, each walk takes the first that it comes to.

pub mod cast;
mod host;
pub mod report;

use super::rounds::{self, Probe, Samples};
use crate::bvh::Bvh;
use crate::error::{Error, Result};
use crate::gpu::commands::{Submits, Traffic};
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::recorded::Recorded;
use crate::gpu::shader::bench::rays::COMP_VARIANTS;
use crate::gpu::shader::structs::{RayBlock, RaysParams};
use crate::gpu::shader::variant;
use crate::gpu::structure::STORAGE;
use crate::gpu::{Access, Bound, Buffer, Commands, Gpu, readback, upload};
use crate::memory::kinds::Use;
use crate::resident::structure::{self, SceneStructure};
use crate::scene::Scene;
use ash::vk;
use cast::Rays;
use host::HostWalk;
use std::rc::Rc;
use std::sync::Arc;

/// Ledger group of its buffers.
const GROUP: &str = "bench";
/// bvh_trace.glsl's RAY_SHADOW.
const RAY_SHADOW: u32 = 1;

/// What is asked of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Query {
    /// Whether anything is in the way.
    Any,
    /// Which triangle comes first.
    Nearest,
}

impl Query {
    /// As rows have it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Any => "any",
            Self::Nearest => "nearest",
        }
    }
}

/// The driver's own, by ray queries: there where the device has them.
const QUERY: &str = "query";
/// A walk of the device, with what it can be asked.
const WALKS: [(&str, Query); 5] = [
    ("plain", Query::Any),
    ("ordered", Query::Any),
    ("ordered", Query::Nearest),
    (QUERY, Query::Any),
    (QUERY, Query::Nearest),
];

/// One walk on the device, and what came of it.
pub struct Measured {
    pub rays: Rays,
    pub query: Query,
    /// `plain`, `ordered` or `query`: the shader's WALK.
    pub walk: &'static str,
    pub device: Samples,
    /// The host's walk for the same query.
    pub host: Samples,
    /// Of the plain walk of the same rays.
    pub plain: Samples,
    pub hit_count: usize,
    /// Rays that the host answers otherwise, but for triangles at the same distance.
    pub differing: usize,
}

/// What is asked for.
pub struct Request {
    pub ray_count: u32,
    pub seed: u64,
    /// Rounds, at least one.
    pub repeat: usize,
}

/// Measures every walk with every set of rays. `progress`: as of `rounds::run`.
///
/// Errors: nothing to meet (exit code 2); memory, or the device fails (4); interrupted (130).
pub fn run(
    gpu: &Arc<Gpu>,
    scene: &Scene,
    request: &Request,
    progress: &mut dyn FnMut(usize, usize),
) -> Result<Vec<Measured>> {
    let bvh = Bvh::whole(scene)?;
    if bvh.sources.is_empty() {
        return Err(Error::request(format!("{}: there is no triangle that rays could meet", scene.name)));
    }
    let tree = Tree::new(gpu, &bvh)?;
    let (mut device, mut host) = (Vec::new(), Vec::new());
    for rays in Rays::ALL {
        let cast: Rc<[RayBlock]> = rays.cast(scene, &bvh, request.ray_count, request.seed).into();
        for (walk, query) in WALKS.into_iter().filter(|(walk, _)| *walk != QUERY || tree.structure.is_some()) {
            device.push((rays, DeviceWalk::new(gpu, &tree, &cast, walk, query)?));
        }
        host.extend([Query::Any, Query::Nearest].map(|query| (rays, HostWalk::new(&bvh, cast.clone(), query))));
    }
    let mut probes: Vec<&dyn Probe> = device.iter().map(|(_, walk)| walk as &dyn Probe).collect();
    probes.extend(host.iter().map(|(_, walk)| walk as &dyn Probe));
    let samples = rounds::run(&probes, request.repeat, progress)?;
    let mut all = Vec::new();
    for (index, (rays, walk)) in device.iter().enumerate() {
        let is_same = |(other, of): &(Rays, HostWalk<'_>)| other == rays && of.query == walk.query;
        let at = host.iter().position(is_same).expect("the host walks for every query");
        let plain = device.iter().position(|(other, of)| other == rays && of.walk == "plain").expect("it is a walk");
        let (found, host_walk) = (walk.hits(gpu)?, &host[at].1);
        all.push(Measured {
            rays: *rays,
            query: walk.query,
            walk: walk.walk,
            device: samples[index].clone(),
            host: samples[device.len() + at].clone(),
            plain: samples[plain].clone(),
            hit_count: found.iter().filter(|hit| **hit > 0).count(),
            differing: host_walk.differing(&found),
        });
    }
    Ok(all)
}

fn buffer(gpu: &Arc<Gpu>, what: &str, bytes: u64) -> Result<Buffer> {
    let flags =
        vk::BufferUsageFlags::STORAGE_BUFFER | vk::BufferUsageFlags::TRANSFER_SRC | vk::BufferUsageFlags::TRANSFER_DST;
    let limit = gpu.caps.limits.max_storage_buffer_range_bytes;
    if bytes > limit {
        return Err(Error::memory(format!("bench.rays.{what}: {bytes} bytes, and this device binds {limit}"))
            .note("fewer --rays, or a scene of fewer triangles"));
    }
    Buffer::new(gpu, &format!("bench.rays.{what}"), GROUP, bytes, flags, Use::Device)
}

fn filled<T: bytemuck::Pod>(gpu: &Arc<Gpu>, what: &str, values: &[T]) -> Result<Buffer> {
    let buffer = buffer(gpu, what, size_of_val(values) as u64)?;
    upload::buffer(gpu, &buffer, bytemuck::cast_slice(values), Access::ComputeRead)?;
    Ok(buffer)
}

struct Tree {
    nodes: Buffer,
    triangles: Buffer,
    /// None: the device has no ray queries.
    structure: Option<SceneStructure>,
}

impl Tree {
    fn new(gpu: &Arc<Gpu>, bvh: &Bvh) -> Result<Rc<Self>> {
        let structure = gpu.caps.features.ray_query.then(|| {
            let over = structure::over(bvh, true);
            let buffer = |at: usize| {
                let (name, bytes) =
                    (format!("bench.rays.{}", structure::BUFFERS[at]), over[at].sizes(gpu).structure_bytes);
                Buffer::new(gpu, &name, GROUP, bytes, STORAGE, Use::Device)
            };
            SceneStructure::build(gpu, bvh, over, [buffer(0)?, buffer(1)?])
        });
        Ok(Rc::new(Self {
            structure: structure.transpose()?,
            nodes: filled(gpu, "nodes", &bvh.nodes)?,
            triangles: filled(gpu, "triangles", &bvh.triangles)?,
        }))
    }
}

/// A walk of all rays, recorded.
struct DeviceWalk {
    // Dropped before what it uses.
    recorded: Recorded,
    hits: Buffer,
    walk: &'static str,
    query: Query,
    _rays: Buffer,
    _pipeline: ComputePipeline,
    _tree: Rc<Tree>,
}

impl DeviceWalk {
    fn new(gpu: &Arc<Gpu>, tree: &Rc<Tree>, rays: &[RayBlock], walk: &'static str, query: Query) -> Result<Self> {
        let pipeline = ComputePipeline::new(gpu, variant(COMP_VARIANTS, &[walk]), &[("RAY_OFFSET", 0)])?;
        let hits = buffer(gpu, "hits", 4 * rays.len() as u64)?;
        let ray_count = rays.len() as u32;
        let rays = filled(gpu, "rays", rays)?;
        let mut cmd = Commands::begin(gpu, "bench", Submits::PerPass)?;
        let traffic =
            Traffic { read_bytes: rays.bytes, written_bytes: hits.bytes, invocations: Some(u64::from(ray_count)) };
        cmd.pass("bench.rays", traffic, |cmd| {
            cmd.barriers([hits.discard(Access::ComputeWrite)]);
            let params = RaysParams { ray_count, kind: if query == Query::Any { RAY_SHADOW } else { 0 } };
            let walked = match &tree.structure {
                Some(structure) if walk == QUERY => structure.bound(),
                _ => ("BvhNodes", Bound::Buffer(&tree.nodes)),
            };
            let bound = [
                walked,
                ("BvhTriangles", Bound::Buffer(&tree.triangles)),
                ("Rays", Bound::Buffer(&rays)),
                ("Hits", Bound::Buffer(&hits)),
            ];
            let groups = pipeline.groups([ray_count, 1, 1]);
            cmd.dispatch(&pipeline, bytemuck::bytes_of(&params), &bound, groups)
        })?;
        let recorded = cmd.finish()?;
        Ok(Self { recorded, hits, walk, query, _rays: rays, _pipeline: pipeline, _tree: tree.clone() })
    }

    /// What the last run found, a word a ray.
    fn hits(&self, gpu: &Arc<Gpu>) -> Result<Vec<u32>> {
        let bytes = readback::buffer(gpu, &self.hits, self.hits.bytes, Access::ComputeWrite)?;
        Ok(bytemuck::pod_collect_to_vec(&bytes))
    }
}

impl Probe for DeviceWalk {
    fn measure(&self) -> Result<Vec<f64>> {
        let frame = self.recorded.run()?;
        let pass = frame.passes.first().expect("one pass");
        Ok(vec![pass.wall_ns.expect("a submit a pass has a wall time a pass") as f64 / 1e6])
    }
}
