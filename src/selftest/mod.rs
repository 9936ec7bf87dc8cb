//! The self-test: small pictures by every technique and every method that a device supports, beside a plain twin or a
//! formula; and the clocks. What a GPU does that no software driver shows is found in its first minutes, and leaves as
//! one document.
//!
//! [`cases`] has what is tried, as data; [`bed`] runs it, [`judge`] compares pictures, [`document`] reports.

pub mod bed;
pub mod case;
pub mod cases;
pub mod clocks;
pub mod closed_form;
pub mod document;
pub mod judge;

use crate::caps::Caps;
use crate::error::{Error, Result};
use crate::gpu::DeviceRequest;
use crate::gpu::validation::Message;
use crate::interrupt;
use crate::progress::Stage;
use bed::{Bed, Refusal, RenderOutcome, Rendered};
use case::{Case, Twin};
use clocks::Clocks;
use judge::{Figures, Must};
use std::time::Instant;

/// The counter of samples that no list has a colour for: 0 wherever something is to be drawn.
const MISSING: &str = "samples_without_colour";

/// What is to be tried, and on what.
#[derive(Clone, Debug, Default)]
pub struct Request {
    pub device: DeviceRequest,
    /// What wanted names, or what follows a slash in them, begin with; empty: all cases, and the clocks.
    pub only: Vec<String>,
}

impl Request {
    fn wants(&self, name: &str) -> bool {
        let begins = |text: &str| self.only.iter().any(|part| text.starts_with(part.as_str()));
        self.only.is_empty() || begins(name) || name.match_indices('/').any(|(at, _)| begins(&name[at + 1..]))
    }
}

/// How a case came out.
#[derive(Clone, Debug)]
pub enum Verdict {
    Held,
    /// Why not, a sentence each.
    Failed(Vec<String>),
    /// The device lacks what the method or its twin needs: no failure.
    Refused(Refusal),
}

/// A case that was tried.
#[derive(Clone, Debug)]
pub struct CaseResult {
    pub case: Case,
    pub verdict: Verdict,
    /// None: there are not two pictures.
    pub figures: Option<Figures>,
    /// Samples that no list has a colour for; None where the technique has no such lists.
    pub missing_samples: Option<f64>,
    pub wall_ns: Option<u64>,
    pub device_ns: Option<u64>,
    pub seconds: f64,
}

/// All that was found.
#[derive(Debug)]
pub struct Outcome {
    pub caps: Caps,
    pub is_robust: bool,
    pub is_validated: bool,
    pub tried: Vec<CaseResult>,
    /// None: they were not asked for.
    pub clocks: Option<Clocks>,
    /// What the validation layer said while the device was closed.
    pub last_words: Vec<String>,
    pub seconds: f64,
}

/// Tries what `request` names; `on_case` sees each case as it ends.
///
/// Errors: no fitting device (exit code 3); no case has such a name (2); Ctrl-C (130). What fails on the device is no
/// error, but a verdict.
pub fn run(request: &Request, on_case: &mut dyn FnMut(&CaseResult)) -> Result<Outcome> {
    let started = Instant::now();
    let cases: Vec<Case> = cases::all().filter(|case| request.wants(&case.name())).collect();
    let wants_clocks = request.wants(clocks::NAME);
    if cases.is_empty() && !wants_clocks {
        return Err(no_such_case(&request.only));
    }
    let mut bed = Bed::new(&request.device)?;
    let caps = bed.caps().clone();
    let clocks = wants_clocks.then(|| {
        clocks::compare(&mut bed)
            .unwrap_or_else(|error| Clocks { complaints: vec![error.to_string()], ..Clocks::default() })
    });
    let (stage, all) = (Stage::counted("self-test", "cases"), cases.len() as u64);
    let mut tried = Vec::new();
    for case in cases {
        interrupt::check()?;
        let one = attempt(&mut bed, case);
        // A picture that was interrupted is unfinished, and no failure of the device.
        interrupt::check()?;
        on_case(&one);
        tried.push(one);
        stage.reach(tried.len() as u64, all);
    }
    drop(stage);
    let last_words = bed.close().iter().map(sentence).collect();
    Ok(Outcome {
        caps,
        is_robust: request.device.robust,
        is_validated: request.device.validate,
        tried,
        clocks,
        last_words,
        seconds: started.elapsed().as_secs_f64(),
    })
}

fn no_such_case(only: &[String]) -> Error {
    let mut kinds: Vec<String> =
        cases::all().map(|case| format!("{}/{}", case.group.technique, case.group.name)).collect();
    kinds.dedup();
    Error::request(format!(
        "--only {}: no case has a name, or a part of it after a slash, that begins so",
        only.join(",")
    ))
    .note(format!("there are: {}, {}", clocks::NAME, kinds.join(", ")))
}

fn sentence(message: &Message) -> String {
    format!("validation: {}: {}", message.id, message.text)
}

/// Renders a case and its twin, and judges.
fn attempt(bed: &mut Bed, case: Case) -> CaseResult {
    let started = Instant::now();
    let mut tried = CaseResult {
        case,
        verdict: Verdict::Held,
        figures: None,
        missing_samples: None,
        wall_ns: None,
        device_ns: None,
        seconds: 0.0,
    };
    let verdict = judged(bed, &mut tried).unwrap_or_else(|error| Verdict::Failed(vec![error.to_string()]));
    let said: Vec<String> = bed.messages().iter().map(sentence).collect();
    tried.verdict = match verdict {
        verdict if said.is_empty() => verdict,
        Verdict::Failed(complaints) => Verdict::Failed([complaints, said].concat()),
        Verdict::Held | Verdict::Refused(_) => Verdict::Failed(said),
    };
    tried.seconds = started.elapsed().as_secs_f64();
    tried
}

/// Errors: one of the pictures cannot be made.
fn judged(bed: &mut Bed, tried: &mut CaseResult) -> Result<Verdict> {
    let case = tried.case;
    let (place, is_software) = (case.group.place, bed.caps().identity.is_software());
    let rendered = match bed.render((place, case.group.technique, &case.settings()))? {
        RenderOutcome::Rendered(rendered) => rendered,
        RenderOutcome::Refused(refusal) => return Ok(Verdict::Refused(refusal)),
    };
    (tried.wall_ns, tried.device_ns) = (Some(rendered.wall_ns), rendered.device_ns);
    tried.missing_samples = rendered.counters.get(MISSING).copied();
    let mut complaints: Vec<String> = missing(case.group.must, &rendered).into_iter().collect();
    let reference = match (case.group.twin, case.twin_settings()) {
        (Twin::Formula, _) => case.formula(rendered.picture.extent),
        (_, Some((technique, settings))) => match bed.twin((place, technique, &settings)) {
            Ok(RenderOutcome::Rendered(twin)) => Some(twin.picture),
            Ok(RenderOutcome::Refused(refusal)) => return Ok(Verdict::Refused(refusal)),
            Err(error) => return Err(error.within("its twin")),
        },
        (_, None) => None,
    };
    if let Some(reference) = reference {
        let figures = Figures::of(&rendered.picture, &reference)?;
        complaints.extend(figures.complaints(&case.group.must, is_software));
        tried.figures = Some(figures);
    }
    Ok(if complaints.is_empty() { Verdict::Held } else { Verdict::Failed(complaints) })
}

/// What is wrong about the samples that no list has a colour for.
fn missing(must: Must, rendered: &Rendered) -> Option<String> {
    let count = rendered.counters.get(MISSING).copied();
    match must {
        Must::LackSamples if count.unwrap_or_default() == 0.0 => {
            Some("no sample is without colour where some must be: they are not counted".to_owned())
        }
        Must::LackSamples => None,
        _ => count.filter(|count| *count > 0.0).map(|count| format!("{count} samples have no colour")),
    }
}

impl Outcome {
    /// Names of what failed.
    pub fn failed(&self) -> Vec<String> {
        let failed = self.tried.iter().filter(|tried| matches!(tried.verdict, Verdict::Failed(_)));
        let mut names: Vec<String> = failed.map(|tried| tried.case.name()).collect();
        if self.clocks.as_ref().is_some_and(|clocks| !clocks.complaints.is_empty()) {
            names.insert(0, clocks::NAME.to_owned());
        }
        if !self.last_words.is_empty() {
            names.push("closing".to_owned());
        }
        names
    }

    /// Errors: something failed (exit code 1).
    pub fn verdict(&self) -> Result<()> {
        let failed = self.failed();
        if failed.is_empty() {
            return Ok(());
        }
        let error = Error::gate(format!("self-test: {} of {} failed", failed.len(), self.tried.len()));
        Err(failed.iter().fold(error, |error, name| error.note(name)))
    }
}
