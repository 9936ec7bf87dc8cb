//! What a case is: a picture by one method of the program, and what it is compared with. Cases are data (`cases`);
//! nothing here runs.

use super::closed_form::ClosedForm;
use crate::error::Result;
use crate::job::Job;
use crate::picture::Picture;
use crate::selftest::judge::Must;
use crate::techniques;
use crate::units::Extent;

/// Settings that differ from their defaults, by key.
pub type Settings = &'static [(&'static str, &'static str)];

/// Methods that make one picture.
#[derive(Debug)]
pub struct Group {
    /// What its methods differ in, in a word or two.
    pub name: &'static str,
    pub technique: &'static str,
    pub place: Place,
    /// Settings of every method, and of the twin if it is of the same technique.
    pub common: Settings,
    pub twin: Twin,
    pub methods: &'static [Settings],
    pub must: Must,
}

/// What is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Place {
    /// A built-in scene, as on the command line.
    Scene(&'static str),
    /// A scene whose picture a formula knows.
    Formula(ClosedForm),
}

impl Place {
    /// As documents have it.
    pub fn name(self) -> String {
        match self {
            Self::Scene(spec) => spec.to_owned(),
            Self::Formula(form) => format!("formula:{}", form.name()),
        }
    }
}

/// What methods are compared with.
#[derive(Clone, Copy, Debug)]
pub enum Twin {
    /// The same technique by a plain method.
    Method(Settings),
    /// Another technique, with all of its settings.
    Other(&'static str, Settings),
    /// The formula of the group's place.
    Formula,
    /// Nothing: it is a picture of which samples must be missing.
    Nothing,
}

/// Side lengths that hold for every case, which names them in `common` where it needs others: odd, so that no workgroup
/// and no pattern divides them.
pub const SIZE: (&str, &str) = ("size", "61x37");

/// One method of a group.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    pub group: &'static Group,
    pub method: Settings,
}

impl Case {
    /// Technique, group and the settings of the method: `deep_shading/lists/compaction=off`.
    pub fn name(&self) -> String {
        let Group { name, technique, .. } = self.group;
        let method: Vec<String> = self.method.iter().map(|(key, text)| format!("{key}={text}")).collect();
        let method = if method.is_empty() { "defaults".to_owned() } else { method.join(",") };
        format!("{technique}/{name}/{method}")
    }

    /// Every setting of the method that is not at its default.
    pub fn settings(&self) -> Vec<(&'static str, &'static str)> {
        [&[SIZE], self.group.common, self.method].concat()
    }

    /// Technique and settings of the twin; None where it is no picture of the device.
    pub fn twin_settings(&self) -> Option<(&'static str, Vec<(&'static str, &'static str)>)> {
        match self.group.twin {
            Twin::Method(method) => Some((self.group.technique, [&[SIZE], self.group.common, method].concat())),
            Twin::Other(technique, settings) => Some((technique, [&[SIZE], settings].concat())),
            Twin::Formula | Twin::Nothing => None,
        }
    }

    /// What the formula of its place says; None where that is a scene.
    pub fn formula(&self, extent: Extent) -> Option<Picture> {
        match self.group.place {
            Place::Formula(form) => Some(form.picture(extent)),
            Place::Scene(_) => None,
        }
    }
}

/// A request for a picture of these settings; later ones win.
///
/// Errors: the technique does not read one, or it is impossible (exit code 2).
pub fn job(place: Place, technique: &str, settings: &[(&'static str, &'static str)]) -> Result<Job> {
    let spec = match place {
        Place::Scene(spec) => spec,
        Place::Formula(_) => "",
    };
    let mut job = Job::new(spec, techniques::find(technique)?);
    for (key, text) in settings {
        job.set(key, text)?;
    }
    Ok(job)
}
