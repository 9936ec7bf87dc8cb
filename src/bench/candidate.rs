//! A point of the grid as settings, whether they are possible or not.

use super::sweep::{Point, label};
use crate::error::{Error, Result};
use crate::job::{Job, settings_of};
use crate::settings::Values;
use crate::techniques::{self, Technique};
use std::collections::BTreeMap;

/// The key of a sweep that names techniques; no setting has it.
pub const TECHNIQUE: &str = "technique";

/// A point with all its settings.
pub struct Candidate {
    /// The technique of the point; its settings are those of the request, where it reads them.
    pub job: Job,
    /// Its name in tables, and for `--baseline`.
    pub label: String,
    /// Texts of every setting, those of the point as they were asked for.
    pub settings: BTreeMap<String, String>,
    /// Checked; an error where the point cannot be.
    pub values: Result<Values>,
}

impl Candidate {
    /// `scene_hash`: of the scene that `job` loads; a point that would load another one is impossible.
    pub fn new(job: &Job, point: &Point, scene_hash: &str) -> Self {
        let (named, own): (Point, Point) = point.iter().cloned().partition(|(key, _)| key == TECHNIQUE);
        let with = match named.first() {
            None => Ok(job.at(&job.values)),
            Some((_, name)) => techniques::find(name).and_then(|technique| with_technique(job, technique)),
        };
        let (job, known) = match with {
            Ok(job) => (job, Ok(())),
            Err(error) => (job.at(&job.values), Err(error)),
        };
        let mut settings: BTreeMap<String, String> =
            job.values.iter().map(|(key, text)| (key.to_owned(), text.to_owned())).collect();
        settings.extend(own.iter().cloned());
        let values = known
            .and_then(|()| changed(&job, &job.values, own.iter().map(|(key, text)| (key.as_str(), text.as_str()))))
            .and_then(|values| one_session(&job, &values, scene_hash).map(|()| values));
        Self { job, label: label(point), settings, values }
    }
}

/// `job` with another technique: what both read stays as it is, what the other alone reads is at its default.
///
/// Errors: the other does not take a value, such as shadow maps, of what both read (exit code 2).
fn with_technique(job: &Job, technique: &'static dyn Technique) -> Result<Job> {
    let mut other = Job::new(&job.scene, technique);
    for setting in settings_of(technique) {
        if let Some((_, text)) = job.values.iter().find(|(key, _)| *key == setting.key) {
            other.set(setting.key, text)?;
        }
    }
    Ok(other)
}

/// `values` with some of them changed.
///
/// Errors: the technique does not read one, or it is impossible (exit code 2).
pub fn changed<'a, 'b>(
    job: &Job,
    values: &Values,
    changes: impl IntoIterator<Item = (&'a str, &'b str)>,
) -> Result<Values> {
    let mut changed = job.at(values);
    for (key, text) in changes {
        changed.set(key, text)?;
    }
    Ok(changed.values)
}

/// All variants share a device and a scene: what is settled with those cannot differ.
fn one_session(job: &Job, values: &Values, scene_hash: &str) -> Result<()> {
    for key in ["allocation", "memory-budget", "texture-limit"] {
        let text = values.text(key);
        if text != job.values.text(key) {
            return Err(Error::request(format!(
                "--{key} {text}: it is settled when the device opens, for all variants; each needs a bench of its own"
            )));
        }
    }
    let moved: Vec<String> = ["seed", "time", "animation"]
        .iter()
        .filter(|key| values.text(key) != job.values.text(key))
        .map(|key| format!("--{key} {}", values.text(key)))
        .collect();
    if !moved.is_empty() && job.at(values).load_scene()?.hash != scene_hash {
        return Err(Error::request(format!(
            "{}: the scene {} is another one then, and times compare on one scene",
            moved.join(" "),
            job.scene
        )));
    }
    Ok(())
}
