//! A sequence of frames: which moments, into which files, in one session.

use crate::error::{Error, ErrorKind, Result};
use crate::interrupt;
use crate::job::{Job, Outcome, Unfinished, fail_on_validation, scene_of};
use crate::reference::ReferenceRequest;
use crate::report::run::RunReport;
use crate::session::Session;
use crate::settings::Values;
use crate::whole_file::write_whole;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};
use std::io::Write;
use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};

/// The last frame that can be asked for: more than eleven hours at 24 frames a second.
const LAST_FRAME: u32 = 999_999;
/// How many digits a frame's number has in a file's name, at least.
const DIGITS: usize = 4;
const FPS: RangeInclusive<f64> = 0.001..=1000.0;

/// Frames `first` to `last`, both included; frame n is n / fps seconds after `--time`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Frames {
    first: u32,
    last: u32,
    fps: f64,
}

/// What a sequence left.
pub struct Sequence {
    /// One a finished frame, in order.
    pub reports: Vec<RunReport>,
    /// The user stopped it: the frames in `reports` are whole.
    pub is_interrupted: bool,
    /// Whether the gates of `Job::reference` hold in all of these frames.
    pub gates: Result<()>,
}

impl Frames {
    /// `frames`: `A..B`, both included; `fps`: frames a second.
    ///
    /// Errors: not two numbers in order, out of range, no speed (exit code 2).
    pub fn parse(frames: &str, fps: &str) -> Result<Self> {
        let range = frames.split_once("..").and_then(|(first, last)| Some((first.parse().ok()?, last.parse().ok()?)));
        let Some((first, last)) = range.filter(|(first, last)| first <= last && *last <= LAST_FRAME) else {
            return Err(Error::request(format!(
                "--frames {frames}: it must be A..B, from frame A to frame B, with 0 <= A <= B <= {LAST_FRAME}"
            ))
            .note("for example --frames 0..47, two seconds at 24 frames a second"));
        };
        match fps.parse().ok().filter(|fps| FPS.contains(fps)) {
            Some(fps) => Ok(Self { first, last, fps }),
            None => {
                Err(Error::request(format!("--fps {fps}: it must be {} to {} frames a second", FPS.start(), FPS.end())))
            }
        }
    }

    pub fn first(&self) -> u32 {
        self.first
    }

    pub fn last(&self) -> u32 {
        self.last
    }

    /// In order.
    pub fn numbers(&self) -> RangeInclusive<u32> {
        self.first..=self.last
    }

    /// The flags that ask for them again.
    pub fn arguments(&self) -> [String; 4] {
        ["--frames".to_owned(), format!("{}..{}", self.first, self.last), "--fps".to_owned(), self.fps.to_string()]
    }

    /// How many there are, at least one.
    pub fn count(&self) -> usize {
        (self.last - self.first) as usize + 1
    }

    /// The file of a frame beside `path`: NAME.0001.png beside NAME.png.
    pub fn path_of(&self, path: &Path, frame: u32) -> PathBuf {
        let digits = DIGITS.max(self.last.to_string().len());
        let extension = path.extension().unwrap_or_default().to_string_lossy();
        path.with_extension(format!("{frame:0digits$}.{extension}"))
    }

    /// The settings of a frame: those of `job` at the frame's time, at this exposure where it is known.
    ///
    /// Errors: the time is later than `--time` can be (exit code 2).
    pub fn values(&self, job: &Job, frame: u32, exposure_ev: Option<f64>) -> Result<Values> {
        let time_s = job.values.number("time") + f64::from(frame) / self.fps;
        let mut at = job.at(&job.values);
        at.set("time", &time_s.to_string()).map_err(|error| error.within(format!("frame {frame}")))?;
        if let Some(exposure_ev) = exposure_ev {
            at.set("exposure", &exposure_ev.to_string())?;
        }
        Ok(at.values)
    }
}

impl Job {
    /// A picture of each frame, in one session; `finished` is called with each and its number. The report, where one is
    /// asked for, has one entry a frame.
    ///
    /// Errors: as `Job::run`. Ctrl-C is no error: finished frames stay.
    pub fn run_sequence(&self, frames: &Frames, finished: &mut dyn FnMut(u32, &Outcome)) -> Result<Sequence> {
        self.check()?;
        self.reference.as_ref().map_or(Ok(()), ReferenceRequest::check_sequence)?;
        frames.values(self, frames.last, None)?;
        let model = self.open_model()?;
        let mut session: Option<Session> = None;
        // The value of `auto` for the first frame that is not black holds for all: pictures with exposures of their own
        // flicker.
        let mut exposure_ev: Option<f64> = None;
        let mut sequence = Sequence { reports: Vec::new(), is_interrupted: false, gates: Ok(()) };
        for frame in frames.numbers() {
            if interrupt::check().is_err() {
                sequence.is_interrupted = true;
                break;
            }
            let values = frames.values(self, frame, exposure_ev)?;
            let scene = scene_of(&model, &values)?;
            let path = frames.path_of(&self.output_path(&scene), frame);
            let shown = match session.take() {
                None => self.open_session(&self.device_request(), scene)?,
                Some(session) => {
                    let scene = self.with_texturing(scene, &session.gpu.caps);
                    session.at_moment(scene, values.number("tree-growth"))?
                }
            };
            let made = self.picture(&shown, &values, &path, Unfinished::Dropped);
            session = Some(shown);
            match made {
                Ok(mut outcome) => {
                    exposure_ev = exposure_ev.or(outcome.auto_exposure_ev);
                    outcome.report.frame = Some(frame);
                    outcome.report.time_s = Some(values.number("time"));
                    finished(frame, &outcome);
                    sequence.gates = sequence.gates.and(outcome.gates);
                    sequence.reports.push(outcome.report);
                }
                Err(stop) if stop.kind() == ErrorKind::Interrupted => {
                    sequence.is_interrupted = true;
                    break;
                }
                Err(error) => return Err(error.within(format!("frame {frame}"))),
            }
        }
        if let Some(file) = &self.report {
            write_whole(file, |out| writeln!(out, "{:#}", sequence.json()))?;
        }
        let log = session.as_ref().and_then(|session| session.gpu.validation_log());
        // Closing says what was leaked: only then is the log whole.
        drop(session);
        fail_on_validation(log.as_deref())?;
        Ok(sequence)
    }
}

impl Sequence {
    /// The reports of all frames as one document.
    pub fn json(&self) -> Value {
        json!({ "schema": 1, "frames": self.reports })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_has_both_its_ends_and_a_file_a_number() {
        let frames = Frames::parse("8..11", "24").unwrap();
        assert_eq!(frames.count(), 4);
        assert_eq!(frames.path_of(Path::new("out/a.b.png"), 9), Path::new("out/a.b.0009.png"));
        let long = Frames::parse("0..123456", "0.5").unwrap();
        assert_eq!(long.path_of(Path::new("a.exr"), 7), Path::new("a.000007.exr"));
    }

    #[test]
    fn what_is_no_range_says_what_would_work() {
        for text in ["", "3", "5..3", "-1..3", "a..b", "0..1000000", "0..=3", "1...3"] {
            let error = Frames::parse(text, "24").unwrap_err();
            assert_eq!(error.exit_code(), 2);
            assert!(error.to_string().contains("--frames 0..47"), "{error}");
        }
        for text in ["0", "-1", "nan", "inf", "1001", "fast"] {
            let error = Frames::parse("0..1", text).unwrap_err();
            assert!(error.message().contains("0.001 to 1000"), "{error}");
        }
    }
}
