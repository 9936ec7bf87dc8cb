//! Range of each draw among all triangles, for shaders that have only a triangle's number and not its draw. Shaders'
//! half: ranges.glsl.

use super::primitives::Primitives;
use crate::error::Result;
use crate::gpu::shader::structs::DrawnRangeBlock;
use crate::gpu::{Access, AccessSet, Buffer, Gpu, upload};
use crate::plan::{Plan, Resources};
use crate::resident::{DrawCall, SceneGpu};
use crate::techniques::deep_shading::resources::full;
use bytemuck::Zeroable;
use std::sync::Arc;

/// Ranges by the ids of triangles.
pub const BY_ID: &str = "draws.by_id";

/// The buffer of ranges by ids, filled.
///
/// Errors: memory for the upload (exit code 4).
pub fn by_id(gpu: &Arc<Gpu>, resources: &mut Resources, scene: &SceneGpu, primitives: &Primitives) -> Result<Buffer> {
    let mut calls = scene.calls.clone();
    calls.sort_by_key(|call| call.draw);
    let buffer = resources.buffer(&full(BY_ID));
    let id = |draw, first_index| primitives.id(draw, first_index);
    write(gpu, &buffer, scene, primitives, calls.iter(), id, Access::ComputeRead)?;
    Ok(buffer)
}

/// Plans a block for each of `draws`. `name`: the buffer's full one.
pub fn plan(plan: &mut Plan, name: String, draws: u64) {
    plan.buffer("scene.geometry", name, draws * size_of::<DrawnRangeBlock>() as u64);
}

/// Writes the draws of `calls`, in the order of their triangles' numbers, to `target`. `number`: of a draw's triangle, by the place
/// of its first index.
///
/// Errors: memory for the upload (exit code 4).
pub fn write<'a>(
    gpu: &Arc<Gpu>,
    target: &Buffer,
    scene: &SceneGpu,
    primitives: &Primitives,
    calls: impl Iterator<Item = &'a DrawCall>,
    number: impl Fn(u32, u32) -> u32,
    read_by: impl Into<AccessSet>,
) -> Result<()> {
    let block = |call: &DrawCall| {
        let params = primitives.params(scene, call);
        DrawnRangeBlock {
            first: number(call.draw, call.first_index),
            number_offset: number(call.draw, 0),
            draw: call.draw,
            vertex_offset: params.vertex_offset,
            primitive_offset: params.primitive_offset,
            flags: params.flags,
        }
    };
    let mut blocks: Vec<_> = calls.map(block).collect();
    // Shaders search the whole buffer: after what the frame draws come numbers that no triangle has.
    let none = DrawnRangeBlock { first: u32::MAX, ..DrawnRangeBlock::zeroed() };
    blocks.resize((target.bytes / size_of::<DrawnRangeBlock>() as u64) as usize, none);
    upload::buffer(gpu, target, bytemuck::cast_slice(&blocks), read_by)
}
