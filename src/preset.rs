//! Presets: settings in files of TOML, for everything that makes pictures; the user's defaults are one that is always there.
//!
//! What is typed comes before what a preset says, a later preset before an earlier one, and all of them before the user's defaults. A
//! preset is of no technique alone: what the technique of a request does not have is passed over, and so is what its other settings
//! leave unread.

use crate::error::{Error, Result};
use crate::settings::Values;
use crate::settings::scalar::Scalar;
use crate::settings::written::WrittenSettings;
use crate::techniques::{self, Technique, settings_of};
use crate::user_folder;
use crate::whole_file::{read_toml, write_whole};
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use std::io::Write;
use std::path::{Path, PathBuf};

/// The file as it is read.
#[derive(Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
struct File {
    technique: Option<String>,
    settings: IndexMap<String, Scalar>,
    /// How the settings were found, for people.
    #[serde(rename = "tuned")]
    _tuned: Option<toml::Table>,
}

/// The file as it is written.
#[derive(Serialize)]
struct Written<'a> {
    technique: &'a str,
    settings: &'a WrittenSettings,
    tuned: &'a IndexMap<String, toml::Value>,
}

/// A file that was read.
struct Preset {
    path: PathBuf,
    technique: Option<&'static dyn Technique>,
    settings: IndexMap<String, String>,
}

impl Preset {
    /// Errors: the file cannot be read, or names a technique or a setting that is none (exit code 2).
    fn read(path: &Path) -> Result<Self> {
        let within = |error: Error| error.within(path.display());
        let file: File = read_toml(path)?;
        let technique = file.technique.as_deref().map(techniques::find).transpose().map_err(within)?;
        let settings: IndexMap<String, String> =
            file.settings.iter().map(|(key, value)| (key.clone(), value.to_string())).collect();
        let is_known = |key: &str| techniques::ALL.iter().any(|one| has(*one, key));
        match settings.keys().find(|key| !is_known(key)) {
            Some(key) => Err(Error::request(format!("{}: settings: there is no setting {key}", path.display()))
                .note("`quincunx settings --technique all` lists them")),
            None => Ok(Self { path: path.to_owned(), technique, settings }),
        }
    }
}

fn has(technique: &dyn Technique, key: &str) -> bool {
    settings_of(technique).iter().any(|setting| setting.key == key)
}

/// Every preset of a request.
#[derive(Default)]
pub struct Presets {
    /// The weakest first.
    presets: Vec<Preset>,
}

impl Presets {
    /// The user's defaults, and `paths` in the order in which they are typed.
    ///
    /// Errors: as `Preset::read`.
    pub fn read<'a>(paths: impl IntoIterator<Item = &'a PathBuf>) -> Result<Self> {
        let all = user_folder::defaults().into_iter().chain(paths.into_iter().cloned());
        Ok(Self { presets: all.map(|path| Preset::read(&path)).collect::<Result<_>>()? })
    }

    /// The technique that they name.
    pub fn technique(&self) -> Option<&'static dyn Technique> {
        self.presets.iter().rev().find_map(|preset| preset.technique)
    }

    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        self.presets.iter().map(|preset| preset.path.as_path())
    }

    /// Sets in `values` what they say of the settings of `technique`.
    ///
    /// Errors: a value is impossible (exit code 2).
    pub fn set(&self, technique: &dyn Technique, values: &mut Values) -> Result<()> {
        for preset in &self.presets {
            for (key, text) in preset.settings.iter().filter(|(key, _)| has(technique, key)) {
                techniques::set(technique, values, key, text).map_err(|error| error.within(preset.path.display()))?;
            }
        }
        Ok(())
    }

    /// Puts back to its default what they say and others of `values` leave unread: a sentence for each. What `is_typed` stays.
    pub fn drop_unread(
        &self,
        technique: &dyn Technique,
        values: &mut Values,
        is_typed: impl Fn(&str) -> bool,
    ) -> Vec<String> {
        let settings = settings_of(technique);
        let is_ours = |key: &str| self.presets.iter().any(|preset| preset.settings.contains_key(key));
        let mut sentences = Vec::new();
        // What is put back may have been what another one is read by.
        while let Some((setting, unread)) = settings
            .iter()
            .filter(|setting| is_ours(setting.key) && !is_typed(setting.key))
            .filter(|setting| values.text(setting.key) != setting.default)
            .find_map(|setting| Some((setting, (setting.unread)(values)?)))
        {
            sentences.push(unread.sentence(setting.key, values.text(setting.key)));
            values.set(setting, setting.default).expect("a default is possible");
        }
        sentences
    }
}

/// Writes a preset. `tuned`: how its settings were found.
///
/// Errors: as `write_whole`.
pub fn write(
    path: &Path,
    technique: &dyn Technique,
    settings: &WrittenSettings,
    tuned: &IndexMap<String, toml::Value>,
) -> Result<()> {
    let text =
        toml::to_string(&Written { technique: technique.name(), settings, tuned }).expect("tables of plain values");
    write_whole(path, |out| out.write_all(text.as_bytes()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::settings::written::SettingValue;

    fn presets(files: &[&str]) -> Result<Presets> {
        let folder = tempfile::tempdir().unwrap();
        let write = |(index, text): (usize, &&str)| {
            let path = folder.path().join(format!("{index}.toml"));
            std::fs::write(&path, text).unwrap();
            Preset::read(&path)
        };
        Ok(Presets { presets: files.iter().enumerate().map(write).collect::<Result<_>>()? })
    }

    #[test]
    fn a_later_preset_comes_before_an_earlier_one() {
        let presets = presets(&[
            "technique = \"deferred\"\n[settings]\nkernel = 7\nsigma = 0.25\nfuse = true",
            "[settings]\nkernel = 9\nzmax = \"off\"",
        ])
        .unwrap();
        assert_eq!(presets.technique().unwrap().name(), "deferred");
        let interleaved = techniques::find("interleaved_deferred").unwrap();
        let mut values = techniques::defaults(interleaved);
        presets.set(interleaved, &mut values).unwrap();
        assert_eq!(["kernel", "sigma", "fuse"].map(|key| values.text(key).to_owned()), ["9", "0.25", "on"]);
    }

    #[test]
    fn what_others_leave_unread_is_put_back_unless_it_was_typed() {
        let presets = presets(&["[settings]\nsplit = \"two-pass\"\nblock = 32\nkernel = 7"]).unwrap();
        let interleaved = techniques::find("interleaved_deferred").unwrap();
        let with = |changes: &[(&str, &str)]| {
            let mut values = techniques::defaults(interleaved);
            presets.set(interleaved, &mut values).unwrap();
            changes.iter().for_each(|(key, text)| techniques::set(interleaved, &mut values, key, text).unwrap());
            let is_typed = |key: &str| changes.iter().any(|(typed, _)| *typed == key);
            let said = presets.drop_unread(interleaved, &mut values, is_typed);
            (["split", "block", "kernel"].map(|key| values.text(key).to_owned()), said)
        };
        assert_eq!(with(&[]), (["two-pass", "32", "7"].map(str::to_owned), vec![]));
        let (texts, said) = with(&[("split", "none")]);
        assert_eq!((texts, said.len()), (["none", "16", "5"].map(str::to_owned), 2));
        assert!(said[0].starts_with("--block 32 with --split none: it has no blocks"), "{said:?}");
        assert_eq!(with(&[("split", "none"), ("block", "64"), ("kernel", "9")]).1, Vec::<String>::new());
    }

    #[test]
    fn what_is_no_setting_or_no_value_is_refused_with_its_file() {
        for (text, why) in [
            ("technique = \"deferrd\"", "--technique deferrd: there is no such technique"),
            ("[settings]\nblocks = 3", "settings: there is no setting blocks"),
            ("setting = 3", "line 1: unknown field"),
            ("[settings]\nkernel = [3]", "line 2"),
            ("[settings\n", "line 1"),
        ] {
            let error = presets(&[text]).err().unwrap();
            assert!(error.exit_code() == 2 && error.message().contains(why), "{text}: {error}");
            assert!(error.message().contains("0.toml"), "{error}");
        }
        let deferred = techniques::find("interleaved_deferred").unwrap();
        let set = presets(&["[settings]\nkernel = 99"]).unwrap().set(deferred, &mut techniques::defaults(deferred));
        assert!(set.unwrap_err().message().contains("0.toml: interleaved_deferred: --kernel 99: it must be 5 to 17"));
    }

    #[test]
    fn what_is_written_is_read_back() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("preset.toml");
        let technique = techniques::find("interleaved_deferred").unwrap();
        let settings: WrittenSettings = [("split", "two-pass"), ("kernel", "7"), ("sigma", "0.25")]
            .map(|(key, text)| (key.to_owned(), SettingValue::of(text)))
            .into();
        let tuned = [("flip".to_owned(), toml::Value::Float(0.02)), ("scene".to_owned(), "hall".into())].into();
        write(&path, technique, &settings, &tuned).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        assert!(text.contains("kernel = 7\n") && text.contains("sigma = 0.25\n"), "{text}");
        let read = Preset::read(&path).unwrap();
        assert_eq!(read.technique.unwrap().name(), technique.name());
        let texts: Vec<&str> = read.settings.values().map(String::as_str).collect();
        assert_eq!(texts, ["two-pass", "7", "0.25"]);
    }
}
