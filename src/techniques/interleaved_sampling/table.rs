//! Table: where the samples of members lie, for shaders (members.glsl).

use super::members::Members;
use super::resources::MEMBERS;
use crate::error::Result;
use crate::gpu::shader::structs::MembersParams;
use crate::gpu::{Access, Buffer, Gpu, upload};
use crate::plan::{Plan, Resources};
use std::sync::Arc;

/// Plans it.
pub fn plan(plan: &mut Plan, members: &Members) {
    plan.buffer("combine", MEMBERS, 4 * members.table().len() as u64);
}

pub struct Table {
    pub buffer: Buffer,
    pub params: MembersParams,
}

impl Table {
    /// Fills what was planned.
    ///
    /// Errors: memory for the upload (exit code 4).
    pub fn new(gpu: &Arc<Gpu>, resources: &mut Resources, members: &Members) -> Result<Self> {
        let buffer = resources.buffer(MEMBERS);
        let readers = Access::ComputeRead | Access::GraphicsRead;
        upload::buffer(gpu, &buffer, bytemuck::cast_slice(&members.table()), readers)?;
        let (grid, [x, y]) = (members.grid(), members.basis().sides);
        let params = MembersParams {
            period_x_px: x.pixels,
            period_y_px: y.pixels,
            bases_x: x.bases,
            bases_y: y.bases,
            grid_width: grid.width,
            grid_height: grid.height,
            firsts_at: members.firsts_at(),
            members: members.count(),
            members_at_once: members.at_once(),
        };
        Ok(Self { buffer, params })
    }
}
