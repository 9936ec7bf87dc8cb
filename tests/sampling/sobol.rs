//! The Sobol sequence of shaders against its twin in Rust: every bit of many points.

use crate::support::watched::{require_silence, watched_device};
use bytemuck::{bytes_of, cast_slice, pod_collect_to_vec};
use quincunx::gpu::commands::Submits;
use quincunx::gpu::pipeline::ComputePipeline;
use quincunx::gpu::shader::sampling::sobol::COMP;
use quincunx::gpu::shader::structs::SobolParams;
use quincunx::gpu::{Access, Bound, Buffer, Commands, Gpu, readback};
use quincunx::memory::kinds::Use;
use quincunx::sampling::sobol;
use std::sync::Arc;

const PIXELS: u32 = 24;

fn points(gpu: &Arc<Gpu>, pipeline: &ComputePipeline, params: &SobolParams) -> Vec<[f32; 2]> {
    let point_count = PIXELS * params.pair_count * params.count;
    let bytes = 8 * u64::from(point_count);
    let flags = ash::vk::BufferUsageFlags::STORAGE_BUFFER | ash::vk::BufferUsageFlags::TRANSFER_SRC;
    let buffer = Buffer::new(gpu, "test.points", "test", bytes, flags, Use::Device).unwrap();
    let mut cmd = Commands::begin(gpu, "test", Submits::One).unwrap();
    cmd.barriers([buffer.discard(Access::ComputeWrite)]);
    let bound = [("Points", Bound::Buffer(&buffer))];
    cmd.dispatch(pipeline, bytes_of(params), &bound, pipeline.groups([point_count, 1, 1])).unwrap();
    cmd.finish().unwrap().run().unwrap();
    pod_collect_to_vec(&readback::buffer(gpu, &buffer, bytes, Access::ComputeWrite).unwrap())
}

#[test]
fn shaders_and_the_host_have_the_same_bits() {
    let gpu = Gpu::open(&watched_device()).unwrap();
    let pipeline = ComputePipeline::new(&gpu, &COMP, &[]).unwrap();
    // From the start, across a power of two, and where indices have all their bits.
    for (seed, first) in [(1, 0), (0, 1000), (77, 65_500), (u32::MAX, u32::MAX - 63), (0x9e37_79b9, 0x8000_0000)] {
        let params = SobolParams { seed, first, count: 64, pair_count: 9 };
        let found = points(&gpu, &pipeline, &params);
        let expected: Vec<[f32; 2]> = (0..PIXELS)
            .flat_map(|pixel| (0..params.pair_count).map(move |pair| (pixel, pair)))
            .flat_map(|(pixel, pair)| {
                let seed = sobol::pair_seed(sobol::pixel_seed([pixel % 8, pixel / 8], seed), pair);
                (0..params.count).map(move |index| sobol::pair(first + index, seed))
            })
            .collect();
        let differing = found.iter().zip(&expected).position(|(a, b)| a.map(f32::to_bits) != b.map(f32::to_bits));
        assert_eq!(differing, None, "seed {seed}, first {first}");
        assert_eq!(cast_slice::<[f32; 2], u32>(&found).len(), expected.len() * 2);
    }
    require_silence(&gpu, "the sequence");
}
