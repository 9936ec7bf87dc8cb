//! What the targets share: a folder in memory, a picture, and the mutator that knows what a scene file is.

pub mod mutate;
pub mod seeds;

use tempfile::TempDir;

/// A folder of this process, in memory where the system has such a place: a target writes a file a run.
pub fn memory_folder() -> TempDir {
    tempfile::tempdir_in("/dev/shm").or_else(|_| tempfile::tempdir()).unwrap()
}

/// A PNG of one colour.
pub fn png(width: u32, height: u32) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let pixels = image::RgbaImage::from_pixel(width, height, image::Rgba([9, 99, 199, 128]));
    pixels.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}
