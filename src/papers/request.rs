//! What a user wishes of a reproduction, and the words of a step's command that come of it.

use super::recipe::{Differing, Effort, Step, Verb};
use crate::error::{Error, Result};
use crate::techniques::{self, DEFAULT_TECHNIQUE, Technique, settings_of};
use std::path::PathBuf;

/// How an item is to be made.
#[derive(Clone, Debug)]
pub struct Request {
    /// This program.
    pub program: PathBuf,
    /// Folder of the item's files.
    pub folder: PathBuf,
    pub effort: Effort,
    /// In place of each step's scene.
    pub scene: Option<String>,
    /// In place of each step's rounds.
    pub rounds: Option<u32>,
    /// Keys and values, each for every step whose technique reads it.
    pub settings: Vec<(String, String)>,
    pub device: Option<String>,
    /// Steps whose names begin so; all of them where it is empty.
    pub only: Vec<String>,
    /// Whether what is there is made anew.
    pub is_fresh: bool,
    /// Whether steps say nothing of how they get on.
    pub is_quiet: bool,
}

impl Step {
    /// The scene that it is of; None where it takes none.
    pub fn scene_of<'a>(&'a self, request: &'a Request) -> Option<&'a str> {
        self.scene.as_deref().map(|own| request.scene.as_deref().unwrap_or(own))
    }

    /// Whether its command reads the setting.
    pub fn reads(&self, key: &str) -> bool {
        let is_read = |technique: &dyn Technique| settings_of(technique).iter().any(|setting| setting.key == key);
        match self.verb {
            Verb::Compare { .. } | Verb::Pattern { .. } => false,
            _ => self.techniques().into_iter().any(|name| techniques::find(name).is_ok_and(is_read)),
        }
    }

    /// Names of its techniques.
    fn techniques(&self) -> Vec<&str> {
        let after = |flag: &str| self.words.iter().skip_while(move |word| *word != flag).nth(1).map(String::as_str);
        let swept = self.words.iter().find_map(|word| word.strip_prefix("technique="));
        match (swept, after("--technique")) {
            (Some(swept), _) => swept.split(',').collect(),
            (None, Some(name)) => vec![name],
            (None, None) => vec![DEFAULT_TECHNIQUE],
        }
    }

    /// Whether the setting is an axis of its sweep.
    pub fn sweeps(&self, key: &str) -> bool {
        self.words.iter().any(|word| word.strip_prefix(key).is_some_and(|rest| rest.starts_with('=')))
    }

    /// The command without the program's name, as a user would type it.
    pub fn command(&self, request: &Request) -> Vec<String> {
        let file = |name: &str| request.folder.join(name).display().to_string();
        let mut command: Vec<String> = match &self.verb {
            Verb::Bench { what, .. } => vec!["bench".to_owned(), what.clone()],
            Verb::Render { .. } => vec!["render".to_owned()],
            Verb::Compare { files, .. } => vec!["compare".to_owned(), file(&files[0]), file(&files[1])],
            Verb::Memory => vec!["memory".to_owned()],
            Verb::Pattern { pattern } => ["sampling", "inspect", pattern].map(str::to_owned).to_vec(),
        };
        command.extend(self.scene_of(request).map(str::to_owned));
        command.extend(self.words.iter().map(|word| word.strip_prefix('@').map_or_else(|| word.clone(), file)));
        for (key, value) in request.settings.iter().filter(|(key, _)| self.reads(key)) {
            set(&mut command, &format!("--{key}"), value);
        }
        if let Some(device) = &request.device
            && matches!(self.verb, Verb::Bench { .. } | Verb::Render { .. })
        {
            set(&mut command, "--device", device);
        }
        let name = &self.name;
        match &self.verb {
            Verb::Bench { rounds, .. } => {
                let rounds = request.rounds.unwrap_or(request.effort.pick(*rounds, QUICK_ROUNDS.min(*rounds)));
                set(&mut command, "--repeat", &rounds.to_string());
                set(&mut command, "-o", &file(name));
            }
            Verb::Render { extension } => {
                set(&mut command, "-o", &file(&format!("{name}.{extension}")));
                set(&mut command, "--report", &file(&format!("{name}.json")));
            }
            Verb::Pattern { .. } => {
                set(&mut command, "-o", &file(&format!("{name}.png")));
                for extension in ["png", "svg"] {
                    command.extend(["--spectrum".to_owned(), file(&format!("{name}.spectrum.{extension}"))]);
                }
                command.push("--json".to_owned());
            }
            Verb::Compare { picture, .. } => {
                let (flag, extension) = match picture {
                    Differing::Map => ("--diff", "png"),
                    Differing::Spectrum => ("--spectrum", "svg"),
                };
                command.extend([flag.to_owned(), file(&format!("{name}.{extension}")), "--json".to_owned()]);
            }
            Verb::Memory => command.push("--json".to_owned()),
        }
        command
    }
}

/// Rounds that an interval takes.
const QUICK_ROUNDS: u32 = 3;

/// Gives a flag its value, in place of the one that it has.
fn set(command: &mut Vec<String>, flag: &str, value: &str) {
    match command.iter().position(|word| word == flag) {
        Some(at) => command[at + 1] = value.to_owned(),
        None => command.extend([flag.to_owned(), value.to_owned()]),
    }
}

impl Request {
    /// Whether the step is asked for.
    pub fn wants(&self, step: &Step) -> bool {
        self.only.is_empty() || self.only.iter().any(|start| step.name.starts_with(start.as_str()))
    }

    /// Errors: no step is measured in rounds, and rounds are named; a setting is one that a step sweeps, or that no step reads; a scene is named, and no step takes one (exit
    /// code 2).
    pub fn check(&self, item: &str, steps: &[Step]) -> Result<()> {
        for (key, _) in &self.settings {
            if let Some(step) = steps.iter().find(|step| step.sweeps(key)) {
                return Err(Error::request(format!("--{key}: {item} measures several of it (step {})", step.name)));
            }
            if !steps.iter().any(|step| step.reads(key)) {
                return Err(Error::request(format!("--{key}: no command of {item} reads it")));
            }
        }
        if let Some(rounds) = self.rounds
            && !steps.iter().any(|step| matches!(step.verb, Verb::Bench { .. }))
        {
            return Err(Error::request(format!("--repeat {rounds}: {item} measures no times")));
        }
        if let Some(scene) = &self.scene
            && steps.iter().all(|step| step.scene.is_none())
        {
            return Err(Error::request(format!("--scene {scene}: {item} is arithmetic, and has no scene")));
        }
        Ok(())
    }
}
