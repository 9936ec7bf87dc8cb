//! A run as events that Chrome and Perfetto draw (the Trace Event Format): a lane of the host, one of the device, and memory as a
//! counter. Passes follow each other: each is as long as it was measured, and what lies between submits is left out.

use super::run::{PassRow, RunReport};
use super::spread::Spread;
use serde_json::{Value, json};

const PROCESS: u32 = 1;

/// Where something ran.
#[derive(Clone, Copy)]
enum Lane {
    Host = 1,
    Device = 2,
}

impl Lane {
    fn of(pass: &PassRow) -> Self {
        if pass.place.as_deref().is_some_and(|place| place.starts_with("host")) { Self::Host } else { Self::Device }
    }
}

fn is_once(pass: &PassRow) -> bool {
    pass.place.as_deref().is_some_and(|place| place.ends_with(", once"))
}

fn samples(pass: &PassRow) -> &[f64] {
    pass.ms.as_ref().and_then(Option::as_ref).map_or(&[], |spread: &Spread| &spread.samples)
}

/// Events, and where the next one begins, in microseconds.
#[derive(Default)]
struct Events {
    all: Vec<Value>,
    now_us: f64,
}

impl Events {
    fn slice(&mut self, name: &str, lane: Lane, begin_us: f64, end_us: f64, more: Value) {
        self.all.push(json!({
            "name": name, "ph": "X", "ts": begin_us, "dur": end_us - begin_us, "pid": PROCESS, "tid": lane as u32, "args": more,
        }));
    }

    fn pass(&mut self, pass: &PassRow, ms: f64, report: &RunReport) {
        let begin_us = self.now_us;
        self.now_us += 1e3 * ms;
        if let Some(bytes) = report.memory.passes.iter().find(|bytes| bytes.pass == pass.name) {
            let args = json!({ "live": bytes.live_bytes, "held beside it": bytes.held_bytes - bytes.live_bytes });
            self.all.push(json!({ "name": "memory, bytes", "ph": "C", "ts": begin_us, "pid": PROCESS, "args": args }));
        }
        let more = json!({
            "bytes_read": pass.bytes_read,
            "bytes_written": pass.bytes_written,
            "invocations": pass.invocations,
        });
        self.slice(&pass.name, Lane::of(pass), begin_us, self.now_us, more);
    }
}

/// The document. Frames have passes where each was timed (`--profile`).
pub fn document(report: &RunReport) -> Value {
    let mut events = Events::default();
    for (lane, name) in [(Lane::Host, "host"), (Lane::Device, report.device.identity.name.as_str())] {
        let args = json!({ "name": name });
        events.all.push(json!({ "name": "thread_name", "ph": "M", "pid": PROCESS, "tid": lane as u32, "args": args }));
    }
    let args = json!({ "name": format!("{} on {}", report.technique, report.scene.name) });
    events.all.push(json!({ "name": "process_name", "ph": "M", "pid": PROCESS, "args": args }));
    let passes = &report.times.passes;
    for pass in passes.iter().filter(|pass| is_once(pass)) {
        samples(pass).iter().for_each(|ms| events.pass(pass, *ms, report));
    }
    let in_frames: Vec<&PassRow> = passes.iter().filter(|pass| !is_once(pass)).collect();
    let frame_count = in_frames.iter().map(|pass| samples(pass).len()).max().unwrap_or(0);
    for frame in 0..frame_count {
        let (begin_us, mut device_from_us) = (events.now_us, None);
        for pass in &in_frames {
            if let Some(ms) = samples(pass).get(frame) {
                if let Lane::Device = Lane::of(pass) {
                    device_from_us.get_or_insert(events.now_us);
                }
                events.pass(pass, *ms, report);
            }
        }
        // Both lanes say which frame it is.
        let (name, end_us, from_us) = (format!("frame {frame}"), events.now_us, device_from_us.unwrap_or(begin_us));
        if from_us > begin_us {
            events.slice(&name, Lane::Host, begin_us, from_us, json!({}));
        }
        events.slice(&name, Lane::Device, from_us, end_us, json!({}));
    }
    json!({ "displayTimeUnit": "ms", "traceEvents": events.all })
}
