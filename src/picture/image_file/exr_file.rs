//! EXR: the picture in R, G, B, every AOV as a named layer of the same part.
//!
//! Why this way: OpenEXR knows parts (each a picture of its own) and layers (channels with a dotted name). Viewers such as
//! tev show both, but many programs read only the first part, so the AOVs are layers of the one part.

use std::fs::File;
use std::io::{BufReader, Read, Seek};
use std::path::Path;

use exr::block::UncompressedBlock;
use exr::block::reader::{ChunksReader, Reader};
use exr::compression::Compression;
use exr::error::Error as ExrError;
use exr::image::write::WritableImage;
use exr::image::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer};
use exr::math::Vec2;
use exr::meta::attribute::{AttributeValue, Chromaticities, SampleType, Text};
use exr::meta::header::{Header, LayerAttributes};
use half::f16;

use super::limits::{DECODED_LIMIT, require_within_limits, unreadable};
use super::options::{ExrPrecision, Texts, WriteOptions};
use crate::error::Result;
use crate::picture::{Aov, AovChannels, Picture};
use crate::units::{Bytes, Extent};
use crate::whole_file::write_whole;

/// The picture's channels, in the order of a pixel.
const RGB: [&str; 3] = ["R", "G", "B"];

/// The primaries and the white point of ITU-R BT.709 as CIE x, y.
const REC709: Chromaticities = Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.30, 0.60),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.3290),
};

pub(super) fn write(path: &Path, picture: &Picture, options: &WriteOptions) -> Result<()> {
    let mut channels = rgb_channels("", &picture.pixels, options.exr_precision);
    for aov in options.aovs {
        assert_eq!(aov.channels.pixel_count(), picture.pixels.len(), "AOV {} has the picture's extent", aov.name);
        channels.extend(aov_channels(aov, options.exr_precision));
    }
    // Text is stored as it is: a path in the command line may hold any bytes.
    let text = |string: &str| Text::from_bytes_unchecked(string.as_bytes().into());
    let mut attributes = LayerAttributes::default();
    for (name, value) in &options.attributes {
        attributes.other.insert(text(name), AttributeValue::Text(text(value)));
    }
    let size = (picture.extent.width as usize, picture.extent.height as usize);
    // Scan lines under ZIP: lossless, and the one compression that every reader has.
    let layer = Layer::new(size, attributes, Encoding::SMALL_LOSSLESS, AnyChannels::sort(channels.into()));
    let mut image = Image::from_layer(layer);
    image.attributes.chromaticities = Some(REC709);
    write_whole(path, |file| image.write().to_buffered(file))
}

fn aov_channels(aov: &Aov, precision: ExrPrecision) -> Vec<AnyChannel<FlatSamples>> {
    let y_name = || channel_name(&aov.name, "Y");
    match &aov.channels {
        AovChannels::Rgb(pixels) => rgb_channels(&aov.name, pixels, precision),
        AovChannels::Y(values) => vec![AnyChannel::new(y_name(), samples(values.iter().copied(), precision))],
        AovChannels::YU32(values) => vec![AnyChannel::new(y_name(), FlatSamples::U32(values.clone()))],
    }
}

fn rgb_channels(layer: &str, pixels: &[[f32; 3]], precision: ExrPrecision) -> Vec<AnyChannel<FlatSamples>> {
    RGB.iter()
        .enumerate()
        .map(|(index, name)| {
            AnyChannel::new(channel_name(layer, name), samples(pixels.iter().map(|pixel| pixel[index]), precision))
        })
        .collect()
}

/// `layer.channel`, or `channel` alone where the layer has no name.
fn channel_name(layer: &str, channel: &str) -> Text {
    let name = if layer.is_empty() { channel.to_owned() } else { format!("{layer}.{channel}") };
    Text::from_bytes_unchecked(name.as_bytes().into())
}

fn samples(values: impl Iterator<Item = f32>, precision: ExrPrecision) -> FlatSamples {
    match precision {
        ExrPrecision::Float => FlatSamples::F32(values.collect()),
        ExrPrecision::Half => FlatSamples::F16(values.map(half_from_float).collect()),
    }
}

/// Nearest half, ties to even; finite stays finite, because a picture that holds infinity cannot be compared.
fn half_from_float(value: f32) -> f16 {
    let nearest = f16::from_f32(value);
    if nearest.is_infinite() && value.is_finite() { f16::MAX.copysign(nearest) } else { nearest }
}

pub(super) fn read(path: &Path) -> Result<Picture> {
    read_with_texts(path).map(|(picture, _)| picture)
}

/// The picture, and the texts of its part's header by name.
pub(super) fn read_with_texts(path: &Path) -> Result<(Picture, Texts)> {
    let (extent, pixels, texts) = read_channels(path, None, RGB)?;
    Ok((Picture { extent, pixels }, texts))
}

/// What `read_channels` finds: the extent, the pixels, and the texts of the part's header by name.
type Channels<const N: usize> = (Extent, Vec<[f32; N]>, Texts);

/// These channels of the first part that has all of them. `expected`: another extent is refused before a pixel is decoded.
pub(super) fn read_channels<const N: usize>(
    path: &Path,
    expected: Option<Extent>,
    names: [&str; N],
) -> Result<Channels<N>> {
    let broken = |error: ExrError| match error {
        ExrError::Io(error) => unreadable(path, &error),
        other => unreadable(path, &format!("it is not an EXR, or a broken one ({other})")),
    };
    let file = File::open(path).map_err(|error| unreadable(path, &error))?;
    let reader = Reader::read_from_buffered(BufReader::new(file), false).map_err(broken)?;
    let part_index = require_readable(path, reader.headers(), &names)?;
    let Vec2(width, height) = reader.headers()[part_index].layer_size;
    let extent = Extent::new(width as u32, height as u32);
    if let Some(expected) = expected.filter(|expected| *expected != extent) {
        return Err(unreadable(path, &format!("it is {extent}, where --size is {expected}")));
    }
    let others = reader.headers()[part_index].own_attributes.other.iter();
    let texts = others.filter_map(|(name, value)| match value {
        AttributeValue::Text(text) => Some((name.to_string(), text.to_string())),
        _ => None,
    });
    let texts = texts.collect();
    Ok((extent, decode(reader, part_index, names).map_err(broken)?, texts))
}

/// The index of the part that has these channels, when all that decoding makes by the headers' word is within the limits.
fn require_readable(path: &Path, headers: &[Header], wanted: &[&str]) -> Result<usize> {
    // The offset tables of all parts are read, so every part's claim counts.
    for header in headers {
        let Vec2(width, height) = header.layer_size;
        let extent = require_within_limits(path, width as u64, height as u64)?;
        let decoded = Bytes(extent.pixel_count().saturating_mul(header.channels.bytes_per_pixel as u64));
        if decoded > DECODED_LIMIT {
            return Err(unreadable(path, &format!("its channels take {decoded}; at most {DECODED_LIMIT} are decoded")));
        }
    }
    let has = |header: &Header, name: &str| header.channels.list.iter().any(|channel| channel.name.eq(name));
    let is_picture = |header: &Header| !header.deep && wanted.iter().all(|name| has(header, name));
    let Some(part_index) = headers.iter().position(is_picture) else {
        let all_channels = headers.iter().flat_map(|header| &header.channels.list);
        let names: Vec<String> = all_channels.take(8).map(|channel| channel.name.to_string()).collect();
        let (wanted, found) = (wanted.join(", "), names.join(", "));
        return Err(unreadable(path, &format!("no flat part has the channels {wanted} (found {found})")));
    };
    let part = &headers[part_index];
    if part.channels.list.iter().any(|channel| channel.sampling != Vec2(1, 1)) {
        return Err(unreadable(path, &"it has subsampled channels; one sample a pixel is read"));
    }
    // The decoders of B44 and DWA trust the file: a broken one overflows or asks for terabytes (exr 1.74.2).
    let trusted = matches!(
        part.compression,
        Compression::Uncompressed
            | Compression::RLE
            | Compression::ZIP1
            | Compression::ZIP16
            | Compression::PIZ
            | Compression::PXR24
    );
    if !trusted {
        let compression = part.compression;
        return Err(unreadable(path, &format!("it has {compression}; none, RLE, ZIP, PIZ and PXR24 are read")));
    }
    Ok(part_index)
}

/// Channels of one part at full resolution.
fn decode<const N: usize>(
    reader: Reader<impl Read + Seek>,
    part_index: usize,
    names: [&str; N],
) -> exr::error::Result<Vec<[f32; N]>> {
    let Vec2(width, height) = reader.headers()[part_index].layer_size;
    let mut pixels = vec![[0.0; N]; width * height];
    let mut chunks = reader
        .filter_chunks(false, |_, tile, block| block.layer == part_index && tile.is_largest_resolution_level())?;
    while let Some(chunk) = chunks.read_next_chunk() {
        let chunk = chunk?;
        // The table of offsets may point anywhere, also at another part's pixels or at a smaller level's.
        if chunk.layer_index != part_index {
            return Err(ExrError::Invalid("chunk of another part".into()));
        }
        let block = UncompressedBlock::decompress_chunk(chunk, chunks.meta_data(), false)?;
        if block.index.level != Vec2(0, 0) {
            return Err(ExrError::Invalid("chunk of another level".into()));
        }
        let channels = &chunks.headers()[part_index].channels;
        for line in block.lines(channels) {
            let channel = &channels.list[line.location.channel];
            let Some(place) = names.iter().position(|name| channel.name.eq(name)) else { continue };
            let Vec2(x, y) = line.location.position;
            let row = &mut pixels[y * width + x..][..line.location.sample_count];
            match channel.sample_type {
                SampleType::F16 => fill(row, place, line.read_samples::<f16>(), f16::to_f32),
                SampleType::F32 => fill(row, place, line.read_samples::<f32>(), |sample| sample),
                SampleType::U32 => fill(row, place, line.read_samples::<u32>(), |sample| sample as f32),
            }?;
        }
    }
    Ok(pixels)
}

/// One channel of a piece of a row.
fn fill<const N: usize, T>(
    row: &mut [[f32; N]],
    place: usize,
    samples: impl Iterator<Item = exr::error::Result<T>>,
    to_float: impl Fn(T) -> f32,
) -> exr::error::Result<()> {
    for (pixel, sample) in row.iter_mut().zip(samples) {
        pixel[place] = to_float(sample?);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use exr::image::read::read_first_flat_layer_from_file;

    use super::*;

    /// Values that no float format but the right one keeps.
    fn gradient(extent: Extent) -> Picture {
        let mut picture = Picture::filled(extent, [0.0; 3]);
        for (index, pixel) in picture.pixels.iter_mut().enumerate() {
            let t = index as f32;
            *pixel = [t / 3.0, -t * 1e-3, 1e6 + t];
        }
        picture
    }

    fn options(exr_precision: ExrPrecision) -> WriteOptions<'static> {
        WriteOptions { exr_precision, ..WriteOptions::default() }
    }

    #[test]
    fn float_is_exact_and_may_hold_nan_and_infinity() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        let mut picture = gradient(Extent::new(37, 21));
        write(&path, &picture, &options(ExrPrecision::Float)).unwrap();
        assert_eq!(read(&path).unwrap(), picture);
        picture.pixels[5] = [f32::INFINITY, f32::NEG_INFINITY, f32::NAN];
        write(&path, &picture, &options(ExrPrecision::Float)).unwrap();
        let found = read(&path).unwrap().pixels[5];
        assert_eq!(found[..2], picture.pixels[5][..2]);
        assert!(found[2].is_nan());
    }

    #[test]
    fn half_rounds_to_nearest_even_and_stays_finite() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        // Halves between 1 and 2 are 2^-10 apart: the odd multiples of 2^-11 are ties.
        let step = 2f32.powi(-11);
        let mut picture = Picture::filled(Extent::new(2, 1), [1.0 + step, 1.0 + 3.0 * step, 1.0 + 1.1 * step]);
        picture.pixels[1] = [1e9, -1e9, f32::INFINITY];
        write(&path, &picture, &options(ExrPrecision::Half)).unwrap();
        let found = read(&path).unwrap();
        assert_eq!(found.pixels, [[1.0, 1.0 + 4.0 * step, 1.0 + 2.0 * step], [65504.0, -65504.0, f32::INFINITY]]);
    }

    #[test]
    fn aovs_are_layers_beside_the_picture_and_attributes_are_text() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        let picture = gradient(Extent::new(3, 2));
        let normals = vec![[0.0, 0.5, -1.0]; 6];
        let aovs = [
            Aov { name: "gbuffer.normal".into(), channels: AovChannels::Rgb(normals) },
            Aov { name: "depth".into(), channels: AovChannels::Y(vec![0.25; 6]) },
            Aov { name: "split.sub_buffer".into(), channels: AovChannels::YU32(vec![4_000_000_001; 6]) },
        ];
        let command = "quincunx render caf\u{e9}.glb".to_owned();
        let attributes = vec![("command".to_owned(), command.clone()), ("scene_hash".to_owned(), "0a1b".to_owned())];
        let options = WriteOptions { aovs: &aovs, attributes, ..WriteOptions::default() };
        write(&path, &picture, &options).unwrap();
        assert_eq!(read(&path).unwrap(), picture, "the layers leave R, G, B alone");

        let image = read_first_flat_layer_from_file(&path).unwrap();
        let channels = &image.layer_data.channel_data.list;
        let names: Vec<String> = channels.iter().map(|channel| channel.name.to_string()).collect();
        assert_eq!(
            names,
            [
                "B",
                "G",
                "R",
                "depth.Y",
                "gbuffer.normal.B",
                "gbuffer.normal.G",
                "gbuffer.normal.R",
                "split.sub_buffer.Y"
            ]
        );
        assert_eq!(channels[3].sample_data, FlatSamples::F32(vec![0.25; 6]));
        assert_eq!(channels[4].sample_data, FlatSamples::F32(vec![-1.0; 6]));
        assert_eq!(channels[7].sample_data, FlatSamples::U32(vec![4_000_000_001; 6]));
        assert_eq!(image.attributes.chromaticities, Some(REC709));
        let text = |name: &str| match &image.layer_data.attributes.other[&Text::from(name)] {
            AttributeValue::Text(text) => text.as_slice().to_vec(),
            other => panic!("{name} is {other:?}"),
        };
        assert_eq!(text("command"), command.as_bytes());
        assert_eq!(text("scene_hash"), b"0a1b");
    }

    #[test]
    fn whole_numbers_read_as_floats_and_what_is_not_read_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        let save = |names: [&str; 3], encoding: Encoding| {
            let channels = names.map(|name| AnyChannel::new(name, FlatSamples::U32(vec![7, 8])));
            let layer = Layer::new(
                (2, 1),
                LayerAttributes::default(),
                encoding,
                AnyChannels::sort(channels.into_iter().collect()),
            );
            Image::from_layer(layer).write().to_file(&path).unwrap();
        };
        save(RGB, Encoding::FAST_LOSSLESS);
        assert_eq!(read(&path).unwrap().pixels, [[7.0; 3], [8.0; 3]]);
        save(["X", "Y", "Z"], Encoding::FAST_LOSSLESS);
        let error = read(&path).unwrap_err();
        assert!(error.message().ends_with("no flat part has the channels R, G, B (found X, Y, Z)"), "{error}");
        save(RGB, Encoding { compression: Compression::B44, ..Encoding::SMALL_LOSSLESS });
        let error = read(&path).unwrap_err();
        assert!(error.message().ends_with("it has b44 compression; none, RLE, ZIP, PIZ and PXR24 are read"), "{error}");
    }

    #[test]
    fn no_broken_byte_panics_or_takes_memory() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        write(&path, &gradient(Extent::new(9, 20)), &options(ExrPrecision::Half)).unwrap();
        let whole = std::fs::read(&path).unwrap();
        for length in (0..whole.len()).step_by(7) {
            std::fs::write(&path, &whole[..length]).unwrap();
            assert_eq!(read(&path).unwrap_err().exit_code(), 2, "{length}");
        }
        // Most changed bytes break the file, some only change a pixel: either way the answer is a value.
        for place in 0..whole.len() {
            for change in [0x01, 0x40, 0xff] {
                let mut broken = whole.clone();
                broken[place] ^= change;
                std::fs::write(&path, &broken).unwrap();
                if let Err(error) = read(&path) {
                    assert_eq!(error.exit_code(), 2, "byte {place}: {error}");
                }
            }
        }
    }
}
