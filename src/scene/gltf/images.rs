//! PNG and JPEG images, decoded in parallel under limits: a few bytes can claim gigabytes of pixels.

use std::io::Cursor;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use gltf::Document;
use image::{ImageDecoder, ImageFormat, ImageReader, Limits};
use rayon::prelude::*;

use super::buffers::Buffers;
use super::label;
use super::source::{Data, Source};
use crate::error::{Error, Result};
use crate::progress::Stage;
use crate::scene::Image;
use crate::units::{Bytes, Extent};

/// maxImageDimension2D of lavapipe and of most GPUs.
const MAX_SIDE_PX: u32 = 16384;
/// What the decoder may hold beside the pixels: colour profiles and texts stand before them and pack well.
const MAX_ASIDE_BYTES: u64 = 16 << 20;
/// What all images of a file may take as 8-bit RGBA: four of the largest, or 256 of 2048 x 2048.
const MAX_TOTAL_BYTES: u64 = 4 << 30;
/// The same, of a file that backs it with nothing: eight of 2048 x 2048 in one colour.
const FREE_BYTES: u64 = 128 << 20;
/// And with each byte of it: pictures pack to a tenth or a fiftieth, those of one colour to a thousandth.
const BYTES_PER_FILE_BYTE: u64 = 64;

/// An image before it is decoded.
struct Encoded<'a> {
    label: String,
    name: String,
    bytes: Data<'a>,
    format: ImageFormat,
    extent: Extent,
    /// Bytes of the decoded pixels at the file's precision: sixteen bits a channel take more than eight.
    decoded_bytes: u64,
}

/// A decoder that allocates no more than `most_bytes`.
fn limited(bytes: &[u8], format: ImageFormat, most_bytes: u64) -> ImageReader<Cursor<&[u8]>> {
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(most_bytes);
    reader.limits(limits);
    reader
}

/// Decodes the images `image_indices` of the file, in that order; external ones go into `hasher`.
pub fn read(
    document: &Document,
    image_indices: &[usize],
    source: &Source,
    buffers: &Buffers<'_>,
    hasher: &mut blake3::Hasher,
) -> Result<Vec<Arc<Image>>> {
    let mut encoded = Vec::with_capacity(image_indices.len());
    let mut total_bytes = 0u64;
    for image_index in image_indices {
        let image = &document.as_json().images[*image_index];
        let label = label::element("image", *image_index, image.name.as_deref().or(file_name(image)));
        let opened = open(document, image, *image_index, source, buffers, hasher);
        let opened = opened.map_err(|error| error.within(&label))?;
        let extent = opened.extent;
        total_bytes = total_bytes.saturating_add(opened.decoded_bytes.max(4 * extent.pixel_count()));
        let limit_bytes = limit_bytes(source.size_bytes());
        if total_bytes > limit_bytes {
            return Err(Error::request(format!(
                "{label}: {extent} pixels bring the file's images to {}; {} is the limit for a file of {}",
                Bytes(total_bytes),
                Bytes(limit_bytes),
                Bytes(source.size_bytes() as u64)
            ))
            .note("make its images smaller"));
        }
        encoded.push(opened);
    }
    let (stage, done) = (Stage::counted("decoding pictures", "pictures"), AtomicU64::new(0));
    let decode = |encoded: &Encoded<'_>| {
        let decoded = decode(encoded);
        stage.reach(done.fetch_add(1, Ordering::Relaxed) + 1, image_indices.len() as u64);
        decoded
    };
    // Collected before the first error is taken: always the same image is reported.
    let decoded: Vec<Result<Image>> = encoded.par_iter().map(decode).collect();
    decoded.into_iter().map(|image| image.map(Arc::new)).collect()
}

/// What the images of a file of this size may take as 8-bit RGBA.
fn limit_bytes(file_bytes: usize) -> u64 {
    let backed = BYTES_PER_FILE_BYTE.saturating_mul(file_bytes as u64);
    FREE_BYTES.saturating_add(backed).min(MAX_TOTAL_BYTES)
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
            let header =
                opened.map(|encoded| (if encoded.format == ImageFormat::Png { "PNG" } else { "JPEG" }, encoded.extent));
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
) -> Result<Encoded<'a>> {
    let view = image.buffer_view.and_then(|view| document.views().nth(view.value()));
    let bytes = match (view, &image.uri) {
        (Some(view), _) => Data::Part(buffers.view(&view)?),
        (None, Some(uri)) => source.fetch(uri, hasher)?,
        (None, None) => return Err(Error::request("has neither a uri nor a buffer view")),
    };
    // The bytes decide, not the MIME type or the name: exporters get those wrong.
    let format =
        image::guess_format(&bytes).ok().filter(|format| matches!(format, ImageFormat::Png | ImageFormat::Jpeg));
    let format = format.ok_or_else(|| Error::request("is neither PNG nor JPEG; those two are what is read"))?;
    let header = limited(&bytes, format, MAX_ASIDE_BYTES).into_decoder().map_err(|error| broken(&error))?;
    let ((width, height), decoded_bytes) = (header.dimensions(), header.total_bytes());
    drop(header);
    let extent = Extent::new(width, height);
    if width.max(height) > MAX_SIDE_PX || width.min(height) == 0 {
        return Err(Error::request(format!("has {extent} pixels; 1 to {MAX_SIDE_PX} a side can be drawn")));
    }
    let name = name_of(image, image_index);
    let label = label::element("image", image_index, Some(&name));
    Ok(Encoded { label, name, bytes, format, extent, decoded_bytes })
}

fn broken(error: &image::ImageError) -> Error {
    Error::request(format!("cannot be decoded: {error}"))
}

fn decode(encoded: &Encoded<'_>) -> Result<Image> {
    let reader = limited(&encoded.bytes, encoded.format, encoded.decoded_bytes.saturating_add(MAX_ASIDE_BYTES));
    let pixels = reader.decode().map_err(|error| broken(&error).within(&encoded.label))?.into_rgba8();
    let (width, height) = pixels.dimensions();
    Ok(Image { name: encoded.name.clone(), width, height, rgba8: pixels.into_raw() })
}

/// An image of the file, whether or not a material shows it.
#[derive(Clone, Debug)]
pub struct ImageFacts {
    pub name: String,
    /// As its bytes say; None where they cannot be read: an image that nothing shows may be broken.
    pub header: Option<(&'static str, Extent)>,
}
