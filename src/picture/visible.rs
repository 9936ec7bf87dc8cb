//! Stages as pictures: an AOV shown as a PNG beside the picture's. The numbers are in an EXR.

use super::tonemap::linear_from_srgb;
use super::{Aov, AovChannels, Picture};
use crate::units::Extent;

/// sRGB of the lengths of lists: 0, 1 and so on, 7 and more as the last. One is dark blue and two cyan, as in the heat maps of
/// Clarberg & Munkberg 2014, figures 1 and 5; on go green, yellow, orange, red and white.
const LENGTHS: [[u8; 3]; 8] =
    [[0, 0, 0], [0, 0, 160], [0, 220, 255], [60, 220, 60], [255, 240, 0], [255, 140, 0], [220, 0, 0], [255, 255, 255]];

/// The stage as light that a PNG shows: normals from -1..1 to 0..1, irradiance as a white surface would show it, depths as a part
/// of the greatest, vectors around grey and as a part of the longest, a colour for each id, of an object or a triangle, for each
/// address and for each length of a list, other whole numbers as they are: flags are white.
pub fn visible(aov: &Aov, extent: Extent) -> Picture {
    let is = |ending: &str| aov.name.ends_with(ending);
    let pixels = match &aov.channels {
        AovChannels::Rgb(values) if is("normal") => around_grey(values, 1.0),
        AovChannels::Rgb(values) if is("motion") || is("shifts") => {
            around_grey(values, greatest(values.iter().flatten()))
        }
        AovChannels::Rgb(values) if is("irradiance") => {
            values.iter().map(|value| value.map(|channel| channel / std::f32::consts::PI)).collect()
        }
        AovChannels::Rgb(values) => values.clone(),
        AovChannels::Y(values) if is("depth") || is("zmax") => {
            let most = greatest(values);
            values.iter().map(|value| [value / most; 3]).collect()
        }
        AovChannels::Y(values) => values.iter().map(|value| [*value; 3]).collect(),
        AovChannels::YU32(values) if is(".id") || is("spids") || is("addresses") => {
            values.iter().map(|id| color_of(*id)).collect()
        }
        AovChannels::YU32(values) if is("lengths") => values.iter().map(|length| color_of_length(*length)).collect(),
        AovChannels::YU32(values) => values.iter().map(|value| [*value as f32; 3]).collect(),
    };
    Picture { extent, pixels }
}

fn around_grey(values: &[[f32; 3]], most: f32) -> Vec<[f32; 3]> {
    values.iter().map(|value| value.map(|channel| 0.5 + 0.5 * channel / most)).collect()
}

/// Greatest size of a finite number; 1 where all are 0.
fn greatest<'a>(values: impl IntoIterator<Item = &'a f32>) -> f32 {
    let most = values.into_iter().filter(|value| value.is_finite()).fold(0f32, |most, value| most.max(value.abs()));
    if most > 0.0 { most } else { 1.0 }
}

/// Bytes of the id times an odd number near 2^32 over the golden ratio: ids that follow each other look unlike.
fn color_of(id: u32) -> [f32; 3] {
    let [_, red, green, blue] = id.wrapping_add(1).wrapping_mul(0x9e37_79b1).to_le_bytes();
    [red, green, blue].map(|byte| f32::from(byte) / 255.0)
}

fn color_of_length(length: u32) -> [f32; 3] {
    LENGTHS[(length as usize).min(LENGTHS.len() - 1)].map(|code| linear_from_srgb(f64::from(code) / 255.0) as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::tonemap::{Srgb8, ToneMap};

    fn shown(name: &str, channels: AovChannels) -> Vec<[f32; 3]> {
        visible(&Aov { name: name.to_owned(), channels }, Extent::new(3, 1)).pixels
    }

    #[test]
    fn lengths_of_lists_have_the_codes_of_their_table() {
        let colors = shown("count.lengths", AovChannels::YU32(vec![0, 1, 2, 7, 4000]));
        let extent = Extent::new(5, 1);
        let codes = Srgb8::from_picture(&Picture { extent, pixels: colors }, 0.0, ToneMap::default()).pixels;
        assert_eq!(codes, [LENGTHS[0], [0, 0, 160], [0, 220, 255], [255; 3], [255; 3]]);
    }

    #[test]
    fn depths_ids_and_vectors_can_be_told_apart() {
        let depths = shown("geometry.dsf.depth", AovChannels::Y(vec![0.0, 20.0, 80.0]));
        assert_eq!(depths, [[0.0; 3], [0.25; 3], [1.0; 3]]);
        assert_eq!(shown("depth", AovChannels::Y(vec![0.0; 3])), [[0.0; 3]; 3]);
        for name in ["geometry.dsf.id", "visibility.spids"] {
            let ids = shown(name, AovChannels::YU32(vec![0x0100, 0x0101, 0x0200]));
            for (a, b) in [(0, 1), (1, 2), (0, 2)] {
                let away = ids[a].iter().zip(&ids[b]).map(|(a, b)| (a - b).abs()).fold(0f32, f32::max);
                assert!(away > 0.1, "{ids:?}");
            }
        }
        // No triangle.
        assert_eq!(shown("visibility.spids", AovChannels::YU32(vec![u32::MAX; 3])), [[0.0; 3]; 3]);
        let moved = shown("geometry.motion", AovChannels::Rgb(vec![[0.0; 3], [4.0, -2.0, 0.0], [-4.0, 0.0, 0.0]]));
        assert_eq!(moved, [[0.5; 3], [1.0, 0.25, 0.5], [0.0, 0.5, 0.5]]);
        assert_eq!(shown("discontinuity.flags", AovChannels::YU32(vec![0, 1, 7])), [[0.0; 3], [1.0; 3], [7.0; 3]]);
    }
}
