//! `bench --rate`: exponents of errors, as numbers, table and plot.

use crate::support::program::Program;
use serde_json::Value;

/// Independent samples err as the root of their number does, samples that are spread evenly by less: on rings finer than a pixel
/// to coarser than several.
#[test]
fn errors_of_independent_samples_fall_with_the_root_of_their_number() {
    let program = Program::new();
    let begin = ["bench", "frame", "zone-plate:growth=96", "--technique", "interleaved_sampling", "--size", "36x36"];
    let sweep =
        ["--basis", "4x4", "--sweep", "sampler=random,relaxed", "--sweep", "samples=1,4,16", "--rate", "samples"];
    let rest = ["--reference", "auto", "--reference-spp", "2048", "--repeat", "1", "-o", "out"];
    let said = program.run(&[&begin[..], &sweep, &rest].concat());
    assert_eq!(said.code, 0, "{}", said.err);
    let read = |name: &str| std::fs::read_to_string(program.path(name)).unwrap();
    let summary: Value = serde_json::from_str(&read("out/summary.json")).unwrap();
    assert_eq!(summary["rates"]["by"], "samples");
    let rates = summary["rates"]["of"].as_array().unwrap();
    assert_eq!(rates.iter().map(|rate| &rate["of"]).collect::<Vec<_>>(), ["sampler=random", "sampler=relaxed"]);
    let exponent = |index: usize| rates[index]["exponents"]["rmse"].as_f64().unwrap();
    println!("{} and {}", exponent(0), exponent(1));
    assert!((exponent(0) + 0.5).abs() < 0.04 && exponent(1) < -0.6, "{rates:?}");
    let points = rates[0]["points"].as_array().unwrap();
    assert_eq!(points.iter().map(|point| point["value"].as_f64().unwrap()).collect::<Vec<_>>(), [1.0, 4.0, 16.0]);
    for text in [said.out.as_str(), &read("out/summary.md")] {
        assert!(text.contains("| errors by samples | rmse at 1 |") && text.contains("| sampler=relaxed |"), "{text}");
    }
    let plot = read("out/rates.svg");
    assert!(plot.contains(">sampler=relaxed<") && plot.matches("<polyline").count() == 4, "{plot}");

    let refused = program.run(&["bench", "frame", "cornell", "--sweep", "brdf=lambert,ggx", "--rate", "brdf"]);
    assert!(
        refused.code == 2 && refused.err.contains("--rate brdf: --sweep has lambert, which is no number"),
        "{}",
        refused.err
    );
}
