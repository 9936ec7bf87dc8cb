//! The levels of a texture, made on the host: the same texels on every driver.

use super::{ColorSpace, Image, ShownTexels, Wrap};
use crate::picture::tonemap::linear_from_srgb;
use std::ops::Range;

/// How many levels a picture of this size has, down to one texel.
pub fn level_count(width: u32, height: u32) -> u32 {
    32 - width.max(height).max(1).leading_zeros()
}

/// Width and height of a level, 0 the finest.
fn size_of_level(image: &Image, level: u32) -> [usize; 2] {
    [image.width, image.height].map(|side| (side >> level).max(1) as usize)
}

/// Texels of these levels of a picture of this size, 0 the finest.
pub fn texel_count(width: u32, height: u32, levels: Range<u32>) -> u64 {
    let side = |side: u32, level: u32| u64::from((side >> level).max(1));
    levels.map(|level| side(width, level) * side(height, level)).sum()
}

fn bytes_of(image: &Image, levels: Range<u32>) -> usize {
    4 * texel_count(image.width, image.height, levels) as usize
}

/// How much of a level's texel a texel counts that no triangle shows: so little that it is not seen beside one that is, while where
/// there is none the mean is theirs. A power of two: weights, and what is weighted, stay as exact as they are.
const HIDDEN_WEIGHT: f32 = 1.0 / (1u64 << 40) as f32;

/// A texel as numbers: 4, or with a weight 5, which are the numbers times the weight, and the weight.
type Numbers<const COUNT: usize> = [f32; COUNT];

const PLAIN: usize = 4;
const WEIGHTED: usize = 5;

/// Writes these levels, 0 the finest, one after the other: RGBA8, each a box filter of the one before. Colour is averaged
/// as light, not as code values. `target` has as many bytes as they need.
///
/// With `shown`, of the finest level, coarser ones are means of what is shown, and texels of them that have nothing of it take after
/// their neighbours that do, or else after the level above: what filters read beside a chart is like the chart. The finest is
/// as it was painted.
///
/// Row by row: beside `target` it holds a few rows of numbers and no level, because the numbers of a whole picture would
/// be four times as large as the picture.
pub fn write(
    image: &Image,
    color_space: ColorSpace,
    levels: Range<u32>,
    shown: Option<&ShownTexels>,
    target: &mut [u8],
) {
    assert!(levels.end <= level_count(image.width, image.height), "{}: it has no level {levels:?}", image.name);
    assert_eq!(target.len(), bytes_of(image, levels.clone()), "{}: bytes of its levels {levels:?}", image.name);
    let codec = Codec::new(color_space);
    match shown {
        None => write_means::<PLAIN>(image, &codec, levels, |_, _| 1.0, target),
        Some(shown) => {
            let weight = |x, y| if shown.contains(x, y) { 1.0 } else { HIDDEN_WEIGHT };
            write_means::<WEIGHTED>(image, &codec, levels.clone(), weight, target);
            fill_gutters(image, &codec, levels, shown, target);
        }
    }
}

/// Writes the levels, each the mean of the one before. `weight`: of a texel of the finest, of `WEIGHTED`.
fn write_means<const COUNT: usize>(
    image: &Image,
    codec: &Codec,
    levels: Range<u32>,
    weight: impl Fn(u32, u32) -> f32,
    target: &mut [u8],
) {
    let mut rest = target;
    let mut rows: Vec<_> = (0..levels.end)
        .map(|level| {
            let [width, _] = size_of_level(image, level);
            let bytes = if levels.contains(&level) { bytes_of(image, level..level + 1) } else { 0 };
            rest.split_off_mut(..bytes).expect("the target is as long as its levels").chunks_exact_mut(4 * width)
        })
        .collect();
    // The even row of each level that waits for the odd one.
    let mut waiting: Vec<Vec<Numbers<COUNT>>> = vec![Vec::new(); levels.end as usize];
    for (y, texels) in image.rgba8.chunks_exact(4 * image.width as usize).enumerate() {
        if let Some(Some(written)) = rows.first_mut().map(Iterator::next) {
            written.copy_from_slice(texels);
        }
        if levels.end == 1 {
            continue;
        }
        let numbers = |(x, texel)| weighted::<COUNT>(codec.decode(texel), weight(x, y as u32));
        let (mut y, mut finer) = (y, (0..).zip(texels.chunks_exact(4)).map(numbers).collect());
        for level in 1..levels.end {
            let (of_finer, at) = (size_of_level(image, level - 1), level as usize);
            let is_alone = of_finer[1] == 1;
            if !is_alone && y % 2 == 0 {
                // An odd last row waits for ever: the coarser level ends before it.
                waiting[at] = finer;
                break;
            }
            let first = if is_alone { finer.clone() } else { std::mem::take(&mut waiting[at]) };
            let coarser = halved([&first, &finer], size_of_level(image, level)[0]);
            if let Some(written) = rows[at].next() {
                written
                    .chunks_exact_mut(4)
                    .zip(&coarser)
                    .for_each(|(to, from)| to.copy_from_slice(&codec.encode(mean(*from))));
            }
            (y, finer) = (y / 2, coarser);
        }
    }
}

fn weighted<const COUNT: usize>(channels: [f32; 4], weight: f32) -> Numbers<COUNT> {
    std::array::from_fn(|index| if index < PLAIN { channels[index] * weight } else { weight })
}

fn mean<const COUNT: usize>(numbers: Numbers<COUNT>) -> [f32; 4] {
    let weight = if COUNT == WEIGHTED { numbers[COUNT - 1] } else { 1.0 };
    std::array::from_fn(|channel| numbers[channel] / weight)
}

/// Gives the texels of `target`'s levels that have nothing shown the mean of their neighbours that have, across the picture's edges too,
/// or what the level above has in their place. Of the levels that `write` has written, not the finest of all.
fn fill_gutters(image: &Image, codec: &Codec, levels: Range<u32>, shown: &ShownTexels, target: &mut [u8]) {
    let mut shown_at: Vec<ShownTexels> = Vec::new();
    for _ in 1..levels.end {
        let coarser = shown_at.last().unwrap_or(shown).coarser();
        shown_at.push(coarser);
    }
    let start_of = |level: u32| bytes_of(image, levels.start..level);
    for level in (levels.start.max(1)..levels.end).rev() {
        let shown = &shown_at[level as usize - 1];
        let (finer, coarser) = target[start_of(level)..].split_at_mut(bytes_of(image, level..level + 1));
        let [width, height] = size_of_level(image, level);
        for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
            if shown.contains(x as u32, y as u32) {
                continue;
            }
            let to = 4 * (y * width + x);
            if !shown.has_near(x as u32, y as u32) {
                if level + 1 < levels.end {
                    let [coarser_width, coarser_height] = size_of_level(image, level + 1);
                    let at = (y / 2).min(coarser_height - 1) * coarser_width + (x / 2).min(coarser_width - 1);
                    finer[to..to + 4].copy_from_slice(&coarser[4 * at..][..4]);
                }
                continue;
            }
            let mut sum: Numbers<WEIGHTED> = [0.0; WEIGHTED];
            for (right, down) in [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)] {
                let column = Wrap::Repeat.texel(x as i64 + right, width as u32);
                let row = Wrap::Repeat.texel(y as i64 + down, height as u32);
                if shown.contains(column, row) {
                    let start = 4 * (row as usize * width + column as usize);
                    let neighbour: Numbers<WEIGHTED> = weighted(codec.decode(&finer[start..start + 4]), 1.0);
                    sum.iter_mut().zip(neighbour).for_each(|(sum, value)| *sum += value);
                }
            }
            finer[to..to + 4].copy_from_slice(&codec.encode(mean(sum)));
        }
    }
}

/// The row of `width` texels that two rows of the finer level become.
fn halved<const COUNT: usize>(rows: [&[Numbers<COUNT>]; 2], width: usize) -> Vec<Numbers<COUNT>> {
    let last = rows[0].len() - 1;
    let texel = |x: usize| {
        let mut sum = [0.0; COUNT];
        for row in rows {
            for column in [2 * x, (2 * x + 1).min(last)] {
                for (sum, channel) in sum.iter_mut().zip(row[column]) {
                    *sum += 0.25 * channel;
                }
            }
        }
        sum
    };
    (0..width).map(texel).collect()
}

/// Code values to numbers and back, by table where it is a curve.
struct Codec {
    linear: Vec<f32>,
    color_space: ColorSpace,
    /// The least light that rounds to each code.
    starts: Vec<f32>,
}

impl Codec {
    fn new(color_space: ColorSpace) -> Self {
        let linear = (0..256)
            .map(|code| match color_space {
                ColorSpace::Linear => code as f32 / 255.0,
                ColorSpace::Srgb => linear_from_srgb(f64::from(code) / 255.0) as f32,
            })
            .collect();
        // A code begins where the light between it and the one before rounds up to it.
        let starts = (0..256)
            .map(|code| match color_space {
                ColorSpace::Linear => (code as f32 - 0.5) / 255.0,
                ColorSpace::Srgb => linear_from_srgb(((f64::from(code) - 0.5) / 255.0).max(0.0)) as f32,
            })
            .collect();
        Self { linear, color_space, starts }
    }

    fn decode(&self, texel: &[u8]) -> [f32; 4] {
        let color = |channel: usize| self.linear[texel[channel] as usize];
        [color(0), color(1), color(2), f32::from(texel[3]) / 255.0]
    }

    fn encode(&self, [r, g, b, a]: [f32; 4]) -> [u8; 4] {
        let alpha = (a * 255.0 + 0.5) as u8;
        let color = |value: f32| match self.color_space {
            ColorSpace::Linear => (value * 255.0 + 0.5) as u8,
            ColorSpace::Srgb => (self.starts.partition_point(|start| *start <= value).max(1) - 1) as u8,
        };
        [color(r), color(g), color(b), alpha]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::tonemap::srgb_from_linear;

    fn levels(image: &Image, color_space: ColorSpace) -> Vec<u8> {
        let all = 0..level_count(image.width, image.height);
        let mut bytes = vec![0; bytes_of(image, all.clone())];
        write(image, color_space, all, None, &mut bytes);
        bytes
    }

    #[test]
    fn some_levels_are_a_part_of_all() {
        for (width, height) in [(1024, 1024), (1000, 3), (7, 513), (1, 1), (641, 359), (1, 9), (9, 1)] {
            let rgba8 = (0..4 * width * height).map(|at| (at * 7 % 251) as u8).collect();
            let image = Image { name: String::new(), width, height, rgba8 };
            let count = level_count(width, height);
            let all = levels(&image, ColorSpace::Srgb);
            for some in (0..count).flat_map(|first| [first..first + 1, first..count]) {
                let mut found = vec![0; bytes_of(&image, some.clone())];
                write(&image, ColorSpace::Srgb, some.clone(), None, &mut found);
                let start = bytes_of(&image, 0..some.start);
                assert!(found == all[start..start + found.len()], "{width}x{height}: {some:?}");
            }
        }
    }

    /// Level by level and texel by texel, as the definition has it.
    #[test]
    fn a_level_is_the_box_filter_of_the_one_before() {
        for (width, height) in [(8u32, 8u32), (13, 7), (5, 1), (1, 6), (3, 3)] {
            let rgba8: Vec<u8> = (0..4 * width * height).map(|at| (at * 37 % 256) as u8).collect();
            let image = Image { name: String::new(), width, height, rgba8: rgba8.clone() };
            let all = levels(&image, ColorSpace::Linear);
            let mut finer: Vec<f32> = rgba8.iter().map(|code| f32::from(*code) / 255.0).collect();
            let mut expected = rgba8;
            for level in 1..level_count(width, height) {
                let [from_width, from_height] = size_of_level(&image, level - 1);
                let [to_width, to_height] = size_of_level(&image, level);
                let mut coarser = Vec::new();
                for at in 0..4 * to_width * to_height {
                    let (channel, x, y) = (at % 4, at / 4 % to_width, at / 4 / to_width);
                    let rows = [2 * y, (2 * y + 1).min(from_height - 1)];
                    let columns = [2 * x, (2 * x + 1).min(from_width - 1)];
                    let value = |row, column| finer[4 * (row * from_width + column) + channel];
                    let of_row = |row| columns.map(|column| value(row, column));
                    let sum: f32 = rows.map(of_row).iter().flatten().fold(0.0, |sum, value| sum + 0.25 * value);
                    coarser.push(sum);
                    expected.push((sum * 255.0 + 0.5) as u8);
                }
                finer = coarser;
            }
            assert_eq!(all, expected, "{width}x{height}");
        }
    }

    /// Sides that are powers of two: a texel of a level stands for a square of finest ones.
    #[test]
    fn coarser_levels_are_means_of_what_is_shown() {
        let (width, height) = (32u32, 16u32);
        // Shown: one number in red, all the same colour in green and blue; hidden: another, in all.
        let is_shown = |x: u32, y: u32| (3..=9).contains(&x) && y > 4 || (x, y) == (25, 2);
        let shown = ShownTexels::with([width, height], is_shown);
        let texel = |x: u32, y: u32| match is_shown(x, y) {
            true => [(x * 17 + y * 5) as u8, 80, 200, 255],
            false => [250, 250, 0, 0],
        };
        let rgba8: Vec<u8> = (0..width * height).flat_map(|at| texel(at % width, at / width)).collect();
        let image = Image { name: String::new(), width, height, rgba8: rgba8.clone() };
        let all = 0..level_count(width, height);
        let mut found = vec![0; bytes_of(&image, all.clone())];
        write(&image, ColorSpace::Linear, all.clone(), Some(&shown), &mut found);
        assert_eq!(found[..rgba8.len()], rgba8);
        for level in 1..all.end {
            let [level_width, level_height] = size_of_level(&image, level).map(|side| side as u32);
            for (x, y) in (0..level_height).flat_map(|y| (0..level_width).map(move |x| (x, y))) {
                let start = bytes_of(&image, 0..level) + 4 * (y * level_width + x) as usize;
                let of = |at: u32, side: u32, finest: u32| at * finest / side..(at + 1) * finest / side;
                let squares = of(y, level_height, height).flat_map(|y| of(x, level_width, width).map(move |x| (x, y)));
                let reds: Vec<f64> =
                    squares.filter(|(x, y)| is_shown(*x, *y)).map(|(x, y)| f64::from(texel(x, y)[0])).collect();
                let [red, others @ ..] = &found[start..start + 4] else { unreachable!() };
                // What has nothing of its own takes after others that are shown, too.
                assert_eq!(others, [80, 200, 255], "level {level}, {x} {y}");
                if !reds.is_empty() {
                    let mean = reds.iter().sum::<f64>() / reds.len() as f64;
                    assert!((f64::from(*red) - mean).abs() <= 0.51, "level {level}, {x} {y}: {red} for {mean}");
                }
            }
        }
        // Beside what is shown lies the mean of the neighbours that are.
        let start = bytes_of(&image, 0..1);
        let red = |x: usize, y: usize| f64::from(found[start + 4 * (16 * y + x)]);
        let mean = (red(4, 3) + red(4, 4) + red(4, 5)) / 3.0;
        assert!((red(5, 4) - mean).abs() <= 0.51, "{} for {mean}", red(5, 4));
    }

    #[test]
    fn what_is_shown_whole_has_the_levels_of_its_picture() {
        let (width, height) = (37, 22);
        let rgba8 = (0..4 * width * height).map(|at| (at * 91 % 256) as u8).collect();
        let image = Image { name: String::new(), width, height, rgba8 };
        let all = 0..level_count(width, height);
        for space in [ColorSpace::Srgb, ColorSpace::Linear] {
            let mut found = vec![0; bytes_of(&image, all.clone())];
            write(&image, space, all.clone(), Some(&ShownTexels::with([width, height], |_, _| true)), &mut found);
            assert!(found == levels(&image, space), "{space:?}");
        }
    }

    #[test]
    fn levels_go_down_to_one_texel_and_average_light() {
        let rgba8 = [[0u8, 0, 0, 255], [255, 255, 255, 255]].concat().repeat(4);
        let image = Image { name: String::new(), width: 4, height: 2, rgba8 };
        assert_eq!(level_count(4, 2), 3);
        let all = levels(&image, ColorSpace::Srgb);
        assert_eq!(all.len(), 4 * (8 + 2 + 1));
        // Half the light of white is code 188, not 128.
        let half = (srgb_from_linear(0.5) * 255.0).round() as u8;
        assert_eq!(&all[4 * 10..], [half, half, half, 255]);
        assert_eq!(levels(&image, ColorSpace::Linear)[4 * 10], 128);
    }

    #[test]
    fn every_code_survives_a_level_of_its_own_color() {
        for code in 0..=255u8 {
            let image = Image { name: String::new(), width: 2, height: 2, rgba8: vec![code; 16] };
            for space in [ColorSpace::Srgb, ColorSpace::Linear] {
                assert_eq!(&levels(&image, space)[16..], [code; 4], "{space:?}");
            }
        }
    }
}
