//! `devices --self-test`: the document that people send, and that a device which does something wrong is found out by
//! name.

use crate::support;
use crate::support::counted;
use crate::support::failing::{Call, Failure, failing_device, has_failed};
use crate::support::program::Program;
use crate::support::shading_space::without_shading_space;
use crate::support::watched::watched_device;
use ash::vk;
use quincunx::gpu::DeviceRequest;
use quincunx::gpu::request::DeviceHook;
use quincunx::selftest::{self, Outcome, Request, Verdict, document};
use quincunx::techniques;
use std::ffi::{CStr, c_void};
use std::mem::transmute;
use std::sync::OnceLock;

fn tried(device: DeviceRequest, only: &[&str]) -> Outcome {
    let only = only.iter().map(|part| (*part).to_owned()).collect();
    selftest::run(&Request { device, only }, &mut |_| {}).unwrap()
}

fn hooked(hook: DeviceHook) -> DeviceRequest {
    DeviceRequest { hook: Some(hook), ..watched_device() }
}

/// What failed must be this, and the run ends with exit code 1 that names it.
#[track_caller]
fn require_failed(outcome: &Outcome, expected: &[&str]) {
    let lines: String = outcome.tried.iter().map(document::line).collect();
    assert_eq!(outcome.failed(), expected, "{lines}");
    let error = outcome.verdict().unwrap_err();
    assert_eq!(error.exit_code(), 1);
    for name in expected {
        assert!(error.to_string().contains(name), "{error}");
    }
    assert_eq!(document::json(outcome, &[])["failed"], serde_json::json!(expected));
}

/// Bits and bounds of a formula, a need that is refused, samples that must be there and some that must be missing, and
/// the clocks.
#[test]
fn the_document_says_what_held_and_what_is_refused() {
    let program = Program::new();
    let only = "forward/background,deep_shading/background,forward/lamp,forward/msaa/msaa=8,deep_shading/drawn/zmax,\
                deep_shading/control,deferred/cull/cull,clocks";
    let ran = program.run(&["devices", "--self-test", "--only", only, "--json", "--quiet", "-o", "sent.json"]).fine();
    let document = ran.json();
    let written: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(program.path("sent.json")).unwrap()).unwrap();
    assert_eq!(written, document);
    assert_eq!((&document["schema"], &document["failed"]), (&1.into(), &serde_json::json!([])));
    for key in
        ["quincunx", "command", "caps", "robust_buffer_access", "validated", "clocks", "closing", "counts", "seconds"]
    {
        assert!(!document[key].is_null(), "{key}");
    }
    assert!(document["caps"]["limits"]["timestamp_bits"].is_number() && document["quincunx"]["commit"].is_string());
    let cases = document["cases"].as_array().unwrap();
    assert_eq!(cases.len(), 10, "{document:#}");
    for case in cases {
        let name = case["name"].as_str().unwrap();
        let is_refused = case["verdict"] == "refused";
        assert!(is_refused || case["verdict"] == "held", "{case:#}");
        assert_eq!(is_refused, case["refused"]["needs"].is_string(), "{case:#}");
        let has_twin = !case["twin"].is_null();
        assert_eq!(has_twin, !name.contains("control"), "{case:#}");
        assert_eq!(case["figures"]["rmse"].is_number(), has_twin && !is_refused, "{case:#}");
        assert!(case["expected"]["why"].as_str().is_some_and(|why| !why.is_empty()), "{case:#}");
        assert!(case["seconds"].as_f64() > Some(0.0) && case["settings"]["size"] == "61x37", "{case:#}");
        if name.starts_with("deep_shading") {
            let missing = case["samples_without_colour"].as_f64().unwrap();
            assert_eq!(missing > 0.0, name.contains("control"), "{case:#}");
        }
    }
    let counts = &document["counts"];
    let sum: u64 = ["held", "failed", "refused"].iter().map(|word| counts[*word].as_u64().unwrap()).sum();
    assert_eq!((sum, counts["failed"].as_u64()), (cases.len() as u64, Some(0)));
    let clocks = &document["clocks"];
    if clocks["refused"].is_null() {
        assert!(clocks["rate"]["device_ns"].as_f64() >= Some(90e6), "{clocks:#}");
        assert_eq!((&clocks["is_monotone"], &clocks["complaints"]), (&true.into(), &serde_json::json!([])));
        assert_eq!(clocks["frames"].as_array().unwrap().len(), 2);
    }
    let text = program.run(&["devices", "--self-test", "--only", "forward/sun,deferred/sun", "--validate"]).fine().out;
    assert_eq!(text.lines().filter(|line| line.starts_with("held ")).count(), 2, "{text}");
    assert!(text.contains("2 held, 0 failed, 0 refused in ") && text.contains("-o FILE.json"), "{text}");
}

#[test]
fn what_cannot_be_asked_for_is_refused_before_anything_runs() {
    let program = Program::new();
    program.fails(
        &["devices", "--self-test", "--only", "voodoo"],
        2,
        &["--only voodoo", "clocks", "deep_shading/lists"],
    );
    program.fails(&["devices", "--self-test", "-o", "nowhere/a.json"], 2, &["nowhere does not exist"]);
    program.fails(&["devices", "--self-test", "--device", "voodoo"], 3, &["--device voodoo", "there are:"]);
    for alone in [&["--device", "0"][..], &["--only", "clocks"], &["-o", "a.json"], &["--validate"]] {
        let ran = program.run(&[&["devices"], alone].concat());
        assert!(ran.code == 2 && ran.err.contains("--self-test"), "{alone:?}: {}", ran.err);
    }
    let nowhere = [("VK_DRIVER_FILES", "/nowhere.json"), ("VK_ICD_FILENAMES", "/nowhere.json")];
    assert_eq!(program.run_with(&["devices", "--self-test", "-o", "a.json"], &nowhere).code, 3);
    assert_eq!(program.files(), [] as [&str; 0]);
}

#[cfg(target_os = "linux")]
#[test]
fn an_interrupted_self_test_ends_with_130_and_writes_nothing() {
    let program = Program::new();
    let (code, said) = program.interrupted(&["devices", "--self-test", "-o", "a.json"], || true);
    assert_eq!(code, Some(130), "{said}");
    assert!(said.starts_with("error: interrupted"), "{said}");
    assert_eq!(program.files(), [] as [&str; 0]);
}

/// It is the first thing to run on a device: a case that no device can hold must not wait there.
#[test]
fn every_case_holds_here_or_is_refused() {
    let names: Vec<&str> = techniques::ALL.iter().map(|technique| technique.name()).collect();
    let outcome = tried(DeviceRequest::default(), &names);
    let failed = outcome.tried.iter().filter(|case| matches!(case.verdict, Verdict::Failed(_)));
    let lines: String = failed.map(document::line).collect();
    assert!(outcome.failed().is_empty() && outcome.tried.len() > 300, "{} tried\n{lines}", outcome.tried.len());
}

/// Shading space stays empty: where fragments shade the picture of the lists is none, and that of entries is as it was.
#[test]
fn samples_without_colour_fail_the_method_that_lost_them() {
    let outcome =
        tried(hooked(without_shading_space), &["deep_shading/drawn/zmax=on", "deep_shading/sun", "forward/sun"]);
    require_failed(&outcome, &["deep_shading/drawn/zmax=on"]);
    let Verdict::Failed(complaints) = &outcome.tried[2].verdict else { panic!("it failed") };
    assert!(complaints[0].contains("a sample that finds no colour"), "{complaints:?}");
}

unsafe extern "system" fn no_dispatch(_: vk::CommandBuffer, _: u32, _: u32, _: u32) {}

fn without_dispatches(name: &CStr, function: *const c_void) -> *const c_void {
    match name.to_bytes() {
        b"vkCmdDispatch" => no_dispatch as vk::PFN_vkCmdDispatch as *const c_void,
        _ => function,
    }
}

/// A wrong picture without a word from the driver is found by the formula, and where the same is wrong on both sides of
/// a pair too.
#[test]
fn a_picture_that_is_wrong_in_silence_is_named() {
    if !support::driver().identity.is_software() {
        // On an H200 the picture that `forward` left there is found in the bytes, which is the right one.
        support::name_skip("memory of this device keeps the picture that was there before");
        return;
    }
    let only = ["forward/sun", "deferred/sun", "forward/background", "deferred/background"];
    let outcome = tried(hooked(without_dispatches), &only);
    require_failed(&outcome, &["deferred/background/defaults", "deferred/sun/defaults"]);
}

static RESULTS: OnceLock<vk::PFN_vkGetQueryPoolResults> = OnceLock::new();

/// Ticks half as long as the device says.
unsafe extern "system" fn doubled_results(
    device: vk::Device,
    pool: vk::QueryPool,
    first: u32,
    count: u32,
    bytes: usize,
    data: *mut c_void,
    stride: vk::DeviceSize,
    flags: vk::QueryResultFlags,
) -> vk::Result {
    let results = RESULTS.get().expect("the hook stored it");
    // SAFETY: the driver's own function with the caller's arguments.
    let result = unsafe { results(device, pool, first, count, bytes, data, stride, flags) };
    for query in 0..count as usize {
        // SAFETY: the caller's array holds `count` numbers of eight bytes, which the driver has just written.
        unsafe {
            let ticks = data.cast::<u64>().add(query);
            *ticks = (*ticks).wrapping_mul(2);
        }
    }
    result
}

fn with_fast_ticks(name: &CStr, function: *const c_void) -> *const c_void {
    if name.to_bytes() != b"vkGetQueryPoolResults" {
        return function;
    }
    // SAFETY: the pointer is the function of that name.
    RESULTS.get_or_init(|| unsafe { transmute::<*const c_void, vk::PFN_vkGetQueryPoolResults>(function) });
    doubled_results as vk::PFN_vkGetQueryPoolResults as *const c_void
}

#[test]
fn a_clock_that_goes_twice_as_fast_as_it_says_is_named() {
    let outcome = tried(hooked(with_fast_ticks), &["clocks"]);
    require_failed(&outcome, &["clocks"]);
    let complaints = &outcome.clocks.as_ref().unwrap().complaints;
    assert!(complaints.iter().any(|text| text.contains("between two submits")), "{complaints:?}");
}

/// A device that fails in one case is opened again for the next: the rest is still worth knowing.
#[test]
fn a_failing_device_ends_one_case_and_not_the_run() {
    let _one_at_a_time = counted::begin();
    let cases = ["forward/sun", "deferred/sun", "forward/lamp"];
    let plain = tried(failing_device(None), &cases);
    assert_eq!(plain.failed(), [] as [&str; 0]);
    let after = crate::support::failing::submit_count() / 2;
    let failure = Failure { call: Call::Submit, after, result: vk::Result::ERROR_OUT_OF_DEVICE_MEMORY };
    let outcome = tried(failing_device(Some(failure)), &cases);
    assert!(has_failed());
    require_failed(&outcome, &["deferred/sun/defaults"]);
}
