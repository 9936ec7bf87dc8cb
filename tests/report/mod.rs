//! Reports and rows are values: what a program reads from their JSON is what was written.

mod trace;

use crate::support::benched::{bench, lines};
use crate::support::program::Program;
use quincunx::bench::rays::report::RaysRow;
use quincunx::bench::row::BenchRow;
use quincunx::report::run::RunReport;
use serde_json::Value;

#[test]
fn a_report_that_is_read_back_is_the_one_that_was_written() {
    let program = Program::new();
    let small = ["--size", "33x17", "-o", "a.png", "--report", "a.json"];
    let reference = ["--reference", "auto", "--reference-spp", "2", "--max", "psnr=inf"];
    for more in [
        &["cornell", "--technique", "interleaved_deferred", "--vpls", "16", "--profile", "--statistics"][..],
        &["cornell", "--technique", "inferred_lighting", "--aov", "geometry.normal"],
        &["cornell", "--technique", "deep_shading", "--spp", "2"],
        &["cornell", "--technique", "path_traced", "--spp", "2", "--until-error", "0.001"],
        &[&["cornell", "--technique", "forward", "--exposure", "auto"][..], &reference].concat(),
        // Nothing is in view: there is a note.
        &["fence", "--technique", "deferred", "--background", "0,0,0", "--exposure", "-32"],
    ] {
        let arguments = [&["render"], more, &small].concat();
        let ran = program.run(&arguments);
        assert_eq!(ran.code, 0, "{more:?}: {}", ran.err);
        let written: Value = serde_json::from_str(&std::fs::read_to_string(program.path("a.json")).unwrap()).unwrap();
        let report: RunReport =
            serde_json::from_value(written.clone()).unwrap_or_else(|error| panic!("{more:?}: {error}"));
        assert_eq!(report.json().to_string(), written.to_string(), "{more:?}");
        assert_eq!(report.text(), ran.out, "{more:?}");
        assert_eq!(report.notes.is_empty(), !more.contains(&"-32"), "{more:?}");
    }
}

#[test]
fn a_row_that_is_read_back_is_the_one_that_was_written() {
    let program = Program::new();
    program.run(&["render", "cornell", "--size", "64x48", "--vpls", "16", "-o", "a.exr", "--quiet"]).fine();
    for (what, more) in [
        ("frame", &["--sweep", "split=none,one-pass", "--reference", "a.exr", "--min", "psnr=1"][..]),
        ("frame", &["--sweep", "size=64x48,16384x16384", "--fair"]),
        ("split", &["--sweep", "split=one-pass,branch,two-pass", "--sweep", "block=8,16"]),
        ("filter", &["--split", "two-pass"]),
    ] {
        let printed = program.run(&[&bench(what, more)[..], &["--json", "--quiet"]].concat());
        assert_eq!(printed.code, 0, "{}", printed.err);
        // Texts of numbers are read with the last bit as it may be: both sides have read them once.
        for written in lines(&printed.out) {
            let row: BenchRow =
                serde_json::from_value(written.clone()).unwrap_or_else(|error| panic!("{error}: {written}"));
            assert_eq!(row.line(), written.to_string());
            assert!(row.other.is_empty(), "{:?}", row.other);
        }
    }
    let rays =
        program.run(&["bench", "rays", "cornell", "--rays", "1000", "--repeat", "3", "--json", "--quiet"]).fine();
    for written in lines(&rays.out) {
        let row: RaysRow = serde_json::from_value(written.clone()).unwrap_or_else(|error| panic!("{error}: {written}"));
        assert_eq!(row.line(), written.to_string());
    }
}
