//! PNG: 8-bit sRGB out, 8 or 16 bits in.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use image::codecs::png::PngDecoder;
use image::{DynamicImage, ImageDecoder, ImageError, Limits};
use png::{BitDepth, ColorType, Compression, Encoder, EncodingError, Filter};

use super::limits::{DECODED_LIMIT, SIDE_LIMIT_PX, require_within_limits, unreadable};
use crate::error::Result;
use crate::picture::Picture;
use crate::picture::tonemap::{Srgb8, linear_from_srgb};
use crate::whole_file::write_whole;

/// `texts`: by name, chunks before the pixels.
pub(super) fn write(path: &Path, codes: &Srgb8, texts: &[(String, String)]) -> Result<()> {
    write_whole(path, |file| -> Result<(), EncodingError> {
        let mut encoder = Encoder::new(file, codes.extent.width, codes.extent.height);
        encoder.set_color(ColorType::Rgb);
        encoder.set_depth(BitDepth::Eight);
        // Rather small than fast: goldens live in the repository.
        encoder.set_compression(Compression::Balanced);
        encoder.set_filter(Filter::Adaptive);
        for (name, text) in texts {
            encoder.add_itxt_chunk(name.clone(), text.clone())?;
        }
        let mut writer = encoder.write_header()?;
        writer.write_image_data(codes.as_bytes())?;
        writer.finish()
    })
}

pub(super) fn read(path: &Path) -> Result<Picture> {
    let file = File::open(path).map_err(|error| unreadable(path, &error))?;
    let broken = |error: ImageError| match error {
        ImageError::Limits(_) => {
            unreadable(path, &format!("it is larger than {SIDE_LIMIT_PX} pixels a side or {DECODED_LIMIT} decoded"))
        }
        ImageError::IoError(error) if error.kind() != std::io::ErrorKind::UnexpectedEof => unreadable(path, &error),
        other => unreadable(path, &format!("it is not a PNG, or a broken one ({other})")),
    };
    let mut limits = Limits::no_limits();
    limits.max_image_width = Some(SIDE_LIMIT_PX);
    limits.max_image_height = Some(SIDE_LIMIT_PX);
    limits.max_alloc = Some(DECODED_LIMIT.0);
    let decoder = PngDecoder::with_limits(BufReader::new(file), limits).map_err(broken)?;
    let (width, height) = decoder.dimensions();
    let extent = require_within_limits(path, width.into(), height.into())?;
    let pixels = match DynamicImage::from_decoder(decoder).map_err(broken)? {
        image @ (DynamicImage::ImageLuma8(_)
        | DynamicImage::ImageLumaA8(_)
        | DynamicImage::ImageRgb8(_)
        | DynamicImage::ImageRgba8(_)) => {
            let pixels = image.into_rgb8().pixels().map(|pixel| pixel.0).collect();
            Srgb8 { extent, pixels }.to_picture().pixels
        }
        deep => {
            let decode = |code: u16| linear_from_srgb(f64::from(code) / 65535.0) as f32;
            deep.into_rgb16().pixels().map(|pixel| pixel.0.map(decode)).collect()
        }
    };
    Ok(Picture { extent, pixels })
}

#[cfg(test)]
mod tests {
    use image::{ImageBuffer, Luma, LumaA, Rgb, Rgba};

    use super::*;
    use crate::units::Extent;

    /// What `read` makes of an image that the crate itself wrote.
    fn read_back(image: impl Into<DynamicImage>) -> Picture {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        image.into().save(&path).unwrap();
        read(&path).unwrap()
    }

    #[test]
    fn every_layout_reads_as_linear_rgb() {
        let linear = |encoded: f64| linear_from_srgb(encoded) as f32;
        let (low, high) = (linear(51.0 / 255.0), linear(204.0 / 255.0));
        let colour = [[low, high, 1.0]];
        let grey = [[low; 3]];
        assert_eq!(read_back(ImageBuffer::from_pixel(1, 1, Rgb([51u8, 204, 255]))).pixels, colour);
        assert_eq!(read_back(ImageBuffer::from_pixel(1, 1, Rgba([51u8, 204, 255, 7]))).pixels, colour);
        assert_eq!(read_back(ImageBuffer::from_pixel(1, 1, Luma([51u8]))).pixels, grey);
        assert_eq!(read_back(ImageBuffer::from_pixel(1, 1, LumaA([51u8, 7]))).pixels, grey);
        // 51 / 255 is 13107 / 65535, 204 / 255 is 52428 / 65535.
        assert_eq!(read_back(ImageBuffer::from_pixel(1, 1, Rgb([13107u16, 52428, 65535]))).pixels, colour);
        assert_eq!(read_back(ImageBuffer::from_pixel(1, 1, Rgba([13107u16, 52428, 65535, 9]))).pixels, colour);
        assert_eq!(read_back(ImageBuffer::from_pixel(1, 1, Luma([13107u16]))).pixels, grey);
        // One step of 16 bits is kept.
        let fine = read_back(ImageBuffer::from_pixel(1, 1, Luma([13108u16]))).pixels[0][0];
        assert_eq!(fine, linear(13108.0 / 65535.0));
    }

    #[test]
    fn a_broken_file_and_a_huge_claim_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let codes = Srgb8 { extent: Extent::new(40, 30), pixels: vec![[9, 99, 199]; 1200] };
        write(&path, &codes, &[]).unwrap();
        let whole = std::fs::read(&path).unwrap();
        for length in [0, 7, 20, 40, whole.len() / 2, whole.len() - 20] {
            std::fs::write(&path, &whole[..length]).unwrap();
            let error = read(&path).unwrap_err();
            assert_eq!(error.exit_code(), 2);
            assert!(error.message().contains("a.png: it is not a PNG, or a broken one"), "{length}: {error}");
        }
        // The width stands at byte 16 of the header; its checksum, now wrong, at byte 29.
        let mut huge = whole;
        huge[16..20].copy_from_slice(&40_000u32.to_be_bytes());
        std::fs::write(&path, &huge).unwrap();
        assert_eq!(read(&path).unwrap_err().exit_code(), 2);
    }
}
