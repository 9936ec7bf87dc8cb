//! Close-ups, as papers print them beside whole pictures: a part of a picture, its pixels enlarged and not smoothed.

use super::recipe::CloseUp;
use crate::error::{Error, Result};
use crate::whole_file::write_whole;
use image::imageops::{self, FilterType};
use image::{ImageFormat, ImageReader, RgbaImage};
use std::io::{Cursor, Write};
use std::path::Path;

/// Rows that a close-up has at least: each pixel becomes a square of as many as that takes.
const LEAST_ROWS: u32 = 360;

/// Writes the close-up into `folder`, if the picture that it is of is there.
///
/// Errors: the picture cannot be read, or the close-up not be written (exit code 2).
pub fn write(close_up: &CloseUp, folder: &Path) -> Result<()> {
    let from = folder.join(&close_up.of);
    if !from.is_file() {
        return Ok(());
    }
    let cannot = |why: &dyn std::fmt::Display| Error::request(format!("cannot read {}: {why}", from.display()));
    let reader = ImageReader::open(&from).map_err(|error| cannot(&error))?;
    let whole =
        reader.with_guessed_format().map_err(|error| cannot(&error))?.decode().map_err(|error| cannot(&error))?;
    let mut png = Cursor::new(Vec::new());
    cut(&whole.into_rgba8(), close_up)
        .write_to(&mut png, ImageFormat::Png)
        .map_err(|error| Error::request(format!("cannot write {}: {error}", close_up.file())))?;
    write_whole(&folder.join(close_up.file()), |out| out.write_all(png.get_ref()))
}

fn cut(whole: &RgbaImage, CloseUp { middle, part, .. }: &CloseUp) -> RgbaImage {
    // At least 1: a file of no pixels is no PNG.
    let sides = [whole.width(), whole.height()];
    let extent = sides.map(|side| ((side as f32 * part).round() as u32).clamp(1, side));
    let first = [0, 1].map(|axis| {
        let first = (sides[axis] as f32 * middle[axis] - extent[axis] as f32 / 2.0).round().max(0.0) as u32;
        first.min(sides[axis] - extent[axis])
    });
    let cut = imageops::crop_imm(whole, first[0], first[1], extent[0], extent[1]).to_image();
    let times = LEAST_ROWS.div_ceil(extent[1]);
    imageops::resize(&cut, extent[0] * times, extent[1] * times, FilterType::Nearest)
}

#[cfg(test)]
mod tests {
    use super::*;
    use image::Rgba;

    /// Pixels say where they were.
    fn whole(width: u32, height: u32) -> RgbaImage {
        RgbaImage::from_fn(width, height, |x, y| Rgba([x as u8, y as u8, 0, 255]))
    }

    #[test]
    fn a_close_up_is_the_pixels_around_its_middle_enlarged() {
        let close_up = CloseUp { of: "a.png".to_owned(), middle: [0.5, 0.25], part: 0.2 };
        let cut = cut(&whole(200, 100), &close_up);
        // 40 x 20 pixels around (100, 25), each 18 times as large.
        assert_eq!((cut.width(), cut.height()), (720, 360));
        assert_eq!((cut.get_pixel(0, 0).0, cut.get_pixel(17, 17).0), ([80, 15, 0, 255], [80, 15, 0, 255]));
        assert_eq!(cut.get_pixel(719, 359).0, [119, 34, 0, 255]);
    }

    #[test]
    fn a_close_up_stays_within_the_picture() {
        for middle in [[0.0, 0.0], [1.0, 1.0]] {
            let close_up = CloseUp { of: "a.png".to_owned(), middle, part: 0.5 };
            let cut = cut(&whole(9, 7), &close_up);
            let corner =
                if middle[0] > 0.5 { cut.get_pixel(cut.width() - 1, cut.height() - 1) } else { cut.get_pixel(0, 0) };
            assert_eq!(corner.0[..2], if middle[0] > 0.5 { [8, 6] } else { [0, 0] });
        }
    }

    #[test]
    fn a_picture_that_is_not_there_has_none_and_a_broken_one_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let close_up = CloseUp { of: "a.png".to_owned(), middle: [0.5, 0.5], part: 0.5 };
        write(&close_up, folder.path()).unwrap();
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
        std::fs::write(folder.path().join("a.png"), "no picture").unwrap();
        let error = write(&close_up, folder.path()).unwrap_err();
        assert!(error.exit_code() == 2 && error.message().contains("a.png"), "{error}");
        assert!(!folder.path().join("a.close-up.png").exists());
        whole(20, 10).save(folder.path().join("a.png")).unwrap();
        write(&close_up, folder.path()).unwrap();
        assert!(folder.path().join("a.close-up.png").is_file());
    }
}
