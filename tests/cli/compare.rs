//! Pictures through files: what is written compares as what was drawn, and a failed write leaves nothing.

use std::path::Path;

use quincunx::cli::compare;
use quincunx::metrics;
use quincunx::picture::image_file::{ExrPrecision, WriteOptions};
use quincunx::picture::tonemap::ToneMap;
use quincunx::picture::{Aov, AovChannels, Picture, image_file};
use quincunx::units::Extent;

/// A smooth picture with light up to 2: more than a PNG shows.
fn sky(extent: Extent) -> Picture {
    let mut picture = Picture::filled(extent, [0.0; 3]);
    for (index, pixel) in picture.pixels.iter_mut().enumerate() {
        let (x, y) = (index as u32 % extent.width, index as u32 / extent.width);
        let (u, v) = (x as f32 / extent.width as f32, y as f32 / extent.height as f32);
        *pixel = [2.0 * u, 0.5 * v, 0.1 + 0.4 * u * v];
    }
    picture
}

fn run(arguments: &[&Path], more: &[&str]) -> quincunx::Result<()> {
    let line = arguments.iter().map(|path| path.as_os_str()).chain(more.iter().map(AsRef::as_ref));
    let line = std::iter::once("compare".as_ref()).chain(line);
    compare::run(&compare::command().try_get_matches_from(line).unwrap())
}

#[test]
fn an_exr_compares_exactly_and_a_png_within_half_a_code() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let mut picture = sky(Extent::new(64, 48));
    image_file::write(&path("float.exr"), &picture, &WriteOptions::default()).unwrap();
    let half = WriteOptions { exr_precision: ExrPrecision::Half, ..WriteOptions::default() };
    image_file::write(&path("half.exr"), &picture, &half).unwrap();
    image_file::write(&path("a.png"), &picture, &WriteOptions::default()).unwrap();
    run(&[&path("float.exr"), &path("float.exr")], &["--max", "rmse=0", "--min", "psnr=inf"]).unwrap();

    // A half has 11 significant bits: rounding moves a value by at most 2^-11 of itself.
    let read_half = image_file::read(&path("half.exr")).unwrap();
    for (found, drawn) in read_half.pixels.as_flattened().iter().zip(picture.pixels.as_flattened()) {
        assert!((found - drawn).abs() <= drawn.abs() * 2f32.powi(-11), "{found} for {drawn}");
    }

    // What the PNG cut off is an error of light, but not of what the screen shows.
    let png = image_file::read(&path("a.png")).unwrap();
    let metrics = metrics::compare(&png, &picture, metrics::DEFAULT_THRESHOLD).unwrap().metrics;
    assert!(metrics.psnr.is_infinite() && metrics.rmse > 0.1, "{metrics:?}");
    for channel in picture.pixels.as_flattened_mut() {
        *channel = channel.min(1.0);
    }
    // Half a code at the steep end of the curve: 2.4 / 1.055 / 510 is 0.00446.
    assert!(metrics::compare(&png, &picture, metrics::DEFAULT_THRESHOLD).unwrap().metrics.rmse < 0.0045);
}

#[test]
fn exposure_and_tone_map_reach_the_png() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    let picture = Picture::filled(Extent::new(4, 4), [0.25; 3]);
    let options = WriteOptions { exposure_ev: 2.0, tone_map: ToneMap::Reinhard, ..WriteOptions::default() };
    image_file::write(&path, &picture, &options).unwrap();
    // 0.25 at two stops is 1; Reinhard makes it 0.5, code 188, which decodes to 0.5029.
    let found = image_file::read(&path).unwrap().pixels[0][0];
    assert!((found - 0.5029).abs() < 1e-4, "{found}");
}

#[test]
fn a_gate_and_a_bad_request_have_their_exit_codes() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let picture = sky(Extent::new(20, 20));
    let mut broken = picture.clone();
    broken.pixels[21] = [f32::NAN; 3];
    image_file::write(&path("a.exr"), &picture, &WriteOptions::default()).unwrap();
    image_file::write(&path("nan.exr"), &broken, &WriteOptions::default()).unwrap();
    image_file::write(&path("small.exr"), &sky(Extent::new(10, 10)), &WriteOptions::default()).unwrap();

    let gate = run(&[&path("a.exr"), &path("a.exr")], &["--min", "flip=0.5"]).unwrap_err();
    assert_eq!(gate.exit_code(), 1);
    let nan = run(&[&path("nan.exr"), &path("a.exr")], &[]).unwrap_err();
    assert_eq!(nan.exit_code(), 1);
    assert!(nan.message().contains("the picture holds NaN or infinity in 1 of 400 pixels, first at (1, 1)"), "{nan}");
    let sizes = run(&[&path("small.exr"), &path("a.exr")], &[]).unwrap_err();
    assert_eq!(sizes.exit_code(), 2);
    assert!(sizes.message().contains("10x10") && sizes.message().contains("20x20"), "{sizes}");
    let missing = run(&[&path("none.exr"), &path("a.exr")], &[]).unwrap_err();
    assert_eq!(missing.exit_code(), 2);
    assert!(missing.message().contains("none.exr"), "{missing}");
}

#[test]
fn a_failed_write_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let picture = sky(Extent::new(8, 8));
    std::fs::create_dir(folder.path().join("taken.exr")).unwrap();
    let layer = [Aov { name: "depth".into(), channels: AovChannels::Y(vec![0.0; 64]) }];
    // OpenEXR's own attribute may not be given twice: the writer itself fails.
    let reserved = vec![("channels".to_owned(), "mine".to_owned())];
    for (name, options, cause) in [
        ("missing/a.png", WriteOptions::default(), "there is no folder"),
        ("taken.exr", WriteOptions::default(), "it is a folder"),
        ("layers.png", WriteOptions { aovs: &layer, ..WriteOptions::default() }, "cannot hold the layer depth"),
        ("reserved.exr", WriteOptions { attributes: reserved, ..WriteOptions::default() }, "channels"),
    ] {
        let path = folder.path().join(name);
        let error = image_file::write(&path, &picture, &options).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        assert!(error.message().contains(&path.display().to_string()), "{error}");
        assert!(error.message().contains(cause), "{error}");
    }
    let left: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left, ["taken.exr"]);
}
