//! One kind of work of `bench device`, recorded: a pass that fills its buffers, and the pass that is timed. Shader: device.comp.

use crate::bench::rounds::{Probe, last_pass};
use crate::error::{Error, Result};
use crate::gpu::commands::{Submits, Traffic};
use crate::gpu::pipeline::ComputePipeline;
use crate::gpu::recorded::Recorded;
use crate::gpu::shader::bench::device::{COMP_VARIANTS, DEVICE_RUN};
use crate::gpu::shader::structs::DeviceParams;
use crate::gpu::shader::variant;
use crate::gpu::{Access, Bound, Buffer, Commands, Gpu, readback};
use crate::memory::kinds::Use;
use ash::vk;
use std::rc::Rc;
use std::sync::Arc;

/// Ledger group of what is measured.
pub(super) const GROUP: &str = "bench";
/// Invocations of what touches single words, at most.
const MOST_WORDS: u64 = 1 << 22;

/// What is done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Work {
    /// vkCmdFillBuffer.
    Clear,
    /// vkCmdCopyBuffer.
    CopyCommand,
    Read,
    Write,
    Copy,
    /// Reads of words so many words apart.
    Stride(u32),
    Random,
    /// Additions to so many counters, a power of two.
    Atomic(u32),
}

impl Work {
    /// All that is measured.
    pub const ALL: [Self; 11] = [
        Self::Clear,
        Self::CopyCommand,
        Self::Read,
        Self::Write,
        Self::Copy,
        Self::Stride(1),
        Self::Stride(8),
        Self::Stride(64),
        Self::Random,
        Self::Atomic(1),
        Self::Atomic(1 << 16),
    ];

    /// Name in rows.
    pub fn name(self) -> String {
        match self {
            Self::Clear => "clear".to_owned(),
            Self::CopyCommand => "copy command".to_owned(),
            Self::Read => "read".to_owned(),
            Self::Write => "write".to_owned(),
            Self::Copy => "shader copy".to_owned(),
            Self::Stride(words) => format!("stride {}", 4 * words),
            Self::Random => "random".to_owned(),
            Self::Atomic(counters) => format!("atomic {counters}"),
        }
    }

    /// The shader's axis KIND; None of commands.
    fn kind(self) -> Option<&'static str> {
        match self {
            Self::Clear | Self::CopyCommand => None,
            Self::Read => Some("read"),
            Self::Write => Some("write"),
            Self::Copy => Some("both"),
            Self::Stride(_) => Some("stride"),
            Self::Random => Some("random"),
            Self::Atomic(_) => Some("atomic"),
        }
    }

    fn reads_source(self) -> bool {
        !matches!(self, Self::Clear | Self::Write | Self::Atomic(_))
    }

    /// Invocations, of buffers of `bytes`.
    fn count(self, bytes: u64) -> u64 {
        match self {
            Self::Clear | Self::CopyCommand => 0,
            Self::Read | Self::Write | Self::Copy => bytes / 16 / u64::from(DEVICE_RUN),
            Self::Stride(words) => (bytes / 4 / u64::from(words)).min(MOST_WORDS),
            Self::Random | Self::Atomic(_) => (bytes / 4).min(MOST_WORDS),
        }
    }

    /// Bytes that are read and written, those of single words as words.
    pub fn moved_bytes(self, bytes: u64) -> [u64; 2] {
        match self {
            Self::Clear | Self::Write => [0, bytes],
            Self::Read => [bytes, 0],
            Self::CopyCommand | Self::Copy => [bytes, bytes],
            Self::Stride(_) | Self::Random => [4 * self.count(bytes), 0],
            Self::Atomic(_) => [4 * self.count(bytes); 2],
        }
    }

    /// Single words that are touched; None where all are, one after the other.
    pub fn word_count(self, bytes: u64) -> Option<u64> {
        matches!(self, Self::Stride(_) | Self::Random | Self::Atomic(_)).then(|| self.count(bytes))
    }
}

/// The buffers that all work in turn.
pub struct Buffers {
    source: Buffer,
    target: Buffer,
}

impl Buffers {
    /// `bytes`: a power of two, at least 1 MiB.
    ///
    /// Errors: memory, or the device binds less (exit code 4).
    pub fn new(gpu: &Arc<Gpu>, bytes: u64) -> Result<Self> {
        let limit = gpu.caps.limits.max_storage_buffer_range_bytes;
        if bytes > limit {
            return Err(Error::memory(format!("bench device: {bytes} bytes, and this device binds {limit}"))
                .note("fewer --bytes"));
        }
        let make = |what: &str| {
            let flags = vk::BufferUsageFlags::STORAGE_BUFFER
                | vk::BufferUsageFlags::TRANSFER_SRC
                | vk::BufferUsageFlags::TRANSFER_DST;
            Buffer::new(gpu, &format!("bench.device.{what}"), GROUP, bytes, flags, Use::Device)
        };
        Ok(Self { source: make("source")?, target: make("target")? })
    }
}

/// A kind of work on the device.
pub struct Worked {
    // Dropped before what it uses.
    recorded: Recorded,
    _pipeline: Option<ComputePipeline>,
    pub work: Work,
    buffers: Rc<Buffers>,
}

impl Worked {
    /// `fill`: the word that the source holds.
    ///
    /// Errors: the driver refuses (exit code 4).
    pub fn new(gpu: &Arc<Gpu>, work: Work, buffers: &Rc<Buffers>, fill: u32) -> Result<Self> {
        let pipeline =
            work.kind().map(|kind| ComputePipeline::new(gpu, variant(COMP_VARIANTS, &[kind]), &[])).transpose()?;
        let Buffers { source, target } = &**buffers;
        let bytes = source.bytes;
        let mut cmd = Commands::begin(gpu, "bench", Submits::PerPass)?;
        let filled = Traffic { written_bytes: Some(2 * bytes), ..Traffic::default() };
        cmd.pass("bench.fill", filled, |cmd| {
            cmd.barriers([source.discard(Access::TransferWrite), target.discard(Access::TransferWrite)]);
            cmd.fill_buffer(source, fill);
            cmd.fill_buffer(target, 0);
            Ok(())
        })?;
        let [read_bytes, written_bytes] = work.moved_bytes(bytes);
        let count = work.count(bytes);
        let traffic = Traffic {
            read_bytes: Some(read_bytes),
            written_bytes: Some(written_bytes),
            invocations: pipeline.is_some().then_some(count),
        };
        cmd.pass("bench.device", traffic, |cmd| {
            let Some(pipeline) = &pipeline else {
                cmd.barriers([
                    source.from(Access::TransferWrite).to(Access::TransferRead),
                    target.from(Access::TransferWrite).to(Access::TransferWrite),
                ]);
                match work {
                    Work::CopyCommand => cmd.copy_buffer(source, target),
                    _ => cmd.fill_buffer(target, fill),
                }
                return Ok(());
            };
            cmd.barriers([
                source.from(Access::TransferWrite).to(Access::ComputeRead),
                target.from(Access::TransferWrite).to(Access::ComputeWrite),
            ]);
            let (mask, stride) = match work {
                Work::Atomic(counters) => (counters - 1, 1),
                Work::Stride(words) => ((bytes / 4) as u32 - 1, words),
                _ => ((bytes / 4) as u32 - 1, 1),
            };
            let params = DeviceParams { count: count as u32, mask, stride };
            let source = work.reads_source().then_some(("source", Bound::Buffer(source)));
            let bound: Vec<_> = source.into_iter().chain([("target", Bound::Buffer(target))]).collect();
            let groups = pipeline.groups([count as u32, 1, 1]);
            cmd.dispatch(pipeline, bytemuck::bytes_of(&params), &bound, groups)
        })?;
        Ok(Self { recorded: cmd.finish()?, _pipeline: pipeline, work, buffers: buffers.clone() })
    }

    /// The target after the last run, as words.
    ///
    /// Errors: memory for reading it back (exit code 4).
    pub fn target(&self, gpu: &Arc<Gpu>) -> Result<Vec<u32>> {
        let target = &self.buffers.target;
        let last = if self.work.kind().is_some() { Access::ComputeWrite } else { Access::TransferWrite };
        let bytes = readback::buffer(gpu, target, target.bytes, last)?;
        Ok(bytemuck::pod_collect_to_vec(&bytes))
    }
}

impl Probe for Worked {
    fn measure(&self) -> Result<Vec<f64>> {
        last_pass(&self.recorded)
    }
}
