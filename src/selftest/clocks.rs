//! The device's clock beside the host's: whether a tick is as long as the device says, whether it goes forward, and
//! whether what it measures fits into the submits that it was measured in.
//!
//! Why this way: a timestamp is written between its submit and its fence, so two submits some time apart bound from
//! both sides what the device's clock may say of that time, on a busy machine too, and without any extension. Where the
//! device reads both clocks at one moment (`gpu::calibration`), that is a second, finer look.

use super::bed::{Bed, RenderRequest};
use super::case::Place;
use crate::error::Result;
use crate::gpu::commands::{Submits, Traffic};
use crate::gpu::recorded::Recorded;
use crate::gpu::timing::elapsed_ns;
use crate::gpu::{Commands, Gpu};
use crate::memory::Strategy;
use crate::memory::touched::Touched;
use serde::Serialize;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// Its name among the cases.
pub const NAME: &str = "clocks";

/// What a tick may be longer or shorter than said, as a part of it: ten times what quartz is off by.
const RATE_BOUND: f64 = 1e-3;
/// The host's clock and the device's are read one after the other.
const READING_NS: f64 = 2_000.0;
/// What lies between the two looks at the clocks.
const BETWEEN: Duration = Duration::from_millis(100);
/// Passes of the frame that writes nothing but timestamps.
const STAMPS: usize = 8;

/// Frames of which each pass is timed by both clocks.
const FRAMES: [RenderRequest<'static>; 2] = [
    (Place::Scene("cornell"), "interleaved_deferred", &[("size", "64x64"), ("vpls", "1024")]),
    (Place::Scene("cornell"), "deferred", &[("size", "64x64"), ("direct-shadow", "ray")]),
];

/// What was found; no `rate` where the queue writes no timestamps.
#[derive(Debug, Default, Serialize)]
pub struct Clocks {
    pub timestamp_bits: u32,
    pub timestamp_period_ns: f32,
    /// Why nothing was measured.
    pub refused: Option<String>,
    pub rate: Option<Rate>,
    /// None: the device does not read both clocks at one moment.
    pub calibrated: Option<Calibrated>,
    /// In the order in which timestamps were written their ticks rise.
    pub is_monotone: Option<bool>,
    pub frames: Vec<Frame>,
    pub complaints: Vec<String>,
}

/// The time between two submits by both clocks.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Rate {
    pub device_ns: f64,
    /// From the first one's fence to the second one's submit, and from submit to fence: the device's must lie between.
    pub host_least_ns: f64,
    pub host_most_ns: f64,
}

/// The time between two moments at which both clocks were read.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Calibrated {
    pub device_ns: f64,
    pub host_ns: f64,
    /// By how much the readings of both moments together may be off.
    pub deviation_ns: f64,
    /// `device_ns` by `host_ns`.
    pub ratio: f64,
}

/// The passes of a frame with a submit each.
#[derive(Debug, Serialize)]
pub struct Frame {
    pub technique: &'static str,
    pub passes: Vec<Pass>,
    /// Sum of the device's times by the sum of the host's.
    pub ratio: f64,
}

#[derive(Debug, Serialize)]
pub struct Pass {
    pub name: String,
    pub wall_ns: u64,
    pub timestamp_ns: u64,
}

/// Looks at the clocks.
///
/// Errors: the device fails (exit code 4).
pub fn compare(bed: &mut Bed) -> Result<Clocks> {
    let limits = bed.caps().limits.clone();
    let mut clocks = Clocks {
        timestamp_bits: limits.timestamp_bits,
        timestamp_period_ns: limits.timestamp_period_ns,
        ..Clocks::default()
    };
    if limits.timestamp_period_ns == 0.0 {
        clocks.refused = Some("the queue writes no timestamps (timestampValidBits)".to_owned());
        return Ok(clocks);
    }
    let gpu = bed.gpu(Strategy::default(), Touched::Off)?;
    let stamps = stamps(&gpu)?;
    let moment = || gpu.calibration().map(|calibration| calibration.now()).transpose();
    let (begun, before) = (moment()?, stamped(&stamps)?);
    std::thread::sleep(BETWEEN);
    let (after, ended) = (stamped(&stamps)?, moment()?);
    let device_ns = |ticks| elapsed_ns(ticks, &limits) as f64;
    let rate = Rate {
        device_ns: device_ns([before.ticks[0], after.ticks[0]]),
        host_least_ns: (after.submitted - before.ended).as_nanos() as f64,
        host_most_ns: (after.ended - before.submitted).as_nanos() as f64,
    };
    clocks.complaints.extend(rate.complaint());
    clocks.rate = Some(rate);
    // Half of all that a counter can hold is no step forward.
    let half_ns = 2f64.powi(limits.timestamp_bits as i32 - 1) * f64::from(limits.timestamp_period_ns);
    let is_monotone = after.ticks.windows(2).all(|pair| device_ns([pair[0], pair[1]]) < half_ns);
    if !is_monotone {
        clocks.complaints.push(format!("ticks go back from one timestamp to the next: {:?}", after.ticks));
    }
    clocks.is_monotone = Some(is_monotone);
    if let (Some(begun), Some(ended)) = (begun, ended) {
        let (device_ns, host_ns) =
            (device_ns([begun.device_ticks, ended.device_ticks]), ended.host_ns.saturating_sub(begun.host_ns) as f64);
        let deviation_ns = (begun.deviation_ns + ended.deviation_ns) as f64;
        let calibrated = Calibrated { device_ns, host_ns, deviation_ns, ratio: device_ns / host_ns };
        clocks.complaints.extend(calibrated.complaint());
        clocks.calibrated = Some(calibrated);
    }
    for request in FRAMES {
        let frame = Frame::of(bed, request)?;
        clocks.complaints.extend(frame.passes.iter().filter_map(Pass::complaint));
        clocks.frames.push(frame);
    }
    Ok(clocks)
}

/// A frame of passes that do nothing.
fn stamps(gpu: &Arc<Gpu>) -> Result<Recorded> {
    let mut cmd = Commands::begin(gpu, "self_test.stamps", Submits::PerPass)?;
    for index in 0..STAMPS {
        cmd.pass(&format!("self_test.stamp.{index}"), Traffic::default(), |_| Ok(()))?;
    }
    cmd.finish()
}

/// Ticks, and the host's times between which they were written.
struct Stamped {
    submitted: Instant,
    ended: Instant,
    ticks: Vec<u64>,
}

fn stamped(stamps: &Recorded) -> Result<Stamped> {
    let submitted = Instant::now();
    stamps.run()?;
    let ended = Instant::now();
    Ok(Stamped {
        submitted,
        ended,
        ticks: stamps.ticks()?.expect("a queue with timestamps writes them with a submit a pass"),
    })
}

impl Rate {
    fn complaint(&self) -> Option<String> {
        let Self { device_ns, host_least_ns, host_most_ns } = *self;
        let (least, most) = (host_least_ns * (1.0 - RATE_BOUND), host_most_ns * (1.0 + RATE_BOUND));
        let fits = (least - READING_NS..=most + READING_NS).contains(&device_ns);
        (!fits).then(|| {
            let host = format!("{host_least_ns} to {host_most_ns}");
            format!("between two submits the device's clock counts {device_ns} ns, the host's {host}")
        })
    }
}

impl Calibrated {
    fn complaint(&self) -> Option<String> {
        let Self { device_ns, host_ns, deviation_ns, .. } = *self;
        let fits = (device_ns - host_ns).abs() <= RATE_BOUND * host_ns + deviation_ns + READING_NS;
        (!fits).then(|| {
            let off = format!("by at most {deviation_ns} ns");
            format!("calibrated, the device's clock counts {device_ns} ns, the host's {host_ns}, read apart {off}")
        })
    }
}

impl Pass {
    /// A pass cannot take longer than the submit that it is in.
    fn complaint(&self) -> Option<String> {
        let Self { name, wall_ns, timestamp_ns } = self;
        let most = *wall_ns as f64 * (1.0 + RATE_BOUND) + READING_NS;
        let fits = *timestamp_ns as f64 <= most;
        (!fits).then(|| format!("{name}: {timestamp_ns} ns by its timestamps, {wall_ns} from its submit to its fence"))
    }
}

impl Frame {
    /// The second of two frames: the first warms up.
    fn of(bed: &mut Bed, request: RenderRequest<'static>) -> Result<Self> {
        let renderer = bed.profiled(request)?;
        renderer.frame()?;
        let frame = renderer.frame()?;
        let pass = |(pass, time): (&crate::gpu::commands::RecordedPass, &crate::gpu::timing::PassTime)| Pass {
            name: pass.name.clone(),
            wall_ns: time.wall_ns.unwrap_or_default(),
            timestamp_ns: time.timestamp_ns.unwrap_or_default(),
        };
        let passes: Vec<Pass> = renderer.passes().iter().zip(&frame.passes).map(pass).collect();
        let sum = |of: fn(&Pass) -> u64| passes.iter().map(of).sum::<u64>() as f64;
        let ratio = sum(|pass| pass.timestamp_ns) / sum(|pass| pass.wall_ns).max(1.0);
        Ok(Self { technique: request.1, passes, ratio })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tick of another length than said, and a time that was never in its submit.
    #[test]
    fn clocks_that_cannot_both_be_right_are_complained_of() {
        for (device_ns, fits) in
            [(100e6, true), (100.9e6, true), (99.95e6, true), (98e6, false), (52.08e6, false), (101.2e6, false)]
        {
            let rate = Rate { device_ns, host_least_ns: 100e6, host_most_ns: 101e6 };
            assert_eq!(rate.complaint().is_none(), fits, "{rate:?}");
        }
        for (device_ns, fits) in [(100e6, true), (100.09e6, true), (100.2e6, false), (99.8e6, false)] {
            let calibrated = Calibrated { device_ns, host_ns: 100e6, deviation_ns: 10e3, ratio: device_ns / 100e6 };
            assert_eq!(calibrated.complaint().is_none(), fits, "{calibrated:?}");
        }
        for (timestamp_ns, fits) in [(0, true), (90_000, true), (102_000, true), (103_000, false)] {
            let pass = Pass { name: "shade".to_owned(), wall_ns: 100_000, timestamp_ns };
            assert_eq!(pass.complaint().is_none(), fits, "{pass:?}");
        }
    }
}
