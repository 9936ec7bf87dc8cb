//! Pictures as files: EXR for the numbers, PNG for the eye. The extension chooses.

mod exr_file;
mod limits;
mod options;
mod png_file;

pub use options::{ExrPrecision, Texts, WriteOptions};

use std::path::Path;

use crate::error::{Error, Result};
use crate::picture::Picture;
use crate::picture::tonemap::Srgb8;
use crate::units::Extent;

/// Writes a picture as `path`'s extension says: `.png` (8-bit sRGB) or `.exr` (scene-linear), whole or not at all.
///
/// Fails as a bad request that names the path and the cause: another extension, AOVs for a PNG, or a file that cannot be
/// written.
pub fn write(path: &Path, picture: &Picture, options: &WriteOptions) -> Result<()> {
    match Format::of(path)? {
        Format::Png if !options.aovs.is_empty() => Err(Error::request(format!(
            "cannot write {}: a PNG cannot hold the layer {}; -o FILE.exr can",
            path.display(),
            options.aovs[0].name
        ))),
        Format::Png => {
            let codes = Srgb8::from_picture(picture, options.exposure_ev, options.tone_map);
            png_file::write(path, &codes, &options.attributes)
        }
        Format::Exr => exr_file::write(path, picture, options),
    }
}

/// Writes codes as they are, as a PNG; otherwise like [`write()`]. `path` must end in `.png`.
pub fn write_srgb8(path: &Path, codes: &Srgb8) -> Result<()> {
    require_png(path)?;
    png_file::write(path, codes, &[])
}

/// Fails as a bad request unless `path` ends in `.png`: lets a command refuse before the work is done.
pub fn require_png(path: &Path) -> Result<()> {
    match Format::of(path)? {
        Format::Png => Ok(()),
        Format::Exr => {
            Err(Error::request(format!("cannot write {}: this picture is a PNG; name it .png", path.display())))
        }
    }
}

/// Whether a file of this name holds no light above 1: a PNG.
pub fn is_cut(path: &Path) -> bool {
    matches!(Format::of(path), Ok(Format::Png))
}

/// Reads a picture as `path`'s extension says, to scene-linear RGB.
///
/// PNG: 8 or 16 bits a channel or fewer, grey, palette or RGB, sRGB-decoded to 0 to 1; alpha is dropped. EXR: the channels
/// R, G, B of the first part that has them, half, float or whole numbers, over its data window, uncompressed or under RLE,
/// ZIP, PIZ or PXR24.
/// Fails as a bad request that names the path and the cause: missing, broken or of another kind, past 32768 pixels a side
/// or 2 GiB decoded.
pub fn read(path: &Path) -> Result<Picture> {
    match Format::of(path)? {
        Format::Png => png_file::read(path),
        Format::Exr => exr_file::read(path),
    }
}

/// Reads an EXR and the texts in its header, by name: what `WriteOptions::attributes` wrote.
///
/// Fails as [`read`] does, whatever the name's ending.
pub fn read_exr_with_texts(path: &Path) -> Result<(Picture, Texts)> {
    exr_file::read_with_texts(path)
}

/// Reads these channels of an EXR of `extent`, row-major, and the texts in its header, by name.
///
/// Fails as [`read_exr_with_texts`] does, and where the extent is another or a channel is missing.
pub fn read_exr_channels<const N: usize>(
    path: &Path,
    extent: Extent,
    names: [&str; N],
) -> Result<(Vec<[f32; N]>, Texts)> {
    exr_file::read_channels(path, Some(extent), names).map(|(_, pixels, texts)| (pixels, texts))
}

#[derive(Clone, Copy)]
enum Format {
    Png,
    Exr,
}

impl Format {
    fn of(path: &Path) -> Result<Self> {
        let extension = path.extension().unwrap_or_default();
        if extension.eq_ignore_ascii_case("png") {
            Ok(Self::Png)
        } else if extension.eq_ignore_ascii_case("exr") {
            Ok(Self::Exr)
        } else {
            Err(Error::request(format!("{}: a picture's name ends in .png or .exr", path.display())))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_extension_chooses_in_either_case_and_others_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        let picture = Picture::filled(Extent::new(3, 2), [1.0, 0.0, 1.0]);
        for name in ["a.PNG", "a.Exr"] {
            let path = folder.path().join(name);
            write(&path, &picture, &WriteOptions::default()).unwrap();
            assert_eq!(read(&path).unwrap(), picture);
        }
        for name in ["a.jpg", "a", ".png"] {
            let path = folder.path().join(name);
            for error in [read(&path).unwrap_err(), write(&path, &picture, &WriteOptions::default()).unwrap_err()] {
                assert_eq!(error.exit_code(), 2);
                assert!(error.message().ends_with("a picture's name ends in .png or .exr"), "{error}");
            }
        }
    }

    #[test]
    fn a_missing_file_and_a_folder_say_so() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("folder.png")).unwrap();
        std::fs::create_dir(folder.path().join("folder.exr")).unwrap();
        for (name, cause) in [
            ("none.png", "No such file"),
            ("none.exr", "No such file"),
            ("folder.png", "directory"),
            ("folder.exr", "directory"),
        ] {
            let error = read(&folder.path().join(name)).unwrap_err();
            assert_eq!(error.exit_code(), 2);
            assert!(error.message().contains(name) && error.message().contains(cause), "{error}");
        }
    }
}
