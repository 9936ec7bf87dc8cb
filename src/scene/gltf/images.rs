//! PNG and JPEG images, decoded in parallel under limits: a few bytes can claim gigabytes of pixels.

use std::borrow::Cow;
use std::io::Cursor;

use gltf::Document;
use image::{ImageFormat, ImageReader, Limits};
use rayon::prelude::*;

use super::buffers::Buffers;
use super::facts::ImageFacts;
use super::label;
use super::source::Source;
use crate::error::{Error, Result};
use crate::scene::Image;
use crate::units::{Bytes, Extent};

/// maxImageDimension2D of lavapipe and of most GPUs.
const MAX_SIDE_PX: u32 = 16384;
/// What the decoder may hold for one image: 16-bit RGBA at the longest sides.
const MAX_DECODER_BYTES: u64 = 2 << 30;
/// What all images of a file may take as 8-bit RGBA: four of the largest, or 256 of 2048 x 2048.
const MAX_TOTAL_BYTES: u64 = 4 << 30;

/// An image before it is decoded.
struct Encoded<'a> {
    label: String,
    name: String,
    bytes: Cow<'a, [u8]>,
    format: ImageFormat,
}

/// Decodes the images `image_indices` of the file, in that order; external ones go into `hasher`.
pub fn read(
    document: &Document,
    image_indices: &[usize],
    source: &Source,
    buffers: &Buffers<'_>,
    hasher: &mut blake3::Hasher,
) -> Result<Vec<Image>> {
    let mut encoded = Vec::with_capacity(image_indices.len());
    let mut total = Bytes(0);
    for image_index in image_indices {
        let image = &document.as_json().images[*image_index];
        let label = label::element("image", *image_index, image.name.as_deref().or(file_name(image)));
        let (opened, extent) =
            open(document, image, *image_index, source, buffers, hasher).map_err(|error| error.within(&label))?;
        total.0 += 4 * extent.pixel_count();
        if total.0 > MAX_TOTAL_BYTES {
            return Err(Error::request(format!(
                "{label}: {extent} pixels bring the file's images to {total}; {} is the limit",
                Bytes(MAX_TOTAL_BYTES)
            ))
            .note("make its images smaller"));
        }
        encoded.push(opened);
    }
    // Collected before the first error is taken: always the same image is reported.
    let decoded: Vec<Result<Image>> = encoded.par_iter().map(decode).collect();
    decoded.into_iter().collect()
}

/// Names, formats and extents of all images of the file, by their headers; bytes of external ones go into `hasher`.
pub fn headers(
    document: &Document,
    source: &Source,
    buffers: &Buffers<'_>,
    hasher: &mut blake3::Hasher,
) -> Vec<ImageFacts> {
    let images = document.as_json().images.iter().enumerate();
    images
        .map(|(index, image)| {
            let opened = open(document, image, index, source, buffers, hasher).ok();
            let header = opened
                .map(|(encoded, extent)| (if encoded.format == ImageFormat::Png { "PNG" } else { "JPEG" }, extent));
            ImageFacts { name: name_of(image, index), header }
        })
        .collect()
}

fn name_of(image: &gltf::json::Image, index: usize) -> String {
    let name = image.name.clone().or_else(|| file_name(image).map(str::to_owned));
    name.unwrap_or_else(|| format!("image {index}"))
}

/// The end of an external image's URI.
fn file_name(image: &gltf::json::Image) -> Option<&str> {
    let uri = image.uri.as_deref().filter(|uri| !uri.starts_with("data:"))?;
    uri.rsplit('/').next()
}

/// Fetches the bytes and reads the header.
fn open<'a>(
    document: &Document,
    image: &gltf::json::Image,
    image_index: usize,
    source: &Source,
    buffers: &'a Buffers<'_>,
    hasher: &mut blake3::Hasher,
) -> Result<(Encoded<'a>, Extent)> {
    let view = image.buffer_view.and_then(|view| document.views().nth(view.value()));
    let bytes = match (view, &image.uri) {
        (Some(view), _) => Cow::Borrowed(buffers.view(&view)?),
        (None, Some(uri)) => Cow::Owned(source.fetch(uri, hasher)?),
        (None, None) => return Err(Error::request("has neither a uri nor a buffer view")),
    };
    // The bytes decide, not the MIME type or the name: exporters get those wrong.
    let format =
        image::guess_format(&bytes).ok().filter(|format| matches!(format, ImageFormat::Png | ImageFormat::Jpeg));
    let format = format.ok_or_else(|| Error::request("is neither PNG nor JPEG; those two are what is read"))?;
    let (width, height) =
        ImageReader::with_format(Cursor::new(&*bytes), format).into_dimensions().map_err(|error| broken(&error))?;
    let extent = Extent::new(width, height);
    if width.max(height) > MAX_SIDE_PX || width.min(height) == 0 {
        return Err(Error::request(format!("has {extent} pixels; 1 to {MAX_SIDE_PX} a side can be drawn")));
    }
    let name = name_of(image, image_index);
    let label = label::element("image", image_index, Some(&name));
    Ok((Encoded { label, name, bytes, format }, extent))
}

fn broken(error: &image::ImageError) -> Error {
    Error::request(format!("cannot be decoded: {error}"))
}

fn decode(encoded: &Encoded<'_>) -> Result<Image> {
    let mut reader = ImageReader::with_format(Cursor::new(&*encoded.bytes), encoded.format);
    let mut limits = Limits::no_limits();
    limits.max_image_width = Some(MAX_SIDE_PX);
    limits.max_image_height = Some(MAX_SIDE_PX);
    limits.max_alloc = Some(MAX_DECODER_BYTES);
    reader.limits(limits);
    let pixels = reader.decode().map_err(|error| broken(&error).within(&encoded.label))?.into_rgba8();
    let (width, height) = pixels.dimensions();
    Ok(Image { name: encoded.name.clone(), width, height, rgba8: pixels.into_raw() })
}
