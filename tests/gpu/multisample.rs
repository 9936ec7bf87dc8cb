//! Images with several samples a pixel: their bytes, and their mean.

use crate::support::watched::{require_silence, values, watched_device};
use ash::vk;
use quincunx::caps::known;
use quincunx::gpu::commands::Submits;
use quincunx::gpu::{Access, Berth, ColorTarget, Commands, Gpu, Image, ImageDescription, readback};
use quincunx::passes::resolve::{self, Resolve};
use quincunx::passes::samples::Samples;
use quincunx::plan::{Requirements, Shape};
use quincunx::units::Extent;
use std::sync::Arc;

const EXTENT: Extent = Extent { width: 37, height: 11 };
const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const HALVES: vk::Format = vk::Format::R16G16B16A16_SFLOAT;

/// Clears an image of four samples to `value` and resolves it into one of floats.
fn resolve_a_clear(gpu: &Arc<Gpu>, format: vk::Format, value: [f32; 4]) -> Vec<u8> {
    let image = |name, description| Image::at(gpu, name, "test", description, Berth::Own).unwrap();
    let drawn = image("test.drawn", ImageDescription::plain(EXTENT, format, 4, resolve::DRAWN));
    let usage = vk::ImageUsageFlags::STORAGE | vk::ImageUsageFlags::TRANSFER_SRC;
    let plain = image("test.plain", ImageDescription::plain(EXTENT, FLOATS, 1, usage));
    let samples = Samples::new(&values("forward", &[("msaa", "4")]));
    let resolve = Resolve::new(gpu, samples, plain).unwrap();
    let mut cmd = Commands::begin(gpu, "test", Submits::One).unwrap();
    cmd.barriers([drawn.discard(Access::ColorWrite)]);
    let clear = Some(vk::ClearColorValue { float32: value });
    cmd.begin_rendering(EXTENT, &[ColorTarget::new(&drawn, clear)], None);
    cmd.end_rendering();
    resolve.record(&mut cmd, "test", drawn.from(Access::ColorWrite)).unwrap();
    cmd.finish().unwrap().run().unwrap();
    let bytes = readback::image(gpu, &resolve.color, Access::ComputeWrite).unwrap();
    require_silence(gpu, "resolving");
    bytes
}

#[test]
fn four_equal_samples_have_themselves_for_a_mean() {
    let gpu = Gpu::open(&watched_device()).unwrap();
    // Each has its half, so that both formats hold the same.
    let value = [0.25, 3.0, 1024.0, -0.5];
    let expected: Vec<u8> = value.iter().flat_map(|channel: &f32| channel.to_le_bytes()).collect();
    for format in [FLOATS, HALVES] {
        assert_eq!(resolve_a_clear(&gpu, format, value), expected.repeat(EXTENT.pixel_count() as usize), "{format:?}");
    }
}

/// What is asked for is pixels times samples times texels, and each driver in assets/caps pads that as its rules say.
#[test]
fn samples_count_as_bytes() {
    let gpu = Gpu::open(&watched_device()).unwrap();
    let live = &gpu.caps.identity;
    let known = known::names()
        .map(|name| known::caps(name).unwrap())
        .find(|caps| (&caps.identity.driver, &caps.identity.driver_info) == (&live.driver, &live.driver_info));
    for (format, texel_bytes) in [(FLOATS, 16), (HALVES, 8), (vk::Format::D32_SFLOAT, 4)] {
        for (width, height) in [(64, 36), (97, 53), (161, 91), (641, 359)] {
            let extent = Extent::new(width, height);
            let usage = match format {
                vk::Format::D32_SFLOAT => vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT,
                _ => vk::ImageUsageFlags::COLOR_ATTACHMENT,
            };
            let many = ImageDescription::plain(extent, format, 4, usage);
            assert_eq!(many.bytes(), extent.pixel_count() * 4 * texel_bytes);
            let Some(rules) = known.as_ref().and_then(|caps| caps.layout.as_ref()) else { continue };
            let shape = Shape::Image(many);
            let (asked, ruled) = (Requirements::Device(&gpu).of(&shape), Requirements::Rules(rules).of(&shape));
            assert_eq!(asked, ruled, "{format:?} {extent}");
        }
    }
}
