//! `quincunx bench run FILE.toml`: a sweep as a file, which says what the flags of `bench` say. What comes of it are commands that a
//! user can type, one a scene.

use super::output::{folder_flag, quiet_flag};
use crate::bench::shard::Shard;
use crate::bench::sweep;
use crate::error::{Error, Result};
use crate::settings::scalar::Scalar;
use crate::whole_file::read_toml;
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use indexmap::IndexMap;
use serde::Deserialize;
use std::fmt;
use std::path::{Path, PathBuf};

pub const NAME: &str = "run";

/// The file. Its keys are the flags of `bench`, without their dashes.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
struct Sweep {
    /// The word behind `bench`; `frame` where it is not there.
    bench: Option<String>,
    /// The technique's own scene where there is none.
    scenes: Vec<String>,
    technique: Option<String>,
    preset: Option<String>,
    repeat: Option<u32>,
    until_interval: Option<f64>,
    group: Option<u32>,
    baseline: Option<String>,
    fair: bool,
    frames: Option<String>,
    rate: Option<String>,
    reference: Option<String>,
    reference_spp: Option<u32>,
    fail_if: Vec<String>,
    /// What all rows have.
    settings: IndexMap<String, Scalar>,
    /// The axes of the grid.
    sweep: IndexMap<String, Vec<Scalar>>,
    /// Rows beside the grid.
    point: Vec<Point>,
}

#[derive(Deserialize)]
struct Point {
    /// As `--point` has it; no setting has this key.
    name: Option<String>,
    #[serde(flatten)]
    settings: IndexMap<String, Scalar>,
}

/// `--shard I/N`, of all that measures rows.
pub fn shard_flag() -> Arg {
    Arg::new("shard")
        .long("shard")
        .value_name("I/N")
        .value_parser(value_parser!(Shard))
        .help("Measure only the I-th of N parts of the rows, chosen by what they are of; `bench merge` joins them")
}

/// The sub-verb with its arguments.
pub fn command() -> Command {
    let flag = |name: &'static str| Arg::new(name).long(name).action(ArgAction::SetTrue);
    Command::new(NAME)
        .about("Measure what a file says: a grid, points beside it, scenes")
        .after_help(
            "The file is TOML: bench, scenes, technique, preset, repeat, until-interval, group, baseline, fair, frames, rate, reference, \
             reference-spp, fail-if; [settings] of all rows; [sweep] with a list for each axis; [[point]] for each row beside the \
             grid, whose name is what tables call it.",
        )
        .arg(Arg::new("file").value_name("FILE.toml").required(true).value_parser(value_parser!(PathBuf)))
        .arg(folder_flag("Folder for results; of several scenes with a folder in it for each").required(true))
        .arg(flag("resume").help("Measure only what is missing"))
        .arg(flag("force").conflicts_with("resume").help("Replace what is there"))
        .arg(shard_flag())
        .arg(Arg::new("device").long("device").value_name("SUBSTRING|INDEX").help("Device, by a part of its name or its index"))
        .arg(quiet_flag())
        .arg(flag("json").help("Print each row as a line of JSON"))
}

/// The commands that the file comes to, without the program's name.
///
/// Errors: the file cannot be read, or is no sweep (exit code 2).
pub fn commands(matches: &ArgMatches) -> Result<Vec<Vec<String>>> {
    let path = matches.get_one::<PathBuf>("file").expect("clap requires it");
    let sweep: Sweep = read_toml(path)?;
    let folder = matches.get_one::<PathBuf>("output").expect("clap requires it");
    let words = sweep.words(matches).map_err(|error| error.within(path.display()))?;
    let scenes: Vec<Option<&str>> = match &sweep.scenes[..] {
        [] => vec![None],
        scenes => scenes.iter().map(|scene| Some(scene.as_str())).collect(),
    };
    let is_one = scenes.len() == 1;
    let command = |scene: Option<&str>| {
        let own = if is_one { folder.clone() } else { folder.join(stem(scene.unwrap_or_default())) };
        let mut command = vec!["bench".to_owned(), sweep.bench.clone().unwrap_or_else(|| "frame".to_owned())];
        command.extend(scene.map(str::to_owned));
        command.extend(words.iter().cloned());
        command.extend(["-o".to_owned(), own.display().to_string()]);
        command
    };
    let folders: Vec<String> = scenes.iter().map(|scene| stem(scene.unwrap_or_default())).collect();
    if let Some(twice) = (1..folders.len()).find(|index| folders[..*index].contains(&folders[*index])) {
        let (scene, name) = (scenes[twice].unwrap_or_default(), &folders[twice]);
        return Err(Error::request(format!("{}: scenes: the folder {name} of {scene} is another's", path.display())));
    }
    Ok(scenes.into_iter().map(command).collect())
}

/// A scene's name as that of a folder: a file's by its stem.
fn stem(scene: &str) -> String {
    let is_file = Path::new(scene).extension().is_some_and(|extension| extension == "glb" || extension == "gltf");
    let name =
        if is_file { Path::new(scene).file_stem().map(|stem| stem.to_string_lossy()) } else { Some(scene.into()) };
    let kept = |letter: char| if letter.is_ascii_alphanumeric() || letter == '_' { letter } else { '-' };
    name.unwrap_or_default().chars().map(kept).collect()
}

impl Sweep {
    /// What follows the scene, of the file and of the flags beside it.
    ///
    /// Errors: a point's name cannot be one (exit code 2).
    fn words(&self, matches: &ArgMatches) -> Result<Vec<String>> {
        let mut words: Vec<String> = Vec::new();
        let mut flag = |name: &str, value: &dyn fmt::Display| words.extend([format!("--{name}"), value.to_string()]);
        for (name, value) in [
            ("technique", &self.technique),
            ("preset", &self.preset),
            ("baseline", &self.baseline),
            ("frames", &self.frames),
            ("rate", &self.rate),
            ("reference", &self.reference),
        ] {
            value.iter().for_each(|value| flag(name, value));
        }
        self.repeat.iter().for_each(|rounds| flag("repeat", rounds));
        self.group.iter().for_each(|most| flag("group", most));
        self.until_interval.iter().for_each(|part| flag("until-interval", part));
        self.reference_spp.iter().for_each(|spp| flag("reference-spp", spp));
        self.fail_if.iter().for_each(|condition| flag("fail-if", condition));
        self.settings.iter().for_each(|(key, value)| flag(key, value));
        for (key, values) in &self.sweep {
            let values: Vec<String> = values.iter().map(Scalar::to_string).collect();
            flag("sweep", &format!("{key}={}", values.join(",")));
        }
        for Point { name, settings } in &self.point {
            name.iter().try_for_each(|name| sweep::require_name(name)).map_err(|error| error.within("[[point]]"))?;
            let pairs = settings.iter().map(|(key, value)| format!("{key}={value}"));
            flag("point", &name.iter().map(|name| format!("{name}:")).chain(pairs).collect::<Vec<_>>().join(" "));
        }
        matches.get_one::<String>("device").iter().for_each(|value| flag("device", value));
        matches.get_one::<Shard>("shard").iter().for_each(|shard| flag("shard", shard));
        let set = ["resume", "force", "quiet", "json"].into_iter().filter(|name| matches.get_flag(name));
        words.extend(set.chain(self.fair.then_some("fair")).map(|name| format!("--{name}")));
        Ok(words)
    }
}

#[cfg(test)]
mod tests {
    use crate::techniques::{self, settings_of};

    #[test]
    fn no_setting_is_called_as_what_names_a_point() {
        let mut settings = techniques::ALL.iter().flat_map(|technique| settings_of(*technique));
        assert!(settings.all(|setting| setting.key != "name"));
    }
}
