//! What is refused says what would work, and that works.

use crate::support;
use crate::support::program::Program;
use quincunx::caps::{Caps, known};
use quincunx::error::{Error, Result};
use quincunx::job::Job;
use quincunx::study::{self, Study};
use quincunx::{techniques, units::Bytes};

const MIB: u64 = 1 << 20;

fn job(spec: &str, technique: &str, changes: &[(&str, &str)]) -> Job {
    let mut job = Job::new(spec, techniques::find(technique).unwrap());
    changes.iter().for_each(|(key, value)| job.set(key, value).unwrap());
    job
}

fn caps() -> Caps {
    known::caps(known::DEFAULT).unwrap()
}

fn planned(job: &Job, caps: &Caps) -> Result<Study> {
    study::planned(job, known::DEFAULT, caps)
}

/// The alternatives of `--KEY VALUE, --KEY VALUE or --KEY VALUE would fit`.
fn advice(error: &Error) -> Vec<(String, String)> {
    let text = error.to_string();
    let line = text.lines().find_map(|line| line.strip_suffix(" would fit")).unwrap_or_else(|| panic!("{text}"));
    let ways = line.trim().replace(" or ", ", ");
    let flag = |way: &str| {
        let (key, value) = way.strip_prefix("--").unwrap().split_once(' ').unwrap();
        (key.to_owned(), value.to_owned())
    };
    ways.split(", ").map(flag).collect()
}

#[test]
fn a_workgroup_that_is_too_large_is_refused_by_its_flag_before_anything_is_made() {
    let program = Program::new();
    for technique in ["interleaved_deferred", "deferred", "inferred_lighting", "path_traced"] {
        let arguments = ["cornell", "--size", "16x9", "--technique", technique, "--workgroup"];
        let refused = format!("{technique}: --workgroup 256x256: 65536 invocations");
        let words = [refused.as_str(), "maxComputeWorkGroupInvocations", "maxComputeWorkGroupSize"];
        program.fails(&[&["memory", "--plan"], &arguments[..], &["256x256"]].concat(), 2, &words);
        let ran = program.run(&[&["render"], &arguments[..], &["256x256"]].concat());
        assert_eq!(ran.code, 2, "{}", ran.err);
        assert!(words.iter().all(|word| ran.err.contains(word)), "{}", ran.err);
        let fits = ran.err.trim_end().strip_suffix(" fits").and_then(|said| said.rsplit(' ').next()).unwrap();
        program.run(&[&["render"], &arguments[..], &[fits, "--quiet", "-o", "a.png"]].concat()).fine();
    }
}

#[test]
fn a_buffer_that_is_too_long_to_be_bound_is_refused_with_settings_that_have_shorter_ones() {
    let large = [("size", "4096x4096"), ("position", "float"), ("vpls", "16")];
    let error = planned(&job("cornell", "interleaved_deferred", &large), &caps()).map(drop).unwrap_err();
    let text = error.to_string();
    assert_eq!(error.exit_code(), 4, "{text}");
    assert!(
        text.starts_with("interleaved_deferred.split.position needs 256 MiB, and this device binds at most 128 MiB")
    );
    let ways = advice(&error);
    let keys: Vec<&str> = ways.iter().map(|(key, _)| key.as_str()).collect();
    assert_eq!(keys, ["storage", "position", "size"], "{text}");
    for (key, value) in &ways {
        let mut changed = job("cornell", "interleaved_deferred", &large);
        changed.set(key, value).unwrap();
        planned(&changed, &caps()).unwrap_or_else(|error| panic!("--{key} {value}: {error}"));
    }
    // Twice the pixels: what stays in buffers is too long as well.
    let larger = [("size", "8192x4096"), ("position", "float"), ("vpls", "16")];
    let error = planned(&job("cornell", "interleaved_deferred", &larger), &caps()).map(drop).unwrap_err();
    assert_eq!(advice(&error), [("size".to_owned(), "4096x2048".to_owned())], "{error}");
    // The scene's own buffers are as long in the smallest picture.
    let mut narrow = caps();
    narrow.limits.max_storage_buffer_range_bytes = 1000;
    let tiny = [("size", "4x4"), ("direct-shadow", "ray")];
    let error = planned(&job("cornell", "deferred", &tiny), &narrow).map(drop).unwrap_err();
    assert_eq!(advice(&error), [("direct-shadow".to_owned(), "none".to_owned())], "{error}");
    let error = planned(&job("cornell", "path_traced", &[("size", "4x4")]), &narrow).map(drop).unwrap_err();
    assert!(error.to_string().ends_with("a scene with fewer triangles or lights would fit"), "{error}");
}

/// By the image and the limit that it passes, with a size that fits: without a device, where nothing is made yet.
#[test]
fn a_picture_that_cannot_be_drawn_is_refused_when_it_is_planned_with_a_size_that_fits() {
    let mut narrow = caps();
    narrow.limits.max_viewport_px = [4096, 8192];
    for technique in ["interleaved_deferred", "inferred_lighting", "deferred", "forward", "path_traced"] {
        let error = planned(&job("cornell", technique, &[("size", "8192x64")]), &narrow).map(drop).unwrap_err();
        let text = error.to_string();
        assert!(error.exit_code() == 2 && text.starts_with(&format!("{technique}.")), "{text}");
        assert!(text.contains(" pixels: this device allows 4096 x 8192"), "{text}");
        assert_eq!(advice(&error), [("size".to_owned(), "4096x32".to_owned())], "{text}");
        planned(&job("cornell", technique, &[("size", "4096x32")]), &narrow).unwrap();
        planned(&job("cornell", technique, &[("size", "64x8192")]), &narrow).unwrap();
    }
}

/// The budget of `--memory-budget N is enough`.
fn enough(error: &Error) -> String {
    let text = error.to_string();
    let (_, rest) = text.split_once("--memory-budget ").unwrap_or_else(|| panic!("{text}"));
    rest.split_once(" is enough").unwrap_or_else(|| panic!("{text}")).0.to_owned()
}

#[test]
fn a_plan_that_passes_its_budget_is_refused_as_on_a_device_and_the_named_budget_is_enough() {
    let live = support::driver().identity;
    if (live.driver, live.driver_info) != (caps().identity.driver, caps().identity.driver_info) {
        return support::skip("the driver is not the one that is planned for");
    }
    for (spec, technique, allocation, budgets) in [
        ("cornell", "interleaved_deferred", "linear", &[4096, MIB, 3 * MIB, 6 * MIB, 12 * MIB][..]),
        ("cornell", "path_traced", "tlsf", &[4096, 200_000, 12 * MIB]),
        ("hall:triangles=8000", "deferred", "dedicated", &[MIB, 100 * MIB]),
    ] {
        let mut job = job(spec, technique, &[("size", "161x91"), ("allocation", allocation)]);
        assert!(planned(&job, &caps()).unwrap().budget.is_ok(), "there is no budget");
        let (mut refusals, mut last) = (0, None);
        for budget in budgets {
            job.set("memory-budget", &budget.to_string()).unwrap();
            let what = format!("{technique} of {spec} within {}", Bytes(*budget));
            let (planned, made) = (planned(&job, &caps()).unwrap().budget, study::made(&job).map(drop));
            // A device also holds what is on its way to it.
            if made.is_ok() || planned.is_err() {
                assert_eq!(planned.is_ok(), made.is_ok(), "{what}: {planned:?}, {made:?}");
            }
            let (Err(planned), Err(made)) = (planned, made) else { continue };
            assert_eq!((planned.exit_code(), planned.message()), (4, made.message()), "{what}");
            assert!(planned.to_string().contains("the whole plan takes "), "{planned}");
            refusals += 1;
            last = Some(enough(&planned));
        }
        assert!(refusals > 0 && refusals < budgets.len(), "{refusals} refusals of {technique} of {spec}");
        let last = last.expect("one was refused");
        job.set("memory-budget", &last).unwrap();
        let folder = tempfile::tempdir().unwrap();
        job.output = Some(folder.path().join("a.png"));
        job.run().map(drop).unwrap_or_else(|error| panic!("{technique} of {spec} with {last}: {error}"));
    }
}

#[test]
fn memory_prints_its_table_and_fails_then_where_the_budget_is_passed() {
    let program = Program::new();
    let nowhere = [("VK_DRIVER_FILES", "/nowhere.json"), ("VK_ICD_FILENAMES", "/nowhere.json")];
    let plan = ["memory", "cornell", "--size", "161x91", "--plan", "--memory-budget"];
    let run = |more: &[&str]| program.run_with(&[&plan[..], more].concat(), &nowhere);
    let passed = run(&["1MiB"]);
    assert_eq!(passed.code, 4, "{}", passed.err);
    assert!(passed.out.contains(" planned, ") && passed.out.contains("interleaved_deferred.composite.color"));
    for words in [
        "error: allocating ",
        "the budget of 1.00 MiB is ",
        "are held in memory blocks",
        " more than the budget\n",
        "is enough",
    ] {
        assert!(passed.err.contains(words), "{} does not say {words}", passed.err);
    }
    let json = run(&["64KiB", "--json", "--technique", "deferred", "--technique", "forward"]);
    assert_eq!((json.code, json.json()["techniques"].as_array().unwrap().len()), (4, 2));
    run(&["64MiB"]).fine();
}
