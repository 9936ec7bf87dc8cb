//! `render --trace-events`: what Chrome and Perfetto draw, held against the report of the same run.

use crate::support::benched::read;
use crate::support::program::Program;
use serde_json::Value;

fn document(program: &Program, name: &str) -> Value {
    serde_json::from_str(&read(program, name)).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("no number: {value}"))
}

#[test]
fn a_trace_has_every_pass_as_long_as_the_report_says() {
    let program = Program::new();
    for technique in ["interleaved_deferred", "adaptive_interleaved"] {
        let command = ["render", "cornell", "--technique", technique, "--size", "33x17", "-o", "a.png"];
        program.run(&[&command[..], &["--trace-events", "trace.json", "--report", "a.json"]].concat()).fine();
        let (trace, report) = (document(&program, "trace.json"), document(&program, "a.json"));
        let events = trace["traceEvents"].as_array().unwrap();
        let of_kind = |kind: &'static str| events.iter().filter(move |event| event["ph"] == kind);
        let passes = report["passes"].as_array().unwrap();
        let mut ends: Vec<[f64; 2]> = Vec::new();
        let mut frame_count = 0;
        for pass in passes {
            let own: Vec<&Value> = of_kind("X").filter(|event| event["name"] == pass["name"]).collect();
            let lane = if pass["where"].as_str().is_some_and(|place| place.starts_with("host")) { 1 } else { 2 };
            let samples = pass["ms"]["samples"].as_array().unwrap();
            assert_eq!(own.len(), samples.len(), "{pass}");
            for (event, ms) in own.iter().zip(samples) {
                assert!((number(&event["dur"]) - 1e3 * number(ms)).abs() < 1e-6, "{event}");
                assert_eq!(event["tid"], lane, "{event}");
                ends.push([number(&event["ts"]), number(&event["ts"]) + number(&event["dur"])]);
            }
            frame_count = frame_count.max(samples.len());
        }
        assert_eq!(frame_count, 3, "--trace-events has three frames, as --profile has");
        ends.sort_by(|a, b| a[0].total_cmp(&b[0]));
        assert!(ends.windows(2).all(|pair| pair[0][1] <= pair[1][0] + 1e-6), "passes follow each other: {ends:?}");
        // Frames are what their passes take.
        let each = || passes.iter().filter(|pass| !pass["where"].as_str().is_some_and(|place| place.ends_with("once")));
        for frame in 0..frame_count {
            let slices = of_kind("X").filter(|event| event["name"] == format!("frame {frame}"));
            let took: f64 = slices.map(|event| number(&event["dur"])).sum();
            let sum: f64 = each().map(|pass| 1e3 * number(&pass["ms"]["samples"][frame])).sum();
            assert!((took - sum).abs() < 1e-6 * sum, "frame {frame}: {took} us, its passes {sum}");
        }
        let memory = report["memory"]["passes"].as_array().unwrap();
        let counted: Vec<u64> = of_kind("C")
            .map(|event| event["args"].as_object().unwrap().values().map(|bytes| bytes.as_u64().unwrap()).sum())
            .collect();
        let held: Vec<u64> = memory.iter().map(|pass| pass["held_bytes"].as_u64().unwrap()).collect();
        assert_eq!(counted, held.repeat(frame_count), "{technique}: a number for each pass of each frame");
        let lanes: Vec<&Value> = of_kind("M").filter(|event| event["name"] == "thread_name").collect();
        assert_eq!((lanes.len(), &lanes[1]["args"]["name"]), (2, &report["device"]["name"]));
    }
    program.fails(
        &["render", "cornell", "--trace-events", "nowhere/trace.json"],
        2,
        &["nowhere/trace.json", "does not exist"],
    );
}
