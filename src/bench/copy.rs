//! vkCmdCopyBuffer of as many bytes as a copying stage leaves: the limit of the machine's memory.

use super::rounds::{Probe, last_pass};
use crate::error::Result;
use crate::gpu::commands::{Submits, Traffic};
use crate::gpu::recorded::Recorded;
use crate::gpu::{Access, Buffer, Commands, Gpu};
use crate::memory::kinds::Use;
use ash::vk;
use std::sync::Arc;

/// Ledger group of its buffers.
const GROUP: &str = "bench";

/// Two buffers and the copy from one to the other.
pub struct BufferCopy {
    // Dropped before what it uses.
    recorded: Recorded,
    pub bytes: u64,
    _buffers: [Buffer; 2],
}

impl BufferCopy {
    /// `bytes`: at least 4, a multiple of 4.
    ///
    /// Errors: memory (exit code 4).
    pub fn new(gpu: &Arc<Gpu>, bytes: u64) -> Result<Self> {
        let make = |what: &str| {
            let flags = vk::BufferUsageFlags::TRANSFER_SRC | vk::BufferUsageFlags::TRANSFER_DST;
            Buffer::new(gpu, &format!("bench.copy.{what}"), GROUP, bytes, flags, Use::Device)
        };
        let [source, target] = [make("source")?, make("target")?];
        let mut cmd = Commands::begin(gpu, "bench", Submits::PerPass)?;
        // Memory that was never written may be one page of zeros, which copies from the cache. And a copying stage,
        // too, reads what a pass has just written.
        let fill = Traffic { written_bytes: Some(bytes), ..Traffic::default() };
        cmd.pass("bench.fill", fill, |cmd| {
            cmd.barriers([source.discard(Access::TransferWrite)]);
            cmd.fill_buffer(&source, 0x3c00_3c00);
            Ok(())
        })?;
        let copy = Traffic { read_bytes: Some(bytes), written_bytes: Some(bytes), invocations: None };
        cmd.pass("bench.copy", copy, |cmd| {
            cmd.barriers([
                source.from(Access::TransferWrite).to(Access::TransferRead),
                target.discard(Access::TransferWrite),
            ]);
            cmd.copy_buffer(&source, &target);
            Ok(())
        })?;
        Ok(Self { recorded: cmd.finish()?, bytes, _buffers: [source, target] })
    }
}

impl Probe for BufferCopy {
    fn measure(&self) -> Result<Vec<f64>> {
        last_pass(&self.recorded)
    }
}
