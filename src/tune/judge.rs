//! The judge of pictures: against the reference that was asked for, else against the technique's plain form.

use super::shown::Shown;
use crate::bench::candidate::Candidate;
use crate::bench::reference::References;
use crate::bench::what::What;
use crate::error::{Error, Result};
use crate::job::Job;
use crate::metrics::gate::Gate;
use crate::metrics::{self, DEFAULT_THRESHOLD, Metrics};
use crate::picture::Picture;
use crate::session::Session;

pub struct Judge<'a> {
    job: &'a Job,
    session: &'a Session,
    bounds: &'a [Gate],
    references: References,
}

impl<'a> Judge<'a> {
    pub fn new(job: &'a Job, session: &'a Session, bounds: &'a [Gate]) -> Self {
        Self { job, session, bounds, references: References::default() }
    }

    /// The picture of a candidate, judged. `settings`: those that make it.
    ///
    /// Errors: there is nothing to judge it by (exit code 2); the picture holds NaN or infinity (1); the device fails (4).
    pub fn judged(&mut self, candidate: &Candidate, picture: &Picture, settings: &str) -> Result<Shown> {
        let errors = self.errors(candidate, picture).map_err(|error| error.within(&candidate.label))?;
        let is_near = is_near(self.bounds, &errors);
        Ok(Shown { settings: settings.to_owned(), errors: Some(errors), is_near })
    }

    fn errors(&mut self, candidate: &Candidate, picture: &Picture) -> Result<Metrics> {
        let values = candidate.values.as_ref().map_err(Error::clone)?;
        if let Some(asked) = &self.job.reference {
            return Ok(asked.judge(picture, candidate.job.technique, values, self.session)?.errors.metrics);
        }
        let plain = self.references.of(&candidate.job, self.session, What::Frame, values)?;
        let plain = plain.map_err(|error| error.note("--reference auto judges it by the path-traced picture"))?;
        Ok(metrics::compare(picture, &plain.picture, DEFAULT_THRESHOLD)?.metrics)
    }

    /// The picture that is nearest by the first bound, and how near it is; None where none was made.
    pub fn nearest(&self, shown: &[Shown]) -> Option<(String, String)> {
        let bound = self.bounds.first()?;
        let nearest = shown.iter().filter_map(|one| Some((one, one.errors?)));
        let nearest = nearest.min_by(|(_, a), (_, b)| bound.measured(a).total_cmp(&bound.measured(b)));
        nearest.map(|(one, errors)| (one.settings.clone(), words(self.bounds, &errors)))
    }
}

/// Whether all bounds hold.
pub fn is_near(bounds: &[Gate], errors: &Metrics) -> bool {
    bounds.iter().all(|bound| bound.verdict(errors).passed)
}

/// `flip 0.021, rmse 0.004`: what the bounds measure.
pub fn words(bounds: &[Gate], errors: &Metrics) -> String {
    let words = bounds.iter().map(|bound| format!("{} {:.4}", bound.name(), bound.measured(errors)));
    words.collect::<Vec<_>>().join(", ")
}
