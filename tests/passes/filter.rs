//! The Gaussians that stop at discontinuities, against a few lines of Rust (Segovia 2006, section 4.5).

use crate::support::watched::{Watched, both, require_silence, watched_device};
use ash::vk;
use glam::Vec3;
use half::f16;
use quincunx::gpu::commands::Submits;
use quincunx::gpu::{Access, Buffer, Commands, Gpu, readback, upload};
use quincunx::memory::kinds::Use;
use quincunx::passes::decode;
use quincunx::passes::filter::gauss::Gauss;
use quincunx::passes::filter::{FilterSetup, Kernel, StopBits, WalkEnd};
use quincunx::units::Extent;
use std::sync::Arc;

const TECHNIQUE: &str = "interleaved_deferred";
/// What these tests read back.
const STAGES: [&str; 4] = ["gbuffer.normal", "gather.irradiance", "discontinuity.flags", "filter.irradiance"];

/// Device and host round to half floats twice, once a direction, each time by at most 2^-11 of the value; a value that
/// lies between two halves may go either way on the two sides. Subnormal halves are 2^-24 apart.
const RELATIVE_BOUND: f32 = 1.0 / 512.0;
const SUBNORMAL_STEP: f32 = 1.0 / 16_777_216.0;

/// What the filter sees: irradiance and flags, row-major.
struct Frame {
    extent: Extent,
    irradiance: Vec<[f32; 3]>,
    flags: Vec<u32>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Steps {
    /// `gauss`: one texel at a time. A flagged texel differs from the one after it: forward it is the last one blended,
    /// backward it is not blended any more.
    Single,
    /// `gauss-fast`: two texels at a time with one weight for both; any flag among them ends the walk before them.
    Pairs,
}

fn to_half(value: Vec3) -> [f32; 3] {
    value.to_array().map(|channel| f16::from_f32(channel).to_f32())
}

/// The twin: both directions, rounded to half floats after each.
fn filtered(frame: &Frame, steps: Steps, kernel: Kernel) -> Vec<[f32; 3]> {
    let horizontal = one_direction(frame, &frame.irradiance, true, steps, kernel);
    one_direction(frame, &horizontal, false, steps, kernel)
}

fn one_direction(frame: &Frame, source: &[[f32; 3]], along_x: bool, steps: Steps, kernel: Kernel) -> Vec<[f32; 3]> {
    let (width, height) = (i64::from(frame.extent.width), i64::from(frame.extent.height));
    let (radius, sigma) = (i64::from(kernel.taps / 2), kernel.sigma);
    let weight = |tap: i64| (-0.5 * (tap * tap) as f32 / (sigma * sigma)).exp();
    let stop_bits = if along_x { kernel.stop_bits.x } else { kernel.stop_bits.y };
    let (length, stride) = if along_x { (width, 1) } else { (height, width) };
    let stops = |texel: i64| frame.flags[texel as usize] & stop_bits != 0;
    let value = |texel: i64| Vec3::from_array(source[texel as usize]);
    let one = |middle: i64| {
        let at = if along_x { middle % width } else { middle / width };
        let (mut sum, mut weights) = (value(middle), 1.0);
        for (direction, room) in [(1, length - 1 - at), (-1, at)] {
            let reach = radius.min(room);
            let mut open = direction < 0 || !stops(middle);
            let mut tap = 1;
            while open && tap <= reach {
                let count = if steps == Steps::Pairs && tap < reach { 2 } else { 1 };
                let group: Vec<i64> = (tap..tap + count).map(|tap| middle + direction * tap * stride).collect();
                let flagged = group.iter().any(|texel| stops(*texel));
                if flagged && (steps == Steps::Pairs || direction < 0) {
                    break;
                }
                let share: f32 = (tap..tap + count).map(weight).sum();
                sum += group.iter().map(|texel| value(*texel)).sum::<Vec3>() * (share / count as f32);
                weights += share;
                open = !flagged;
                tap += count;
            }
        }
        to_half(sum / weights)
    };
    (0..width * height).map(one).collect()
}

/// `slack`: what may be added to the bound at a pixel.
fn require_close(found: &[[f32; 3]], expected: &[[f32; 3]], slack: impl Fn(usize) -> Vec3, extent: Extent, what: &str) {
    assert_eq!(found.len(), expected.len(), "{what}");
    for (index, (found, expected)) in found.iter().zip(expected).enumerate() {
        let [found, expected] = [found, expected].map(|value| Vec3::from_array(*value));
        let bound = expected.abs() * RELATIVE_BOUND + 2.0 * SUBNORMAL_STEP + slack(index);
        let (x, y) = (index as u32 % extent.width, index as u32 / extent.width);
        assert!((found - expected).abs().cmple(bound).all(), "{what}: ({x}, {y}): {found} for {expected}");
    }
}

/// A sampler's weights are fractions of 256 at best (subTexelPrecisionBits): between two texels a fetch is off by up to
/// 1/256 of their difference. Irradiance is at least 0, so the brightest texel in reach bounds every difference.
fn sampler_slack(frame: &Frame, taps: u32, index: usize) -> Vec3 {
    let Extent { width, height } = frame.extent;
    let (x, y, radius) = (index as u32 % width, index as u32 / width, taps / 2);
    let rows = y.saturating_sub(radius)..(y + radius + 1).min(height);
    let brightest = rows.fold(Vec3::ZERO, |brightest, y| {
        let columns = x.saturating_sub(radius)..(x + radius + 1).min(width);
        columns
            .fold(brightest, |brightest, x| brightest.max(Vec3::from_array(frame.irradiance[(y * width + x) as usize])))
    });
    brightest / 256.0
}

#[test]
fn a_frames_filter_is_its_twin() {
    let watched = Watched::open("cornell");
    for (extent, pattern) in [(Extent::new(160, 90), "4x4"), (Extent::new(97, 53), "3x2"), (Extent::new(5, 3), "2x2")] {
        for (filter, steps) in [("gauss", Steps::Single), ("gauss-fast", Steps::Pairs)] {
            for (taps, sigma, ends) in [
                (5, 0.0, "directional"),
                (7, 1.3, "directional"),
                (17, 6.0, "directional"),
                (5, 0.0, "any"),
                (11, 3.0, "any"),
            ] {
                let (size, kernel, deviation) = (extent.to_string(), taps.to_string(), sigma.to_string());
                let common = [("size", size.as_str()), ("pattern", pattern), ("vpls", "64"), ("filter", filter)];
                let own = [("kernel", kernel.as_str()), ("sigma", &deviation), ("discontinuity", ends)];
                let changes = both(&common, &own);
                let renderer = watched.render_stages(TECHNIQUE, &changes, &STAGES);
                let frame = Frame {
                    extent,
                    irradiance: watched.rgb(&renderer, "gather.irradiance"),
                    flags: watched.integers(&renderer, "discontinuity.flags"),
                };
                let flagged = frame.flags.iter().filter(|flag| **flag != 0).count();
                assert!(flagged > 0 && flagged < frame.flags.len(), "{flagged} of {} are flagged", frame.flags.len());
                let sigma = if sigma == 0.0 { taps as f32 / 3.0 } else { sigma };
                let stop_bits = if ends == "any" { StopBits::ANY } else { StopBits::DIRECTIONAL };
                let expected = filtered(&frame, steps, Kernel { taps, sigma, stop_bits, walk_end: WalkEnd::Flag });
                let slack = |index| match steps {
                    Steps::Single => Vec3::ZERO,
                    Steps::Pairs => sampler_slack(&frame, taps, index),
                };
                let found = watched.rgb(&renderer, "filter.irradiance");
                require_close(&found, &expected, slack, extent, &format!("{changes:?}"));
            }
        }
    }
}

/// The pass by itself, on irradiance and flags that no scene gives; however many texels a thread filters and however walks end, the
/// same bits.
fn run_gauss(gpu: &Arc<Gpu>, frame: &Frame, kernel: Kernel, workgroup: [u32; 2]) -> Vec<[f32; 3]> {
    let plain = run_texels(gpu, frame, kernel, workgroup, 1);
    for texels in [3, 8] {
        for walk_end in [WalkEnd::Flag, WalkEnd::Branch] {
            let found = run_texels(gpu, frame, Kernel { walk_end, ..kernel }, workgroup, texels);
            assert_eq!(found, plain, "{texels} texels a thread, {walk_end:?}");
        }
    }
    plain
}

fn run_texels(gpu: &Arc<Gpu>, frame: &Frame, kernel: Kernel, workgroup: [u32; 2], texels: u32) -> Vec<[f32; 3]> {
    let Extent { width, height } = frame.extent;
    let pitch = width.next_multiple_of(2);
    let texel_count = u64::from(pitch * height);
    let buffer = |name: &str, bytes: u64| {
        let flags = vk::BufferUsageFlags::STORAGE_BUFFER
            | vk::BufferUsageFlags::TRANSFER_DST
            | vk::BufferUsageFlags::TRANSFER_SRC;
        Buffer::new(gpu, name, "test", bytes, flags, Use::Device).unwrap()
    };
    // The padding of the rows holds what would be seen if it were ever read.
    let (mut halves, mut flags) = (vec![f16::INFINITY; 4 * texel_count as usize], vec![0u32; texel_count as usize]);
    for (index, texel) in frame.irradiance.iter().enumerate() {
        let place = index / width as usize * pitch as usize + index % width as usize;
        flags[place] = frame.flags[index];
        for channel in 0..3 {
            halves[4 * place + channel] = f16::from_f32(texel[channel]);
        }
    }
    let halves: Vec<u8> = halves.iter().flat_map(|half| half.to_le_bytes()).collect();
    let (source, flag_buffer) = (buffer("test.source", 8 * texel_count), buffer("test.flags", 4 * texel_count));
    let (between, target) = (buffer("test.between", 8 * texel_count), buffer("test.target", 8 * texel_count));
    upload::buffer(gpu, &source, &halves, Access::ComputeRead).unwrap();
    upload::buffer(gpu, &flag_buffer, bytemuck::cast_slice(&flags), Access::ComputeRead).unwrap();
    let workgroup = [("WORKGROUP_X", workgroup[0]), ("WORKGROUP_Y", workgroup[1])];
    let (extent, row_pitch) = (frame.extent, pitch);
    let setup = FilterSetup { label: "test", workgroup: &workgroup, extent, row_pitch, kernel, texels };
    let gauss = Gauss::new(gpu, &setup).unwrap();
    let mut cmd = Commands::begin(gpu, "test", Submits::One).unwrap();
    let readable = Access::ComputeRead;
    gauss.record(&mut cmd, source.from(readable), flag_buffer.from(readable), &between, &target).unwrap();
    cmd.finish().unwrap().run().unwrap();
    let bytes = readback::buffer(gpu, &target, target.bytes, Access::ComputeWrite).unwrap();
    require_silence(gpu, "the filter by itself");
    let texels = decode::words(&bytes).map(decode::halves).enumerate();
    texels.filter(|(index, _)| index % (pitch as usize) < width as usize).map(|(_, texel)| texel).collect()
}

/// Numbers that look random and are the same everywhere (Numerical Recipes' generator).
fn noise(index: usize) -> f32 {
    let mut state = index as u32;
    for _ in 0..3 {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        state ^= state >> 15;
    }
    (state >> 8) as f32 / (1u32 << 24) as f32
}

fn frame_of(extent: Extent, irradiance: impl Fn(usize) -> [f32; 3], flag: impl Fn(usize) -> u32) -> Frame {
    let count = extent.pixel_count() as usize;
    Frame {
        extent,
        irradiance: (0..count).map(|index| to_half(Vec3::from_array(irradiance(index)))).collect(),
        flags: (0..count).map(flag).collect(),
    }
}

#[test]
fn gauss_is_its_twin_on_noise() {
    let gpu = Gpu::open(&watched_device()).unwrap();
    for (extent, workgroup) in [
        (Extent::new(67, 43), [64, 1]),
        (Extent::new(64, 32), [8, 8]),
        (Extent::new(1, 19), [64, 1]),
        (Extent::new(19, 1), [16, 4]),
        (Extent::new(1, 1), [64, 1]),
    ] {
        let color = |index: usize| [0, 1, 2].map(|channel| 10.0 * noise(3 * index + channel));
        for density in [0.0, 0.1, 0.6, 1.0] {
            let bit = |index: usize, bit: usize| u32::from(noise(index + bit * 1_000_003) < density) << (bit - 1);
            let frame = frame_of(extent, color, |index| bit(index, 1) | bit(index, 2) | bit(index, 3));
            for (taps, sigma) in [(5, 5.0 / 3.0), (7, 2.0), (17, 4.0)] {
                for stop_bits in [StopBits::DIRECTIONAL, StopBits::ANY] {
                    let kernel = Kernel { taps, sigma, stop_bits, walk_end: WalkEnd::Flag };
                    let found = run_gauss(&gpu, &frame, kernel, workgroup);
                    let what = format!("{extent}, {kernel:?}, {density} flagged");
                    require_close(&found, &filtered(&frame, Steps::Single, kernel), |_| Vec3::ZERO, extent, &what);
                }
            }
        }
    }
}

#[test]
fn a_constant_irradiance_stays_as_it_is() {
    let gpu = Gpu::open(&watched_device()).unwrap();
    let extent = Extent::new(67, 43);
    for level in [0.0, 0.25, 3.7, 60_000.0] {
        let frame = frame_of(extent, |_| [level, 0.5 * level, level], |index| u32::from(noise(index) < 0.2));
        let kernel = Kernel { taps: 7, sigma: 2.0, stop_bits: StopBits::ANY, walk_end: WalkEnd::Flag };
        let found = run_gauss(&gpu, &frame, kernel, [64, 1]);
        // A weighted mean of one half is that half within float rounding, which the way to half floats takes away.
        assert_eq!(found, frame.irradiance, "level {level}");
    }
}

#[test]
fn a_flagged_column_keeps_its_two_sides_apart() {
    let gpu = Gpu::open(&watched_device()).unwrap();
    let extent = Extent::new(32, 8);
    let is_left = |index: usize| index % 32 <= 15;
    let sides = |index| if is_left(index) { [1.0; 3] } else { [9.0; 3] };
    let frame = frame_of(extent, sides, |index| u32::from(index % 32 == 15));
    for stop_bits in [StopBits::DIRECTIONAL, StopBits::ANY] {
        let kernel = Kernel { taps: 17, sigma: 4.0, stop_bits, walk_end: WalkEnd::Flag };
        assert_eq!(run_gauss(&gpu, &frame, kernel, [64, 1]), frame.irradiance, "{stop_bits:?}");
        assert_eq!(filtered(&frame, Steps::Pairs, kernel), frame.irradiance, "in pairs, {stop_bits:?}");
    }
    // Along x, a step in y is no obstacle to a directional walk, and one to the paper's flag.
    let steps = frame_of(extent, sides, |index| if index % 32 == 15 { 2 } else { 0 });
    let run = |stop_bits| {
        run_gauss(&gpu, &steps, Kernel { taps: 17, sigma: 4.0, stop_bits, walk_end: WalkEnd::Flag }, [64, 1])
    };
    assert_ne!(run(StopBits::DIRECTIONAL), steps.irradiance);
    assert_eq!(run(StopBits::ANY), steps.irradiance);
}

/// Pairs share one weight, so the two filters differ; on a ramp the errors of both sides cancel.
#[test]
fn pairs_are_as_good_as_single_steps_on_a_ramp() {
    let extent = Extent::new(64, 48);
    let ramp = |index: usize| [1.0 + 0.01 * (index % 64) as f32, 2.0 + 0.02 * (index / 64) as f32, 3.0];
    let frame = frame_of(extent, ramp, |_| 0);
    let kernel = Kernel { taps: 5, sigma: 5.0 / 3.0, stop_bits: StopBits::ANY, walk_end: WalkEnd::Flag };
    let [single, pairs] = [Steps::Single, Steps::Pairs].map(|steps| filtered(&frame, steps, kernel));
    for (index, (single, pairs)) in single.iter().zip(&pairs).enumerate() {
        let (x, y) = (index as u32 % extent.width, index as u32 / extent.width);
        let inside = x >= 2 && y >= 2 && x < extent.width - 2 && y < extent.height - 2;
        // Inside: the rounding of both. At the frame's edge: half the difference of two weights times a step of the ramp.
        let bound = if inside { 3.0 * RELATIVE_BOUND } else { 3.0 * RELATIVE_BOUND + 0.02 };
        assert!(
            (0..3).all(|channel| (single[channel] - pairs[channel]).abs() <= bound),
            "({x}, {y}): {single:?} {pairs:?}"
        );
    }
}

/// The two filters on a real frame, where no flag is in reach of either.
#[test]
fn gauss_fast_is_close_to_gauss_where_no_flag_is() {
    let watched = Watched::open("cornell");
    let extent = Extent::new(161, 91);
    let size = extent.to_string();
    let common = [("size", size.as_str()), ("vpls", "512"), ("pattern", "4x4")];
    let gauss = watched.render_stages(TECHNIQUE, &common, &STAGES);
    let fast = watched.render_stages(TECHNIQUE, &both(&common, &[("filter", "gauss-fast")]), &STAGES);
    let flags = watched.integers(&gauss, "discontinuity.flags");
    let [slow, fast] = [&gauss, &fast].map(|renderer| watched.rgb(renderer, "filter.irradiance"));
    let at = |x: u32, y: u32| (y * extent.width + x) as usize;
    let (mut compared, mut sum, mut difference) = (0, 0.0, 0.0);
    for y in 2..extent.height - 2 {
        for x in 2..extent.width - 2 {
            if (y - 2..=y + 2).any(|y| (x - 2..=x + 2).any(|x| flags[at(x, y)] != 0)) {
                continue;
            }
            compared += 1;
            let (slow, fast) = (Vec3::from_array(slow[at(x, y)]), Vec3::from_array(fast[at(x, y)]));
            sum += f64::from(slow.element_sum());
            difference += f64::from((slow - fast).abs().element_sum());
        }
    }
    assert!(compared > 4000, "only {compared} pixels are free of flags");
    // Weights of sigma 5/3 are 0.835 and 0.487; a pair has 0.661 for both. Each of its two texels has another subset, so
    // the error is 0.17 / 3.6 of the spread between subsets, in four places: a few per cent.
    assert!(difference < 0.05 * sum, "{} of the irradiance", difference / sum);
}
