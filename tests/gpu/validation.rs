//! The watchman is awake: a planted missing barrier is reported, a wrong left side panics.

use crate::support::watched::{require_silence, watched_device};
use ash::vk;
use quincunx::gpu::commands::Submits;
use quincunx::gpu::{Access, AccessSet, Berth, Buffer, Commands, Gpu};
use quincunx::memory::kinds::Use;
use std::sync::Arc;

const BYTES: u64 = 4096;

fn buffers(gpu: &Arc<Gpu>) -> [Buffer; 2] {
    let flags = vk::BufferUsageFlags::TRANSFER_SRC | vk::BufferUsageFlags::TRANSFER_DST;
    ["test.source", "test.target"].map(|name| Buffer::new(gpu, name, "test", BYTES, flags, Use::Device).unwrap())
}

/// Fills one buffer and copies it into another, with a barrier between or without. Returns what the layer says.
fn fill_then_copy(gpu: &Arc<Gpu>, barrier: bool) -> Vec<String> {
    let [source, target] = buffers(gpu);
    let mut cmd = Commands::begin(gpu, "test", Submits::One).unwrap();
    cmd.barriers([source.discard(Access::TransferWrite), target.discard(Access::TransferWrite)]);
    // SAFETY: both buffers are alive until the fence, and the ranges lie in them.
    unsafe { gpu.device.cmd_fill_buffer(cmd.buffer(), source.handle, 0, BYTES, 7) };
    if barrier {
        cmd.barriers([source.from(Access::TransferWrite).to(Access::TransferRead)]);
    }
    let region = vk::BufferCopy { src_offset: 0, dst_offset: 0, size: BYTES };
    // SAFETY: as above. Without the barrier the copy races with the fill: what it reads is not used.
    unsafe { gpu.device.cmd_copy_buffer(cmd.buffer(), source.handle, target.handle, &[region]) };
    cmd.finish().unwrap().run().unwrap();
    gpu.take_validation_messages().into_iter().map(|message| format!("{} {}", message.id, message.text)).collect()
}

#[test]
fn a_missing_barrier_is_reported_and_a_stated_one_is_not() {
    let gpu = Gpu::open(&watched_device()).unwrap();
    assert_eq!(fill_then_copy(&gpu, true), [] as [&str; 0]);
    let messages = fill_then_copy(&gpu, false);
    assert!(messages.iter().any(|message| message.contains("SYNC-HAZARD-READ-AFTER-WRITE")), "{messages:?}");
    assert!(messages.iter().any(|message| message.contains("test.source")), "objects have names: {messages:?}");
    // A message is taken once.
    require_silence(&gpu, "after taking them");
}

#[test]
#[should_panic(expected = "SYNC-HAZARD")]
fn the_helper_of_every_test_fails_on_a_message() {
    let gpu = Gpu::open(&watched_device()).unwrap();
    let [source, target] = buffers(&gpu);
    let cmd = Commands::begin(&gpu, "test", Submits::One).unwrap();
    let region = vk::BufferCopy { src_offset: 0, dst_offset: 0, size: BYTES };
    // SAFETY: both buffers are alive until the fence. The second copy races with the first: the contents are not used.
    unsafe {
        gpu.device.cmd_copy_buffer(cmd.buffer(), source.handle, target.handle, &[region]);
        gpu.device.cmd_copy_buffer(cmd.buffer(), source.handle, target.handle, &[region]);
    }
    cmd.finish().unwrap().run().unwrap();
    require_silence(&gpu, "two copies into one buffer");
}

/// Two buffers in the same bytes, filled one after the other, with the barrier of a taking over or without. Returns what
/// the layer says.
fn fill_twice(gpu: &Arc<Gpu>, takes_over: AccessSet) -> Vec<String> {
    let arena = gpu.memory.arena("test.arena", "test", BYTES, 256, !0, Use::Device).unwrap();
    let buffer = |name, takes_over| {
        let berth = Berth::Part { arena: &arena, offset: 0, takes_over };
        Buffer::at(gpu, name, "test", BYTES, vk::BufferUsageFlags::TRANSFER_DST, Use::Device, berth).unwrap()
    };
    let (first, second) = (buffer("test.first", AccessSet::UNTOUCHED), buffer("test.second", takes_over));
    let mut cmd = Commands::begin(gpu, "test", Submits::One).unwrap();
    for (buffer, value) in [(&first, 7), (&second, 8)] {
        cmd.barriers([buffer.discard(Access::TransferWrite)]);
        // SAFETY: both buffers are alive until the fence; without the barrier the fills race, and nobody reads.
        unsafe { gpu.device.cmd_fill_buffer(cmd.buffer(), buffer.handle, 0, BYTES, value) };
    }
    cmd.finish().unwrap().run().unwrap();
    gpu.take_validation_messages().into_iter().map(|message| format!("{} {}", message.id, message.text)).collect()
}

#[test]
fn bytes_that_are_taken_over_without_waiting_are_reported() {
    let gpu = Gpu::open(&watched_device()).unwrap();
    assert_eq!(fill_twice(&gpu, Access::TransferWrite.into()), [] as [&str; 0]);
    let messages = fill_twice(&gpu, AccessSet::UNTOUCHED);
    assert!(messages.iter().any(|message| message.contains("SYNC-HAZARD-WRITE-AFTER-WRITE")), "{messages:?}");
}

#[test]
fn without_the_layer_nothing_is_collected() {
    let gpu = Gpu::open(&quincunx::gpu::DeviceRequest::default()).unwrap();
    assert!(fill_then_copy(&gpu, false).is_empty());
}

/// `record` says who wrote; debug builds hold that against the truth.
#[cfg(debug_assertions)]
mod left_sides {
    use super::*;

    fn record(touch: impl FnOnce(&mut Commands, &Buffer)) {
        let gpu = Gpu::open(&watched_device()).unwrap();
        let [source, _target] = buffers(&gpu);
        let mut cmd = Commands::begin(&gpu, "test", Submits::One).unwrap();
        touch(&mut cmd, &source);
    }

    #[test]
    #[should_panic(expected = "last touched by")]
    fn the_wrong_writer_panics() {
        record(|cmd, buffer| {
            cmd.barriers([buffer.discard(Access::TransferWrite)]);
            cmd.barriers([buffer.from(Access::ComputeWrite).to(Access::ComputeRead)]);
        });
    }

    #[test]
    #[should_panic(expected = "last touched by")]
    fn a_writer_that_never_was_panics() {
        record(|cmd, buffer| cmd.barriers([buffer.from(Access::ComputeWrite).to(Access::TransferRead)]));
    }

    #[test]
    #[should_panic(expected = "a first touch that is the second")]
    fn a_second_first_touch_panics() {
        record(|cmd, buffer| {
            cmd.barriers([buffer.discard(Access::TransferWrite)]);
            cmd.barriers([buffer.discard(Access::TransferWrite)]);
        });
    }

    #[test]
    fn the_true_story_does_not() {
        record(|cmd, buffer| {
            cmd.barriers([buffer.discard(Access::TransferWrite)]);
            cmd.barriers([buffer.from(Access::TransferWrite).to(Access::TransferRead)]);
            cmd.barriers([buffer.from(Access::TransferRead).to(Access::ComputeRead)]);
            cmd.barriers([buffer.from(Access::TransferRead | Access::ComputeRead).to(Access::TransferWrite)]);
        });
    }
}
