//! What a small shader touches, counted by it and by hand.

use crate::support::watched::{require_silence, watched_device};
use ash::vk;
use glslang::{Compiler, CompilerOptions, ShaderInput, ShaderMessage, ShaderSource, ShaderStage, SourceLanguage};
use glslang::{SpirvVersion, Target, VulkanVersion};
use quincunx::gpu::commands::Submits;
use quincunx::gpu::marks::counted::Touches;
use quincunx::gpu::pipeline::ComputePipeline;
use quincunx::gpu::sampler::Sampler;
use quincunx::gpu::shader::{Binding, BindingKind, Shader, Side, Stage};
use quincunx::gpu::{
    Access, Berth, Bound, Buffer, Commands, DeviceRequest, Gpu, Image, ImageDescription, Traffic, upload,
};
use quincunx::memory::kinds::Use;
use quincunx::memory::touched::Touched;
use quincunx::units::Extent;
use std::collections::BTreeMap;

/// A thing is 80 bytes, the first of them 16 behind the buffer's beginning: its weight lies at 12, the columns of its matrix at 16, 32 and 48,
/// its ids at 64.
const GLSL: &str = "#version 460
layout(local_size_x = 1) in;
struct Thing { vec3 place; float weight; mat3 turn; uint ids[3]; };
layout(std430, set = 0, binding = 0) buffer Things { uint head; Thing thing[]; } things;
layout(set = 0, binding = 1) uniform sampler2DArray picture;
layout(set = 0, binding = 2, r32ui) uniform writeonly uimage2D target;

float looked_up(sampler2DArray from, vec3 place, float level) {
    return textureLod(from, place, level).r;
}

void main() {
    uint own = gl_WorkGroupID.x;
    float sum = things.thing[own].weight + things.thing[own].turn[own % 3].y;
    if (own == 0) {
        sum += looked_up(picture, vec3(0.0, 0.25, 1.0), 0.0) + looked_up(picture, vec3(0.5, 0.5, 0.0), 1.0);
        sum += texelFetch(picture, ivec3(4, 5, 0), 0).r;
        imageStore(target, ivec2(9, 3), uvec4(uint(sum)));
    }
    things.thing[own].ids[2] = uint(sum);
    atomicAdd(things.head, 1);
}
";

const fn binding(binding: u32, name: &'static str, kind: BindingKind) -> Binding {
    Binding { set: 0, binding, name, kind, count: 1 }
}

const BINDINGS: [Binding; 3] = [
    binding(0, "things", BindingKind::StorageBuffer),
    binding(1, "picture", BindingKind::CombinedImageSampler),
    binding(2, "target", BindingKind::StorageImage),
];

fn shader() -> Shader {
    let options = CompilerOptions {
        source_language: SourceLanguage::GLSL,
        target: Target::Vulkan { version: VulkanVersion::Vulkan1_3, spirv_version: SpirvVersion::SPIRV1_6 },
        version_profile: None,
        messages: ShaderMessage::DEFAULT,
    };
    let source = ShaderSource::from(GLSL);
    let input = ShaderInput::new(&source, ShaderStage::Compute, &options, None, None).unwrap();
    let words = Compiler::acquire().unwrap().create_shader(input).unwrap().compile().unwrap();
    let bytes: Vec<u8> = words.into_iter().flat_map(u32::to_le_bytes).collect();
    Shader {
        name: "test/marks",
        variant: "COMP",
        stage: Stage::Compute,
        spirv: bytes.leak(),
        bindings: &BINDINGS,
        params: None,
        constants: &[],
        workgroup: [Side::Fixed(1); 3],
    }
}

/// Bits of pieces, in words.
fn words(pieces: impl IntoIterator<Item = u64>, count: usize) -> Vec<u32> {
    let mut words = vec![0; count.div_ceil(32)];
    pieces.into_iter().for_each(|piece| words[(piece / 32) as usize] |= 1 << (piece % 32));
    words
}

/// What a pass over `count` things touches, by resource.
fn touched(touched: Touched, count: u32) -> BTreeMap<String, Touches> {
    let gpu = Gpu::open(&DeviceRequest { touched, ..watched_device() }).unwrap();
    let pipeline = ComputePipeline::new(&gpu, &shader(), &[]).unwrap();
    let things =
        Buffer::new(&gpu, "things", "test", 16 + 80 * 40, vk::BufferUsageFlags::STORAGE_BUFFER, Use::Device).unwrap();
    let usage = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
    let plain = |width, height, format, usage| ImageDescription::plain(Extent { width, height }, format, 1, usage);
    let description =
        ImageDescription { level_count: 3, layer_count: Some(2), ..plain(10, 6, vk::Format::R8G8B8A8_UNORM, usage) };
    let picture = Image::at(&gpu, "picture", "test", description, Berth::Own).unwrap();
    upload::image(&gpu, &picture, Access::ComputeSample, |bytes| bytes.fill(0)).unwrap();
    let description = plain(16, 4, vk::Format::R32_UINT, vk::ImageUsageFlags::STORAGE);
    let target = Image::at(&gpu, "target", "test", description, Berth::Own).unwrap();
    let info = vk::SamplerCreateInfo::default()
        .mag_filter(vk::Filter::LINEAR)
        .min_filter(vk::Filter::LINEAR)
        .address_mode_v(vk::SamplerAddressMode::CLAMP_TO_EDGE)
        .max_lod(vk::LOD_CLAMP_NONE);
    let sampler = Sampler::new(&gpu, "sampler", &info).unwrap();
    let mut cmd = Commands::begin(&gpu, "test", Submits::PerPass).unwrap();
    cmd.pass("test.pass", Traffic::default(), |cmd| {
        cmd.barriers([things.discard(Access::ComputeWrite), target.discard(Access::ComputeWrite)]);
        let bound = [
            ("things", Bound::Buffer(&things)),
            ("picture", Bound::Sampled(&picture, sampler.handle, Access::ComputeSample)),
            ("target", Bound::Storage(&target)),
        ];
        cmd.dispatch(&pipeline, &[], &bound, [count, 1, 1])
    })
    .unwrap();
    cmd.finish().unwrap().run().unwrap();
    let marks = gpu.marks.clone().unwrap();
    require_silence(&gpu, "a pass that counts");
    let touches = marks.touches();
    assert_eq!(touches.passes.len(), 1);
    assert_eq!(touches.passes[0].invocations, u64::from(count));
    touches.passes[0].resources.clone()
}

#[test]
fn pieces_and_bytes_are_those_of_a_count_by_hand() {
    for (pieces, piece_bytes) in [(Touched::Line, 64), (Touched::Page, 4096)] {
        for count in [1, 40] {
            let found = touched(pieces, count);
            let things = &found["things"];
            let of = |offset: u64| move |thing: u64| (16 + 80 * thing + offset) / piece_bytes;
            let all = || 0..u64::from(count);
            // The count at the head is read to be added to.
            let weights = all().map(of(12));
            let reads = weights.chain(all().map(|thing| of(16 + 16 * (thing % 3) + 4)(thing))).chain([0]);
            let writes = all().map(of(64 + 8)).chain([0]);
            let granules = (16_u64 + 80 * 40).div_ceil(piece_bytes) as usize;
            assert_eq!(things.reads.marks, words(reads, granules), "{count} in {piece_bytes}");
            assert_eq!(things.writes.marks, words(writes, granules), "{count} in {piece_bytes}");
            assert_eq!((things.reads.asked_bytes, things.writes.asked_bytes), (12 * all().end, 8 * all().end));
        }
    }
}

#[test]
fn texels_are_those_that_filters_weigh() {
    let found = touched(Touched::Line, 1);
    let picture = &found["picture"];
    // Blocks of 4x4 texels: of the first level 3x2 a layer, of the second (5x3 texels) 2x1. At 0, 0.25 of the second layer the texels
    // 9 and 0 of the lines 1 and 2; in the middle of the second level those at 2 and 3, 1 and 2; and the one at 4, 5.
    let blocks = [6 + 2, 6, 2 * 6, 3 + 1];
    assert_eq!(picture.reads.marks, words(blocks, 2 * 6 + 2 * 2 + 2), "{:b}", picture.reads.marks[0]);
    assert_eq!((picture.reads.asked_bytes, picture.writes.asked_bytes), (4 * 4 + 4 * 4 + 4, 0));
    let target = &found["target"];
    assert_eq!((&target.writes.marks, target.writes.asked_bytes), (&words([2], 4), 4));
    assert_eq!(target.reads.asked_bytes, 0);
}
