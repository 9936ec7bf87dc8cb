//! A point of the grid as settings, whether they are possible or not.

use super::sweep::{Axis, Point, label};
use crate::error::{Error, Result};
use crate::job::Job;
use crate::memory::touched::Touched;
use crate::settings::{Setting, Values, readers};
use crate::techniques::{self, Technique, settings_of, timed};
use std::collections::BTreeMap;

/// The key of a sweep that names techniques; no setting has it.
pub const TECHNIQUE: &str = "technique";

/// Texels a thread under `--fair` without `--texels`: every variant can shade one.
const FAIR_TEXELS: &str = "1";

/// A point with all its settings.
pub struct Candidate {
    /// The technique of the point; its settings are those of the request, where it reads them.
    pub job: Job,
    /// What it sets, in words: in tables where it has no name, and for `--baseline`.
    pub label: String,
    /// As `NamedPoint` has it.
    pub name: Option<String>,
    /// Texts of what was asked for: settings of the request that are not at their defaults, and the point's own.
    pub asked: BTreeMap<String, String>,
    /// Texts of every setting, those of the point as they were asked for.
    pub settings: BTreeMap<String, String>,
    /// Why nothing reads a setting, by its key; None where the settings cannot be.
    unread: Option<BTreeMap<&'static str, String>>,
    /// Keys of the point that nothing reads.
    pub unread_axes: Vec<String>,
    /// Checked, and what nothing reads at its default; an error where the point is impossible, or where another
    /// represents it.
    pub values: Result<Values>,
}

impl Candidate {
    /// `scene_hash`: of the scene that `job` loads; a point that would load another one is impossible. `is_fair`: as
    /// `Request` has it.
    pub fn new(job: &Job, axes: &[Axis], point: &Point, is_fair: bool, scene_hash: &str) -> Self {
        let (named, own): (Point, Point) = point.iter().cloned().partition(|(key, _)| key == TECHNIQUE);
        let with = match named.first() {
            None => Ok(job.at(&job.values)),
            Some((_, name)) => techniques::find(name).and_then(|technique| with_technique(job, technique)),
        };
        let (mut job, known) = match with {
            Ok(job) => (job, Ok(())),
            Err(error) => (job.at(&job.values), Err(error)),
        };
        let known = known.and_then(|()| if is_fair { share_texels(&mut job) } else { Ok(()) });
        let mut settings: BTreeMap<String, String> =
            job.values.iter().map(|(key, text)| (key.to_owned(), text.to_owned())).collect();
        settings.extend(own.iter().cloned());
        let mut asked: BTreeMap<String, String> =
            changed_texts(&job).map(|(key, text)| (key.to_owned(), text.to_owned())).collect();
        asked.extend(own.iter().cloned());
        let checked = known
            .and_then(|()| changed(&job, &job.values, own.iter().map(|(key, text)| (key.as_str(), text.as_str()))))
            .and_then(|values| one_session(&job, &values, scene_hash).map(|()| values));
        let unread = checked.as_ref().ok().map(|values| unread_of(job.technique, values));
        let is_unread = |key: &str| unread.as_ref().is_some_and(|unread| unread.contains_key(key));
        let unread_axes: Vec<String> = own.iter().map(|(key, _)| key.clone()).filter(|key| is_unread(key)).collect();
        // The first of the grid's points that differ only in settings that are not read represents them all.
        let first = |key: &str| axes.iter().find(|axis| axis.key == key).map(|axis| axis.values[0].as_str());
        let other = own.iter().find(|(key, text)| unread_axes.contains(key) && first(key) != Some(text.as_str()));
        let values = checked.and_then(|values| match (other, &unread) {
            (Some((key, _)), Some(unread)) => {
                let why = &unread[key.as_str()];
                // A point beside the grid may name what is no axis.
                let stands = first(key).map(|stands| format!("; the row with {key}={stands} stands for it"));
                Err(Error::request(format!("{why}{}", stands.unwrap_or_default())))
            }
            _ => Ok(timed(job.technique, &without_unread(job.technique, &values))),
        });
        Self { job, label: label(point), name: None, asked, settings, unread, unread_axes, values }
    }

    /// The same, called `name`.
    pub fn named(self, name: Option<String>) -> Self {
        Self { name, ..self }
    }

    /// Why nothing reads `key`; None where something does, or where the settings cannot be.
    fn why_unread(&self, key: &str) -> Option<&str> {
        self.unread.as_ref()?.get(key).map(String::as_str)
    }

    /// Whether its settings can be, and `key` is one of them.
    fn has(&self, key: &str) -> bool {
        self.unread.is_some() && self.settings.contains_key(key)
    }
}

/// Errors: no point reads an axis, or a setting that is changed for all of them (exit code 2).
pub fn require_readers(job: &Job, axes: &[Axis], candidates: &[Candidate]) -> Result<()> {
    let unread_by_all = |key: &str| {
        let mut whys = candidates.iter().filter(|candidate| candidate.has(key)).map(|one| one.why_unread(key));
        let first = whys.next()??;
        whys.all(|why| why.is_some()).then_some(first)
    };
    for axis in axes {
        if let Some(why) = unread_by_all(&axis.key) {
            return Err(Error::request(format!("--sweep {}={}: {why}", axis.key, axis.values.join(","))));
        }
    }
    let is_swept = |key: &str| axes.iter().any(|axis| axis.key == key);
    match changed_texts(job).filter(|(key, _)| !is_swept(key)).find_map(|(key, _)| unread_by_all(key)) {
        Some(why) => Err(Error::request(why)),
        None => Ok(()),
    }
}

/// Settings of `job` that are not at their defaults.
fn changed_texts(job: &Job) -> impl Iterator<Item = (&'static str, &str)> {
    let settings = settings_of(job.technique);
    let is_default = move |key: &str, text: &str| settings.iter().any(|row| row.key == key && row.default == text);
    job.values.iter().filter(move |(key, text)| !is_default(key, text))
}

fn unread_of(technique: &dyn Technique, values: &Values) -> BTreeMap<&'static str, String> {
    let why = |setting: &Setting| {
        let unread = (setting.unread)(values)?;
        Some((setting.key, unread.sentence(setting.key, values.text(setting.key))))
    };
    settings_of(technique).iter().filter_map(why).collect()
}

/// `values` with what nothing reads at its default.
pub fn without_unread(technique: &dyn Technique, values: &Values) -> Values {
    readers::without_unread(&settings_of(technique), values)
}

/// As many texels a thread as every row has.
///
/// Errors: how many pixels a thread shades is no choice of the technique (exit code 2).
fn share_texels(job: &mut Job) -> Result<()> {
    let text = job.values.get("texels").map(str::to_owned);
    match text {
        None => Err(Error::request(format!("--fair: {} has no --texels to share", job.technique.name()))),
        Some(text) if text == "auto" => job.set("texels", FAIR_TEXELS),
        Some(_) => Ok(()),
    }
}

/// `job` with another technique: what both read stays as it is, what the other alone reads is at its default.
///
/// Errors: the other does not take a value, such as shadow maps, of what both read (exit code 2).
fn with_technique(job: &Job, technique: &'static dyn Technique) -> Result<Job> {
    let mut other = Job::new(&job.scene, technique);
    for setting in settings_of(technique) {
        if let Some(text) = job.values.get(setting.key) {
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
    let touched: Touched = values.choice("touched");
    if touched != Touched::Off {
        let why = format!("--touched {}: frames that count are slow, and their times say nothing", touched.name());
        return Err(Error::request(why).note("`render` and `memory` count"));
    }
    const FIXED: [&str; 7] = [
        "allocation",
        "memory-block",
        "image-tiling",
        "memory-budget",
        "texture-limit",
        "texture-gutters",
        "anisotropy",
    ];
    for key in FIXED {
        let text = values.text(key);
        if text != job.values.text(key) {
            return Err(Error::request(format!(
                "--{key} {text}: it is fixed when the device opens, for all variants; run one bench for each value"
            )));
        }
    }
    let moved: Vec<String> = ["seed", "time", "animation", "volume", "volume-size"]
        .iter()
        .filter_map(|key| values.get(key).map(|text| (key, text)))
        .filter(|(key, text)| job.values.get(key) != Some(text))
        .map(|(key, text)| format!("--{key} {text}"))
        .collect();
    if !moved.is_empty() && job.at(values).load_scene()?.hash != scene_hash {
        return Err(Error::request(format!(
            "{}: this changes the scene {}, and times compare only on the same scene",
            moved.join(" "),
            job.scene
        )));
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::sweep::{axes, grid};

    fn candidates(job: &Job, texts: &[&str], is_fair: bool) -> (Vec<Axis>, Vec<Candidate>) {
        let axes = axes(&texts.iter().map(|text| (*text).to_owned()).collect::<Vec<_>>()).unwrap();
        let found = grid(&axes).iter().map(|point| Candidate::new(job, &axes, point, is_fair, "")).collect();
        (axes, found)
    }

    fn job(changes: &[(&str, &str)]) -> Job {
        let mut job = Job::new("cornell", techniques::find("interleaved_deferred").unwrap());
        changes.iter().for_each(|(key, text)| job.set(key, text).unwrap());
        job
    }

    #[test]
    fn what_nothing_reads_tells_no_points_apart() {
        let (axes, points) = candidates(&job(&[]), &["split=one-pass,two-pass", "block=8,32"], false);
        require_readers(&job(&[]), &axes, &points).unwrap();
        let why = points[1].values.as_ref().unwrap_err();
        assert!(why.message().contains("--block 32 with --split one-pass: it has no blocks"), "{why}");
        assert!(why.message().ends_with("the row with block=8 stands for it"), "{why}");
        assert_eq!((&points[0].unread_axes[..], points[2].unread_axes.len()), (&["block".to_owned()][..], 0));
        // What is not read is at its default, and what was asked for is known all the same.
        let texts =
            |index: usize| (points[index].values.as_ref().unwrap().text("block"), &points[index].asked["block"][..]);
        assert_eq!([texts(0), texts(2), texts(3)], [("16", "8"), ("8", "8"), ("32", "32")]);
    }

    #[test]
    fn an_axis_or_a_setting_that_no_point_reads_is_refused() {
        for (changes, sweeps, sentence) in [
            (&[][..], &["block=8,16,32"][..], Some("--sweep block=8,16,32: --block 8 with --split one-pass")),
            (&[("block", "32")], &["split=none,one-pass"], Some("--block 32 with --split none: it has no blocks")),
            (&[("block", "32")], &["split=none,two-pass"], None),
            (&[("pattern", "2x2")], &["split=none,one-pass"], None),
            (&[("filter", "none")], &["kernel=5,7"], Some("--sweep kernel=5,7: --kernel 5 with --filter none")),
            (&[], &["kernel=5,7", "filter=none,gauss"], None),
        ] {
            let job = job(changes);
            let (axes, points) = candidates(&job, sweeps, false);
            let found = require_readers(&job, &axes, &points).err().map(|error| error.message().to_owned());
            assert_eq!(found.is_some(), sentence.is_some(), "{changes:?} {sweeps:?}: {found:?}");
            assert!(found.unwrap_or_default().starts_with(sentence.unwrap_or_default()), "{changes:?} {sweeps:?}");
        }
    }

    #[test]
    fn fair_points_share_one_number_of_texels() {
        let texels = |changes: &[(&str, &str)]| {
            let (_, points) = candidates(&job(changes), &["split=none,branch"], true);
            points.iter().map(|point| point.values.as_ref().unwrap().text("texels").to_owned()).collect::<Vec<_>>()
        };
        assert_eq!(texels(&[]), ["1", "1"]);
        assert_eq!(texels(&[("texels", "4")]), ["4", "4"]);
        let forward = Job::new("cornell", techniques::find("forward").unwrap());
        let (_, points) = candidates(&forward, &["msaa=1,4"], true);
        assert!(points[0].values.as_ref().unwrap_err().message().contains("forward has no --texels"));
    }
}
