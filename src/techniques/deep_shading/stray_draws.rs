//! The draws of strays, which the device leaves out where no sample strays: nearly always in sharp pictures, and often under
//! blur. Whether there are any is their draw count.
//! reads  count.counters, strays.draws      writes  strays.count

use crate::error::Result;
use crate::gpu::shader::techniques::deep_shading::counters::COUNTED_ANY_STRAY;
use crate::gpu::{Access, Buffer, Commands, Edge, Gpu, upload};
use crate::memory::kinds::Use;
use crate::plan::{Plan, Resources, Shape};
use crate::resident::SceneGpu;
use crate::techniques::deep_shading::resources::{COUNTERS, full};
use crate::techniques::deep_shading::visibility::draw::{Repeats, SampleStages};
use ash::vk;
use std::sync::Arc;

const DRAWS: &str = "strays.draws";
pub const COUNT: &str = "strays.count";

/// The word of the counters that is 1 where there are strays. Their own number, millions, is more than a device may take for a draw count
/// (maxDrawIndirectCount).
const ANY_STRAY_WORD: u64 = COUNTED_ANY_STRAY as u64;

const COMMAND_BYTES: u64 = size_of::<vk::DrawIndirectCommand>() as u64;

/// Plans a command for each of `draws`, and their count.
pub fn plan(plan: &mut Plan, draws: u64) {
    let flags = vk::BufferUsageFlags::INDIRECT_BUFFER | vk::BufferUsageFlags::TRANSFER_DST;
    let shape = |bytes| Shape::Buffer { bytes, flags, usage: Use::Device };
    plan.push("scene.geometry", full(DRAWS), shape(draws * COMMAND_BYTES));
    plan.push("counters", full(COUNT), shape(4));
}

/// Resources that the pass touches in addition to others.
pub fn touches() -> [(String, Access); 3] {
    let touch = |name: &str, access| (full(name), access);
    [touch(COUNTERS, Access::TransferRead), touch(COUNT, Access::TransferWrite), touch(COUNT, Access::IndirectRead)]
}

pub struct StrayDraws {
    draws: Buffer,
    count: Buffer,
}

impl StrayDraws {
    /// Commands for all of the scene's calls, in the order of its draws.
    ///
    /// Errors: memory for the upload (exit code 4).
    pub fn new(
        gpu: &Arc<Gpu>,
        resources: &mut Resources,
        scene: &SceneGpu,
        stages: &SampleStages,
        repeats: &Repeats,
    ) -> Result<Self> {
        let mut commands = vec![[0u32; 4]; scene.calls.len()];
        for call in &scene.calls {
            let [vertex_count, first_vertex] = stages.vertices(call);
            commands[call.draw as usize] = [vertex_count, repeats.instance_count, first_vertex, 0];
        }
        let draws = resources.buffer(&full(DRAWS));
        upload::buffer(gpu, &draws, bytemuck::cast_slice(&commands), Access::IndirectRead)?;
        Ok(Self { draws, count: resources.buffer(&full(COUNT)) })
    }

    /// Takes over whether there are strays, before the draws, whose fragments write `counters`.
    pub fn record(&self, cmd: &mut Commands, counters: Edge<'_, Buffer>) {
        cmd.barriers([counters.to(Access::TransferRead)]);
        cmd.barriers([self.count.discard(Access::TransferWrite)]);
        let counters = counters.resource;
        cmd.copy_word(counters, ANY_STRAY_WORD, &self.count);
        cmd.barriers([self.count.from(Access::TransferWrite).to(Access::IndirectRead)]);
        cmd.barriers([counters.from(Access::TransferRead).to(Access::FragmentWrite)]);
    }

    /// The scene's draw of this index, if there are strays. Inside rendering.
    pub fn draw(&self, cmd: &Commands, draw: u32) {
        let (offset, stride) = (u64::from(draw) * COMMAND_BYTES, COMMAND_BYTES as u32);
        let (draws, count) = (self.draws.handle, self.count.handle);
        // SAFETY: the buffer is being recorded inside rendering; both buffers outlive the recorded frame and the command lies in
        // the first; the importer checked that every index has its vertex.
        unsafe { cmd.gpu().device.cmd_draw_indirect_count(cmd.buffer(), draws, offset, count, 0, 1, stride) };
    }
}
