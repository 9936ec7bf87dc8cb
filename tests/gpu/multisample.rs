//! Images with several samples a pixel: their bytes, and their mean as rendering resolves it.

use crate::support::watched::{require_silence, watched_device};
use ash::vk;
use quincunx::caps::known;
use quincunx::gpu::commands::Submits;
use quincunx::gpu::{Access, Berth, ColorTarget, Commands, Gpu, Image, ImageDescription, readback};
use quincunx::plan::{Requirements, Shape};
use quincunx::units::Extent;
use std::sync::Arc;

const EXTENT: Extent = Extent { width: 37, height: 11 };
const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;
const HALVES: vk::Format = vk::Format::R16G16B16A16_SFLOAT;

fn description(format: vk::Format, samples: u32) -> ImageDescription {
    let usage = vk::ImageUsageFlags::COLOR_ATTACHMENT;
    let usage = if samples == 1 { usage | vk::ImageUsageFlags::TRANSFER_SRC } else { usage };
    ImageDescription::plain(EXTENT, format, samples, usage)
}

fn image(gpu: &Arc<Gpu>, name: &str, format: vk::Format, samples: u32) -> Image {
    Image::at(gpu, name, "test", description(format, samples), Berth::Own).unwrap()
}

/// Clears an image of four samples to `value` and resolves it. `reached`: the resolved image gets its barrier.
fn resolve_a_clear(gpu: &Arc<Gpu>, format: vk::Format, value: [f32; 4], reached: bool) -> Vec<u8> {
    let (many, plain) = (image(gpu, "test.many", format, 4), image(gpu, "test.plain", format, 1));
    let mut cmd = Commands::begin(gpu, "test", Submits::One).unwrap();
    cmd.barriers([many.discard(Access::ColorWrite)]);
    if reached {
        cmd.barriers([plain.discard(Access::ColorWrite)]);
    }
    let clear = Some(vk::ClearColorValue { float32: value });
    cmd.begin_rendering(EXTENT, &[ColorTarget::new(&many, clear).resolved(&plain)], None);
    cmd.end_rendering();
    cmd.finish().unwrap().run().unwrap();
    let bytes = readback::image(gpu, &plain, Access::ColorWrite).unwrap();
    require_silence(gpu, "resolving");
    bytes
}

#[test]
fn four_equal_samples_have_themselves_for_a_mean() {
    let gpu = Gpu::open(&watched_device()).unwrap();
    // Each has its half, so that both formats hold the same.
    let value = [0.25, 3.0, 1024.0, -0.5];
    let floats = resolve_a_clear(&gpu, FLOATS, value, true);
    let expected: Vec<u8> = value.iter().flat_map(|channel| channel.to_le_bytes()).collect();
    assert_eq!(floats, expected.repeat(EXTENT.pixel_count() as usize));
    let halves = resolve_a_clear(&gpu, HALVES, value, true);
    let bits: Vec<u8> = [0x3400u16, 0x4200, 0x6400, 0xb800].iter().flat_map(|half| half.to_le_bytes()).collect();
    assert_eq!(halves, bits.repeat(EXTENT.pixel_count() as usize));
}

#[test]
#[cfg(debug_assertions)]
#[should_panic(expected = "test.plain is attached as ColorWrite")]
fn an_image_that_is_resolved_into_needs_its_barrier_too() {
    let gpu = Gpu::open(&watched_device()).unwrap();
    resolve_a_clear(&gpu, FLOATS, [0.0; 4], false);
}

#[test]
#[should_panic(expected = "cannot be resolved into")]
fn one_sample_cannot_be_resolved() {
    let gpu = Gpu::open(&watched_device()).unwrap();
    let (one, plain) = (image(&gpu, "test.one", FLOATS, 1), image(&gpu, "test.plain", FLOATS, 1));
    let mut cmd = Commands::begin(&gpu, "test", Submits::One).unwrap();
    cmd.barriers([one.discard(Access::ColorWrite), plain.discard(Access::ColorWrite)]);
    cmd.begin_rendering(EXTENT, &[ColorTarget::new(&one, None).resolved(&plain)], None);
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
            let many = ImageDescription { extent, usage, ..description(format, 4) };
            assert_eq!(many.bytes(), extent.pixel_count() * 4 * texel_bytes);
            let Some(rules) = known.as_ref().and_then(|caps| caps.layout.as_ref()) else { continue };
            let shape = Shape::Image(many);
            let (asked, ruled) = (Requirements::Device(&gpu).of(&shape), Requirements::Rules(rules).of(&shape));
            assert_eq!(asked, ruled, "{format:?} {extent}");
        }
    }
}
