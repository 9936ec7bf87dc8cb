//! Images whose texels lie row by row: the same pictures, and a row in the table says so.

use crate::support::program::Program;
use crate::support::skip;
use crate::support::touched::{list, rendered};
use serde_json::Value;

/// Names of images that lie row by row, and all images.
fn images(report: &Value) -> [Vec<&str>; 2] {
    let rows = || list(&report["memory"]["resources"]).iter().filter(|row| row["format"].is_string());
    let is_linear = |row: &&Value| row["tiling"] == "linear";
    assert!(rows().all(|row| row["tiling"].is_null() || is_linear(&row)), "{report}");
    [rows().filter(is_linear).collect::<Vec<_>>(), rows().collect()]
        .map(|rows| rows.into_iter().map(|row| row["name"].as_str().unwrap()).collect())
}

#[test]
fn images_that_lie_row_by_row_show_the_same_picture() {
    let program = Program::new();
    let mut linear_count = 0;
    for (technique, settings) in [
        ("interleaved_deferred", &["--vpls", "32", "--storage", "image"][..]),
        ("inferred_lighting", &[]),
        ("deep_shading", &["--spp", "2"]),
        ("forward", &["--msaa", "4"]),
    ] {
        let plain =
            [&["hall:triangles=5000", "--size", "61x45", "--technique", technique, "--validate"], settings].concat();
        let report = |tiling: &'static str| rendered(&program, &[&plain[..], &["--image-tiling", tiling]].concat());
        let (optimal, linear) = (report("optimal"), report("linear"));
        assert_eq!(optimal["image"]["hash"], linear["image"]["hash"], "{technique}");
        let ([none, all], [some, same]) = (images(&optimal), images(&linear));
        assert!(none.is_empty() && all == same && !all.is_empty(), "{technique}: {none:?} {all:?} {same:?}");
        linear_count += some.len();
        // What is asked for by arithmetic does not know how texels lie.
        assert_eq!(optimal["memory"]["planned_bytes"], linear["memory"]["planned_bytes"], "{technique}");
        // Samples of a pixel and levels of a texture lie as the driver likes, wherever it says so.
        println!("{technique}: {} of {} images lie row by row", some.len(), all.len());
    }
    if linear_count == 0 {
        skip("the driver makes no image of this program's kinds whose texels lie row by row");
    }
}

#[test]
fn what_lies_row_by_row_is_not_planned_without_a_device() {
    let program = Program::new();
    for more in [&[][..], &["--smallest-budget"]] {
        let words =
            [&["memory", "cornell", "--plan", "--caps", "lavapipe-22.3.6", "--image-tiling", "linear"], more].concat();
        program.fails(&words, 2, &["--image-tiling linear", "only a device says", "without --plan"]);
    }
}
