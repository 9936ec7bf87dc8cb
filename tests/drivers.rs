//! Pictures of one driver beside those of the reference driver, which QUINCUNX_REFERENCE_DRIVER names by its manifest
//! (tools/test sets it). On the reference itself they are the same.

use crate::support;
use crate::support::program::Program;
use quincunx::metrics;
use quincunx::picture::{Picture, image_file};

/// Drivers round sums otherwise, and place vertices to another part of a pixel (a sixteenth on SwiftShader, a 256th on
/// lavapipe). Along edges a pixel then falls to the other surface and differs by all that surfaces differ: such pixels
/// are counted. Inside surfaces a shift of a sixteenth of a pixel moves textures and highlights by some percent.
struct Bounds {
    /// Greatest difference of a channel in all other pixels, in radiance.
    most: f32,
    /// Part of the pixels that may differ by more.
    outlier_part: f64,
    /// Mean FLIP error over the picture, outliers included.
    flip: f64,
    rmse: f64,
    /// Difference of the pictures' means, as a part of the reference's: light that is missing moves it, edges do not.
    mean_part: f64,
}

/// Lavapipe of Mesa 25.0.7 makes the bits of 22.3.6 in five of the six pictures, and is no 0.0001 off in the sixth.
/// SwiftShader is at most FLIP 0.0232 and RMSE 0.0286 from them, with 0.72 % of the pixels over 0.1 and means 0.094 %
/// apart; the colours of its G-buffer alone, which are textures without light, are FLIP 0.018 off.
const BOUNDS: Bounds = Bounds { most: 0.1, outlier_part: 0.015, flip: 0.03, rmse: 0.04, mean_part: 0.005 };

fn difference(a: [f32; 3], b: [f32; 3]) -> f32 {
    (0..3).map(|channel| (a[channel] - b[channel]).abs()).fold(0.0, f32::max)
}

/// The parts of a judgement, as figures that a failure shows.
fn judge(picture: &Picture, reference: &Picture) -> Result<String, String> {
    let mut differences: Vec<f32> =
        picture.pixels.iter().zip(&reference.pixels).map(|(a, b)| difference(*a, *b)).collect();
    differences.sort_by(f32::total_cmp);
    let outlier_count = differences.iter().filter(|difference| **difference > BOUNDS.most).count();
    let outlier_part = outlier_count as f64 / differences.len() as f64;
    let metrics = metrics::compare(picture, reference, metrics::DEFAULT_THRESHOLD).unwrap().metrics;
    let (mean, expected_mean) = (picture.mean(), reference.mean());
    let apart: f64 = (0..3).map(|channel| (mean[channel] - expected_mean[channel]).abs()).fold(0.0, f64::max);
    let mean_part = apart / expected_mean.into_iter().fold(0.0, f64::max);
    let figures = format!(
        "means {:.3} % apart, RMSE {:.5}, FLIP {:.5}, greatest difference {:.4}, {:.2} % of the pixels over {}",
        100.0 * mean_part,
        metrics.rmse,
        metrics.flip,
        differences.last().unwrap(),
        100.0 * outlier_part,
        BOUNDS.most
    );
    let fits = outlier_part <= BOUNDS.outlier_part
        && metrics.flip <= BOUNDS.flip
        && metrics.rmse <= BOUNDS.rmse
        && mean_part <= BOUNDS.mean_part;
    if fits { Ok(figures) } else { Err(figures) }
}

#[test]
fn every_driver_makes_the_reference_s_pictures() {
    let Ok(reference) = std::env::var("QUINCUNX_REFERENCE_DRIVER") else {
        return support::skip("QUINCUNX_REFERENCE_DRIVER is not set");
    };
    // Libraries that another driver brought are not the reference's.
    let on_reference =
        [("VK_DRIVER_FILES", &reference[..]), ("VK_ICD_FILENAMES", &reference[..]), ("LD_LIBRARY_PATH", "")];
    let program = Program::new();
    let scenes = ["cornell", "hall:triangles=8000", "lamps:objects=40,lights=40"];
    // One scene is enough of the reference beside itself.
    let is_reference = std::env::var("VK_DRIVER_FILES").is_ok_and(|files| files == reference);
    for scene in &scenes[..if is_reference { 1 } else { scenes.len() }] {
        for technique in ["interleaved_deferred", "deferred", "path_traced"] {
            let render = |file: &str, variables: &[(&str, &str)]| {
                let mut arguments = vec!["render", scene, "--technique", technique, "--size", "160x90", "--json"];
                arguments.extend(["-o", file]);
                // The same paths by both, so that few show as much.
                arguments.extend(if technique == "path_traced" { &["--spp", "16"][..] } else { &[] });
                let report = program.run_with(&arguments, variables).fine().json();
                let picture = image_file::read(program.path(file).as_ref()).unwrap();
                (picture, report["device"]["driver_info"].clone(), report["image"]["hash"].clone())
            };
            let (picture, driver, hash) = render("own.exr", &[]);
            let (expected, reference_driver, reference_hash) = render("reference.exr", &on_reference);
            let figures = judge(&picture, &expected)
                .unwrap_or_else(|figures| panic!("{scene} by {technique}: {driver} and {reference_driver}: {figures}"));
            println!("{scene} by {technique}: {figures}");
            assert!(
                driver != reference_driver || hash == reference_hash,
                "{scene} by {technique}: one driver, two hashes"
            );
        }
    }
}
