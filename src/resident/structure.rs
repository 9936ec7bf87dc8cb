//! The triangles of a tree in structures of the driver's own, for ray queries (glsl/bvh_query.glsl): a bottom one over all of
//! them in the order of the tree's leaves, so that a primitive is the triangle that every table of the shader has in that
//! place, and a top one with a single instance of it. They are built once, before the first frame; what the build reads
//! and its scratch are gone by then.
//!
//! Why one geometry: where alpha decides about some triangles, rays ask the shader about all of them. Two geometries would
//! spare it the opaque ones, and number their triangles anew.

use crate::bvh::Bvh;
use crate::error::Result;
use crate::gpu::commands::Submits;
use crate::gpu::shader::structs::BvhTriangleBlock;
use crate::gpu::structure::{
    INPUT, INPUT_ALIGNMENT_BYTES, INSTANCE_BYTES, Over, SCRATCH, STORAGE, TRIANGLE_BYTES, input_start,
};
use crate::gpu::{Access, Bound, Buffer, Commands, Gpu, Structure, upload};
use crate::memory::kinds::Use;
use crate::plan::{Plan, Requirements, Shape};
use std::sync::Arc;

/// Names of the buffers after their owner's: the bottom structure's and the top one's.
pub const BUFFERS: [&str; 2] = ["structure.bottom", "structure.top"];
/// Name of the top one in GLSL.
const STRUCTURE: &str = "structure";

/// What the two structures over a tree are over. `is_opaque`: alpha decides about none of its triangles.
pub fn over(bvh: &Bvh, is_opaque: bool) -> [Over; 2] {
    // A tree holds at most 2^26, and Vulkan promises room for 2^29 - 1.
    [Over::Triangles { count: bvh.triangles.len() as u32, is_opaque }, Over::Instance]
}

/// Plans the buffers that the structures lie in, as resources of `owner`.
///
/// Errors: without a device, of a driver whose sizes are not known (exit code 2).
pub fn plan(plan: &mut Plan, owner: &str, over: [Over; 2], requirements: Requirements<'_>) -> Result<()> {
    for (name, over) in BUFFERS.into_iter().zip(over) {
        let bytes = requirements.structure_bytes(over)?;
        plan.push("bvh", format!("{owner}.{name}"), Shape::Buffer { bytes, flags: STORAGE, usage: Use::Device });
    }
    Ok(())
}

/// The scene's acceleration structures, through which rays are traced.
pub struct SceneStructure {
    // Dropped first: it refers to the other.
    top: Structure,
    _bottom: Structure,
}

impl SceneStructure {
    /// Builds both in `buffers`, which were made as `plan` says.
    ///
    /// Errors: memory for the build, or the device fails (exit code 4).
    pub fn build(gpu: &Arc<Gpu>, bvh: &Bvh, over: [Over; 2], buffers: [Buffer; 2]) -> Result<Self> {
        let scratch_bytes = over.map(|over| over.sizes(gpu).scratch_bytes);
        let [bottom, top] = buffers;
        let bottom = Structure::new(gpu, bottom, over[0])?;
        let mut top = Structure::new(gpu, top, over[1])?;
        let transient = |what: &str, bytes, flags, usage| {
            Buffer::new(gpu, &format!("{}.{what}", bottom.buffer.name), upload::GROUP, bytes, flags, usage)
        };
        let bytes = INPUT_ALIGNMENT_BYTES + INSTANCE_BYTES + TRIANGLE_BYTES * bvh.triangles.len() as u64;
        let mut input = transient("input", bytes, INPUT, Use::Upload)?;
        let instance_at = input_start(&input);
        let triangles_at = instance_at + INSTANCE_BYTES;
        let (instance, triangles) = input.mapped_mut()[instance_at as usize..].split_at_mut(INSTANCE_BYTES as usize);
        bottom.write_instance(instance);
        for (target, block) in triangles.chunks_exact_mut(TRIANGLE_BYTES as usize).zip(&bvh.triangles) {
            target.copy_from_slice(bytemuck::bytes_of(&corners(block)));
        }
        let scratch = transient("scratch", scratch_bytes[0].max(scratch_bytes[1]), SCRATCH, Use::Device)?;
        let mut cmd = Commands::begin(gpu, "structure", Submits::One)?;
        let begin = [&bottom.buffer, &top.buffer, &scratch].map(|buffer| buffer.discard(Access::StructureWrite));
        cmd.barriers(begin);
        cmd.build_structure(&bottom, (&input, triangles_at), &scratch);
        cmd.barriers([
            bottom.buffer.from(Access::StructureWrite).to(Access::StructureRead),
            scratch.from(Access::StructureWrite).to(Access::StructureWrite),
        ]);
        cmd.build_structure(&top, (&input, instance_at), &scratch);
        cmd.barriers([
            bottom.buffer.from(Access::StructureRead).to(Access::ComputeTrace),
            top.buffer.from(Access::StructureWrite).to(Access::ComputeTrace),
        ]);
        cmd.finish()?.run()?;
        top.beneath = Some(bottom.buffer.name.clone());
        Ok(Self { top, _bottom: bottom })
    }

    /// By its name in GLSL.
    pub fn bound(&self) -> (&'static str, Bound<'_>) {
        (STRUCTURE, Bound::Structure(&self.top))
    }
}

/// Corners of a triangle as the walks of the tree have them.
fn corners(block: &BvhTriangleBlock) -> [[f32; 3]; 3] {
    let corner = |edge: [f32; 4]| [0, 1, 2].map(|axis| block.corner[axis] + edge[axis]);
    [corner([0.0; 4]), corner(block.edge1), corner(block.edge2)]
}
