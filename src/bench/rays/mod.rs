//! `bench rays`: how many rays a second the walks of the tree do on the device, beside a walk of the same tree on the host's
//! threads, the same rays in turn. Shader: glsl/bench/rays.comp.
//!
//! Every walk is held against the host's: their hits may differ where a ray meets an edge, and nowhere else. Of triangles
//! that a ray meets at one distance, such as those of a shared edge, the device takes the first in the tree's order and the
//! host the first that it finds.

pub mod cast;
mod host;
mod query;
pub mod report;

use super::rounds::{self, Length, Probe, Samples, last_pass};
use crate::bvh::Bvh;
use crate::bvh::flat::flattened;
use crate::bvh::nodes::{Nodes, Walk};
use crate::error::{Error, Result};
use crate::gpu::commands::{Submits, Traffic};
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::recorded::Recorded;
use crate::gpu::shader::bench::rays::COMP_VARIANTS;
use crate::gpu::shader::bench::rays::THREADS;
use crate::gpu::shader::bvh_trace::RAY_SHADOW;
use crate::gpu::shader::structs::{RayBlock, RaysParams};
use crate::gpu::shader::variant;
use crate::gpu::structure::STORAGE;
use crate::gpu::{Access, Bound, Buffer, Commands, Gpu, readback, upload};
use crate::memory::kinds::Use;
use crate::resident::structure::{self, SceneStructure};
use crate::scene::Scene;
use crate::settings::Values;
use ash::vk;
use cast::Rays;
use host::HostWalk;
pub use query::Query;
use std::rc::Rc;
use std::sync::Arc;

/// Ledger group of its buffers.
const GROUP: &str = "bench";

/// A way of walking in order that is measured.
pub struct Variant {
    /// Label that distinguishes it from the others in tables; empty where there are none.
    pub label: String,
    /// Values of the settings in `settings::TREE`.
    pub values: Values,
}

/// The walks of the device.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WalkKind {
    /// The walk of shadow rays.
    Plain,
    /// The walk of path tracing: an index into `Request::variants`.
    Ordered(usize),
    /// The driver's own, by ray queries, where the device has them.
    Query,
}

/// What a walk goes through.
#[derive(Clone, Copy, Debug)]
pub struct Size {
    pub node_count: usize,
    pub node_bytes: u64,
    /// What `--stack` came to; empty where a walk has none, and where the driver walks.
    pub stack: &'static str,
    /// Nodes that a ray has room to let wait.
    pub stack_entries: u32,
}

/// One walk on the device, and what came of it.
pub struct Measured {
    pub rays: Rays,
    pub query: Query,
    pub kind: WalkKind,
    pub size: Size,
    pub device: Samples,
    /// The host's walk for the same query.
    pub host: Samples,
    /// Times of the plain walk of the same rays.
    pub plain: Samples,
    pub hit_count: usize,
    /// BLAKE3, in hexadecimal, of what each ray met.
    pub hits_hash: String,
    /// Rays for which the host has another answer, not counting triangles at the same distance.
    pub differing: usize,
}

impl Measured {
    /// Name in rows.
    pub fn walk(&self) -> &'static str {
        match self.kind {
            WalkKind::Plain => "plain",
            WalkKind::Ordered(_) => "ordered",
            WalkKind::Query => "query",
        }
    }
}

/// What is asked for.
pub struct Request {
    pub ray_count: u32,
    pub seed: u64,
    /// Rounds, at least one.
    pub repeat: usize,
    /// Ways of walking in order, at least one.
    pub variants: Vec<Variant>,
}

/// Measures every walk with every set of rays. `progress`: as of `rounds::run`.
///
/// Errors: nothing to meet, or a stack that this device has no room for (exit code 2); memory, or the device fails (4);
/// interrupted (130).
pub fn run(
    gpu: &Arc<Gpu>,
    scene: &Scene,
    request: &Request,
    progress: &mut dyn FnMut(usize, usize),
) -> Result<Vec<Measured>> {
    let bvh = Bvh::whole(scene)?;
    if bvh.sources.is_empty() {
        return Err(Error::request(format!("{}: there is no triangle that rays could hit", scene.name)));
    }
    let triangles = Rc::new(filled(gpu, "triangles", &bvh.triangles)?);
    let plain = Rc::new(Tree::plain(gpu, &bvh, &triangles)?);
    let ordered = request.variants.iter().map(|variant| {
        let nodes = Nodes::new(&bvh, Walk::from_values(&variant.values), THREADS, &gpu.caps.limits)?;
        Ok(Rc::new(Tree::ordered(gpu, &nodes, &triangles)?))
    });
    let ordered: Vec<Rc<Tree>> = ordered.collect::<Result<_>>()?;
    let queried = gpu.caps.features.ray_query.then(|| Tree::queried(gpu, &bvh, &triangles).map(Rc::new)).transpose()?;
    let (mut device, mut host) = (Vec::new(), Vec::new());
    for rays in Rays::ALL {
        let cast: Rc<[RayBlock]> = rays.cast(scene, &bvh, request.ray_count, request.seed).into();
        let cast_gpu = Rc::new(filled(gpu, "rays", &cast)?);
        let mut walk = |kind: WalkKind, tree: &Rc<Tree>, query| {
            device.push((rays, kind, DeviceWalk::new(gpu, tree, &cast_gpu, request.ray_count, query)?));
            Result::Ok(())
        };
        walk(WalkKind::Plain, &plain, Query::Any)?;
        let ordered = ordered.iter().enumerate().map(|(index, tree)| (WalkKind::Ordered(index), tree));
        for (kind, tree) in ordered.chain(queried.iter().map(|tree| (WalkKind::Query, tree))) {
            walk(kind, tree, Query::Any)?;
            walk(kind, tree, Query::Nearest)?;
        }
        host.extend([Query::Any, Query::Nearest].map(|query| (rays, HostWalk::new(&bvh, cast.clone(), query))));
    }
    let mut probes: Vec<&dyn Probe> = device.iter().map(|(_, _, walk)| walk as &dyn Probe).collect();
    probes.extend(host.iter().map(|(_, walk)| walk as &dyn Probe));
    let samples = rounds::run(&probes, Length { least: request.repeat, until_interval: None }, progress)?;
    let mut all = Vec::new();
    for (index, (rays, kind, walk)) in device.iter().enumerate() {
        let is_same = |(other, of): &(Rays, HostWalk<'_>)| other == rays && of.query == walk.query;
        let at = host.iter().position(is_same).expect("the host walks for every query");
        let plain =
            device.iter().position(|(other, of, _)| other == rays && *of == WalkKind::Plain).expect("it is a walk");
        let (found, host_walk) = (walk.hits(gpu)?, &host[at].1);
        all.push(Measured {
            rays: *rays,
            query: walk.query,
            kind: *kind,
            size: walk.tree.size,
            device: samples[index].clone(),
            host: samples[device.len() + at].clone(),
            plain: samples[plain].clone(),
            hits_hash: blake3::hash(bytemuck::cast_slice(&found)).to_hex().to_string(),
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
    pipeline: ComputePipeline,
    nodes: Walked,
    triangles: Rc<Buffer>,
    size: Size,
}

/// What holds the boxes.
enum Walked {
    Nodes(Buffer),
    Structure(Box<SceneStructure>),
}

impl Tree {
    fn plain(gpu: &Arc<Gpu>, bvh: &Bvh, triangles: &Rc<Buffer>) -> Result<Self> {
        let nodes = filled(gpu, "nodes", &flattened(&bvh.nodes))?;
        let pipeline = ComputePipeline::new(gpu, variant(COMP_VARIANTS, &["plain"]), &[("RAY_OFFSET", 0)])?;
        let size = Size { node_count: bvh.nodes.len(), node_bytes: nodes.bytes, stack: "", stack_entries: 0 };
        Ok(Self { pipeline, nodes: Walked::Nodes(nodes), triangles: triangles.clone(), size })
    }

    fn ordered(gpu: &Arc<Gpu>, nodes: &Nodes, triangles: &Rc<Buffer>) -> Result<Self> {
        let shader = variant(COMP_VARIANTS, &[nodes.variant()]);
        let pipeline = ComputePipeline::new(gpu, shader, &nodes.constants())?;
        let (node_count, stack, stack_entries) = (nodes.count(), nodes.stack.name(), nodes.stack_entries());
        let nodes = filled(gpu, "nodes", nodes.bytes())?;
        let size = Size { node_count, node_bytes: nodes.bytes, stack, stack_entries };
        Ok(Self { pipeline, nodes: Walked::Nodes(nodes), triangles: triangles.clone(), size })
    }

    /// The driver's structure over the same triangles.
    fn queried(gpu: &Arc<Gpu>, bvh: &Bvh, triangles: &Rc<Buffer>) -> Result<Self> {
        let over = structure::over(bvh, true);
        let buffer = |at: usize| {
            let (name, bytes) = (format!("bench.rays.{}", structure::BUFFERS[at]), over[at].sizes(gpu).structure_bytes);
            Buffer::new(gpu, &name, GROUP, bytes, STORAGE, Use::Device)
        };
        let buffers = [buffer(0)?, buffer(1)?];
        let node_bytes = buffers.iter().map(|buffer| buffer.bytes).sum();
        let built = SceneStructure::build(gpu, bvh, over, buffers)?;
        let pipeline = ComputePipeline::new(gpu, variant(COMP_VARIANTS, &["query"]), &[])?;
        let size = Size { node_count: 0, node_bytes, stack: "", stack_entries: 0 };
        Ok(Self { pipeline, nodes: Walked::Structure(Box::new(built)), triangles: triangles.clone(), size })
    }
}

/// A walk of all rays, recorded.
struct DeviceWalk {
    // Dropped before what it uses.
    recorded: Recorded,
    hits: Buffer,
    query: Query,
    _rays: Rc<Buffer>,
    tree: Rc<Tree>,
}

impl DeviceWalk {
    fn new(gpu: &Arc<Gpu>, tree: &Rc<Tree>, rays: &Rc<Buffer>, ray_count: u32, query: Query) -> Result<Self> {
        let hits = buffer(gpu, "hits", 4 * u64::from(ray_count))?;
        let mut cmd = Commands::begin(gpu, "bench", Submits::PerPass)?;
        let traffic = Traffic {
            read_bytes: Some(rays.bytes),
            written_bytes: Some(hits.bytes),
            invocations: Some(u64::from(ray_count)),
        };
        cmd.pass("bench.rays", traffic, |cmd| {
            cmd.barriers([hits.discard(Access::ComputeWrite)]);
            let params = RaysParams { ray_count, kind: if query == Query::Any { RAY_SHADOW } else { 0 } };
            let walked = match &tree.nodes {
                Walked::Nodes(nodes) => ("BvhNodes", Bound::Buffer(nodes)),
                Walked::Structure(structure) => structure.bound(),
            };
            let bound = [
                walked,
                ("BvhTriangles", Bound::Buffer(&tree.triangles)),
                ("Rays", Bound::Buffer(rays)),
                ("Hits", Bound::Buffer(&hits)),
            ];
            let groups = tree.pipeline.groups([ray_count, 1, 1]);
            cmd.dispatch(&tree.pipeline, bytemuck::bytes_of(&params), &bound, groups)
        })?;
        let recorded = cmd.finish()?;
        Ok(Self { recorded, hits, query, _rays: rays.clone(), tree: tree.clone() })
    }

    /// What the last run found, a word a ray.
    fn hits(&self, gpu: &Arc<Gpu>) -> Result<Vec<u32>> {
        let bytes = readback::buffer(gpu, &self.hits, self.hits.bytes, Access::ComputeWrite)?;
        Ok(bytemuck::pod_collect_to_vec(&bytes))
    }
}

impl Probe for DeviceWalk {
    fn measure(&self) -> Result<Vec<f64>> {
        last_pass(&self.recorded)
    }
}
