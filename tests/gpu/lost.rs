//! A device that is lost, and submits that fail: one clear error, exit code 4, nothing left behind, no file touched.

use crate::support::counted::{begin, live_bytes};
use crate::support::failing::{Call, Failure, failing_device, has_failed, submit_count};
use crate::support::watched::{require_silence, values};
use ash::vk;
use quincunx::error::Result;
use quincunx::gpu::DeviceRequest;
use quincunx::gpu::commands::Submits;
use quincunx::job::Job;
use quincunx::session::Session;
use quincunx::{scene, techniques};

const TECHNIQUE: &str = "interleaved_deferred";
const SMALL: [(&str, &str); 3] = [("size", "33x17"), ("vpls", "16"), ("pattern", "2x2")];

/// Upload, a frame with a submit a pass, readback. What the validation layer says fails it, at closing too.
fn render(request: &DeviceRequest) -> Result<()> {
    let session = Session::open(request, scene::load("cornell", 1)?)?;
    let log = session.gpu.validation_log().expect("it is watched");
    let made = session.renderer(techniques::find(TECHNIQUE)?, &values(TECHNIQUE, &SMALL), &[], Submits::PerPass);
    let rendered = made.and_then(|renderer| {
        renderer.frame()?;
        renderer.picture()
    });
    require_silence(&session.gpu, "a frame that fails");
    drop(session);
    let at_closing: Vec<String> = log.take().into_iter().map(|message| message.text).collect();
    assert_eq!(at_closing, [] as [&str; 0], "closing after a failure");
    rendered.map(drop)
}

/// Each call of its kind fails once, in a run of its own.
fn require_clean_failures(call: Call, result: vk::Result, words: &[&str]) {
    let _one = begin();
    let mut messages = Vec::new();
    for after in 0.. {
        let rendered = render(&failing_device(Some(Failure { call, after, result })));
        assert_eq!(live_bytes(), 0, "{call:?} {after}: bytes that nobody gave back");
        let Err(error) = rendered else {
            assert!(!has_failed(), "{call:?} {after} failed, and nobody noticed");
            break;
        };
        assert!(has_failed(), "{call:?} {after} went well, and it failed: {error}");
        assert_eq!(error.exit_code(), 4, "{call:?} {after}: {error}");
        let text = error.to_string();
        assert!(words.iter().all(|word| text.contains(word)), "{call:?} {after}: {text}");
        messages.push(error.message().to_owned());
    }
    let count_of = |part: &str| messages.iter().filter(|message| message.contains(part)).count();
    // Seven passes, in a submit each.
    assert!(count_of("running a frame of interleaved_deferred: ") >= 7, "{messages:#?}");
    assert!(count_of("running commands (upload): ") >= 5, "{messages:#?}");
    assert_eq!(count_of("running commands (readback): "), 1, "{messages:#?}");
}

#[test]
fn a_device_that_is_lost_in_a_submit_ends_the_run() {
    let words = ["the device is lost (ERROR_DEVICE_LOST)", "--size", "--device"];
    require_clean_failures(Call::Submit, vk::Result::ERROR_DEVICE_LOST, &words);
}

#[test]
fn a_device_that_is_lost_in_a_wait_ends_the_run() {
    let words = ["the device is lost (ERROR_DEVICE_LOST)", "--size", "--device"];
    require_clean_failures(Call::Wait, vk::Result::ERROR_DEVICE_LOST, &words);
}

#[test]
fn a_submit_without_host_memory_ends_the_run() {
    let words = ["the host's memory is spent (ERROR_OUT_OF_HOST_MEMORY)", "--size"];
    require_clean_failures(Call::Submit, vk::Result::ERROR_OUT_OF_HOST_MEMORY, &words);
}

/// A picture and a report of an earlier run stay as they are.
#[test]
fn a_lost_device_touches_no_file() {
    let _one = begin();
    let folder = tempfile::tempdir().unwrap();
    let [picture, report] = ["a.png", "a.json"].map(|name| folder.path().join(name));
    let mut job = Job::new("cornell", techniques::find(TECHNIQUE).unwrap());
    SMALL.iter().for_each(|(key, value)| job.set(key, value).unwrap());
    job.output = Some(picture.clone());
    job.report = Some(report.clone());
    job.validate = true;
    let run = |planned| job.run_on(&DeviceRequest { hook: failing_device(planned).hook, ..job.device_request() });
    run(None).unwrap();
    let before = [&picture, &report].map(|path| std::fs::read(path).unwrap());
    let last = submit_count() - 1;
    for (call, after) in [(Call::Submit, 0), (Call::Submit, last - 1), (Call::Submit, last), (Call::Wait, last)] {
        let error = run(Some(Failure { call, after, result: vk::Result::ERROR_DEVICE_LOST })).err().unwrap();
        assert_eq!(error.exit_code(), 4, "{error}");
        assert_eq!([&picture, &report].map(|path| std::fs::read(path).unwrap()), before, "{call:?} {after}");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2, "{call:?} {after}: something was left");
        assert_eq!(live_bytes(), 0, "{call:?} {after}");
    }
}
