//! Every number that a technique reads, as one table: command line, help, sweeps and reports are made from it.
//!
//! A setting's key is its flag without the two leading dashes. A value is kept as the text that would repeat it, checked
//! when it is set, so that what `Values` holds is possible.

mod forward;
mod memory;
mod optics;
mod parse;
pub mod readers;
pub mod scalar;
mod shadow_maps;
mod tables;
mod tree;
mod volume;
mod vpls;
pub mod written;

pub use forward::{FORWARD, LightBuffer};
pub use optics::{
    APERTURE, FOCUS, LIGHT_RADIUS, MEDIUM, MOTION_INTERVAL, MOTION_VECTORS, SHUTTER, STEREO, STEREO_EYES, StereoEyes,
    earlier_s, exposure_s, light_radius_m,
};
pub use parse::{parse_color, parse_sides};
pub use shadow_maps::{
    MAPPED_DIRECT_SHADOW, MapDrawing, MapFilter, SHADOW_BIAS_M, SHADOW_CASTERS, SHADOW_MAPS, SHADOW_SLOPE_BIAS,
};
pub use tables::{
    ANISOTROPY, BRDF, Brdf, COMMON, CULL, CULL_BY, CullBy, CullChoice, DEPTH_PREPASS, DIRECT_SHADOW, DirectShadow,
    EMISSIVE, GEOMETRY, GeometryChoice, Gutters, INSTRUMENT, LIGHT_LISTS, ListChoice, MULTISAMPLE, NORMAL_THRESHOLD,
    POSITION, POSITION_THRESHOLD, PositionStorage, Rig, SHADING, SampleFormat, TEXELS, WORKGROUP,
};
pub use tree::{NodeOrder, StackPlace, TREE};
pub use volume::{VOLUME, VOLUME_PLACE, raw_volume_size, volume_name};
pub use vpls::{VPL_BRDF, VPL_CLAMP};

use crate::choice::{Choice, choices};
use crate::error::{Error, Result};
use crate::units::{Bytes, Extent};
use glam::Vec3;
use parse::{parse_bytes, parse_length, parse_numbers, parse_numbers_or_none, parse_pair};
use std::collections::BTreeMap;

/// The word for a value that the program chooses, of settings with `Setting::auto`.
const AUTO: &str = "auto";

/// What a value may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    Integer {
        min: u64,
        max: u64,
    },
    Number {
        min: f64,
        max: f64,
    },
    Choice(&'static [&'static str]),
    /// `NxM`, both in the range.
    Pair {
        min: u32,
        max: u32,
    },
    /// `NxM`, or `N` for both, in the range.
    Sides {
        min: u32,
        max: u32,
    },
    /// Metres, or a part of the scene's diagonal as `2%`.
    Length,
    /// `512MiB`, `2GiB`, plain bytes, or `none`.
    Bytes,
    /// The same, a power of two in the range.
    PowerOfBytes {
        min: u64,
        max: u64,
    },
    /// Three numbers `R,G,B` of at least 0, or one for all three.
    Color,
    /// One number for each part, with commas between.
    Parts(&'static [Part]),
    /// The same, or `none`.
    PartsOrNone(&'static [Part]),
    /// One or more of these words, with commas between, none of them twice.
    Words(&'static [&'static str]),
    /// Free text, checked where it is used; the word shown in help.
    Text(&'static str),
}

/// One number of several: its word in help, and its range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Part {
    pub word: &'static str,
    pub min: f64,
    pub max: f64,
}

choices! {
    /// What another value of a setting may change of a frame: the light of its pixels, before exposure and tone mapping.
    pub enum Changes {
        /// It is another picture, or another estimate of it.
        "picture" => Picture,
        /// Only where, or how many, samples are taken: the integral that they converge to stays.
        "samples" => Samples,
        /// Only how a file shows it.
        "file" => File,
        /// Nothing of it: only what it costs, or what is written beside it. On the reference driver not a bit is another.
        "nothing" => Nothing,
    }
}

/// One row of the table.
#[derive(Clone, Copy, Debug)]
pub struct Setting {
    pub key: &'static str,
    /// The paper's letter for it, or nothing.
    pub symbol: &'static str,
    pub kind: Kind,
    /// Whether `auto` is possible too: the program chooses, as the help says.
    pub auto: bool,
    pub default: &'static str,
    /// px, m, EV; nothing where it counts or chooses.
    pub unit: &'static str,
    /// Where it comes from, or nothing.
    pub paper: &'static str,
    pub help: &'static str,
    pub changes: Changes,
    /// What leaves it unread; None where something reads it. The values have every setting that this asks for.
    pub unread: fn(&Values) -> Option<Unread>,
}

/// What leaves a setting unread, and what would read it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unread {
    /// The value that does, as a flag.
    with: String,
    why: &'static str,
    /// Flags that read it.
    readers: String,
}

impl Setting {
    /// The base of a row: what it changes, and nothing that only some rows have:
    /// `Setting { key: .., ..Setting::changing(Changes::Picture) }`.
    pub const fn changing(changes: Changes) -> Self {
        Self {
            key: "",
            symbol: "",
            kind: Kind::Choice(&[]),
            auto: false,
            default: "",
            unit: "",
            paper: "",
            help: "",
            changes,
            unread: |_| None,
        }
    }

    /// The words that a choice is one of, `auto` included; None of settings that are no choices.
    pub fn choices(&self) -> Option<Vec<&'static str>> {
        let Kind::Choice(words) = self.kind else { return None };
        Some(self.auto.then_some(AUTO).into_iter().chain(words.iter().copied()).collect())
    }

    /// The range or the choices, for help and errors.
    pub fn range(&self) -> String {
        match self.choices() {
            Some(choices) => choices.join("|"),
            None if self.auto => format!("{AUTO} or {}", self.range_of_kind()),
            None => self.range_of_kind(),
        }
    }

    fn range_of_kind(&self) -> String {
        match self.kind {
            Kind::Integer { min, max } => format!("{min} to {max}"),
            Kind::Number { min, max } => format!("{min} to {max}"),
            Kind::Choice(words) => words.join("|"),
            Kind::Pair { min, max } => format!("NxM, both {min} to {max}"),
            Kind::Sides { min, max } => format!("N or NxM, each {min} to {max}"),
            Kind::Length => "metres, or P% of the scene's diagonal".to_owned(),
            Kind::Bytes => {
                "512MiB, 2GiB and the like (B, KiB, MiB, GiB, TiB; without a unit: bytes), or none".to_owned()
            }
            Kind::PowerOfBytes { min, max } => format!("a power of two of {} to {}", Bytes(min), Bytes(max)),
            Kind::Color => "R,G,B or one number, each at least 0".to_owned(),
            Kind::Parts(parts) => range_of_parts(parts),
            Kind::PartsOrNone(parts) => format!("{}, or none", range_of_parts(parts)),
            Kind::Words(words) => format!("one or more of {}, with commas between, each once", words.join(", ")),
            Kind::Text(word) => word.to_owned(),
        }
    }

    /// Checks a value.
    ///
    /// Errors: it is out of range or cannot be read (exit code 2).
    fn check(&self, text: &str) -> Result<()> {
        let in_range = |pair: [u32; 2], min: u32, max: u32| pair.iter().all(|side| (min..=max).contains(side));
        let possible = match self.kind {
            _ if self.auto && text == AUTO => true,
            Kind::Integer { min, max } => text.parse::<u64>().is_ok_and(|value| (min..=max).contains(&value)),
            Kind::Number { min, max } => {
                text.parse::<f64>().is_ok_and(|value| value.is_finite() && (min..=max).contains(&value))
            }
            Kind::Choice(choices) => choices.contains(&text),
            Kind::Pair { min, max } => parse_pair(text).is_some_and(|pair| in_range(pair, min, max)),
            Kind::Sides { min, max } => parse_sides(text).is_some_and(|sides| in_range(sides, min, max)),
            Kind::Length => parse_length(text, 1.0).is_some_and(|length| length > 0.0),
            Kind::Bytes => parse_bytes(text).is_some(),
            Kind::PowerOfBytes { min, max } => {
                Bytes::parse(text).is_some_and(|bytes| bytes.0.is_power_of_two() && (min..=max).contains(&bytes.0))
            }
            Kind::Color => parse_color(text).is_some(),
            Kind::Parts(parts) => parse_numbers(text).is_some_and(|numbers| are_parts(&numbers, parts)),
            Kind::PartsOrNone(parts) => parse_numbers_or_none(text)
                .is_some_and(|numbers| numbers.is_none_or(|numbers| are_parts(&numbers, parts))),
            Kind::Words(words) => {
                let listed: Vec<&str> = text.split(',').collect();
                let is_once = |word: &&str| listed.iter().filter(|other| other == &word).count() == 1;
                listed.iter().all(|word| words.contains(word) && is_once(word))
            }
            Kind::Text(_) => true,
        };
        if possible {
            return Ok(());
        }
        let paper = if self.paper.is_empty() { String::new() } else { format!(" ({})", self.paper) };
        Err(Error::request(format!("--{} {text}: it must be {}{paper}", self.key, self.range()))
            .note(format!("the default is --{} {}", self.key, self.default)))
    }
}

fn range_of_parts(parts: &[Part]) -> String {
    let words: Vec<&str> = parts.iter().map(|part| part.word).collect();
    let ranges = parts.iter().map(|part| format!(", {} {} to {}", part.word, part.min, part.max));
    format!("{}{}", words.join(","), ranges.collect::<String>())
}

fn are_parts(numbers: &[f64], parts: &[Part]) -> bool {
    let mut pairs = numbers.iter().zip(parts);
    numbers.len() == parts.len() && pairs.all(|(number, part)| (part.min..=part.max).contains(number))
}

/// Checked values of some settings, by key.
#[derive(Clone, Debug, PartialEq)]
pub struct Values {
    entries: BTreeMap<&'static str, String>,
}

impl Values {
    /// Every setting at its default.
    pub fn defaults(settings: &[Setting]) -> Self {
        Self { entries: settings.iter().map(|setting| (setting.key, setting.default.to_owned())).collect() }
    }

    /// Changes one value.
    ///
    /// Errors: the value is impossible (exit code 2).
    pub fn set(&mut self, setting: &Setting, text: &str) -> Result<()> {
        setting.check(text)?;
        self.entries.insert(setting.key, text.to_owned());
        Ok(())
    }

    /// In order of their keys.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, &str)> {
        self.entries.iter().map(|(key, value)| (*key, value.as_str()))
    }

    /// The text of a setting; None: the table has no such row.
    pub fn get(&self, key: &str) -> Option<&str> {
        self.entries.get(key).map(String::as_str)
    }

    /// The text of a setting that the table has. Asking for another key is a programmer's mistake.
    pub fn text(&self, key: &str) -> &str {
        self.entries.get(key).unwrap_or_else(|| panic!("no setting is called {key}"))
    }

    fn parsed<T>(&self, key: &str, parse: impl FnOnce(&str) -> Option<T>) -> T {
        let text = self.text(key);
        parse(text).unwrap_or_else(|| panic!("--{key} {text} was checked and cannot be read"))
    }

    /// None: `auto`; else the value as `read` has it: `values.unless_auto("spp", Values::integer)`.
    pub fn unless_auto<T>(&self, key: &str, read: impl FnOnce(&Self, &str) -> T) -> Option<T> {
        (self.text(key) != AUTO).then(|| read(self, key))
    }

    pub fn integer(&self, key: &str) -> u64 {
        self.parsed(key, |text| text.parse().ok())
    }

    pub fn number(&self, key: &str) -> f64 {
        self.parsed(key, |text| text.parse().ok())
    }

    pub fn pair(&self, key: &str) -> [u32; 2] {
        self.parsed(key, parse_pair)
    }

    /// Bytes of a `Kind::PowerOfBytes` setting.
    pub fn power_of_bytes(&self, key: &str) -> u64 {
        self.parsed(key, |text| Some(Bytes::parse(text)?.0))
    }

    /// Both sides of a `Kind::Sides` setting.
    pub fn sides(&self, key: &str) -> [u32; 2] {
        self.parsed(key, parse_sides)
    }

    pub fn extent(&self, key: &str) -> Extent {
        let [width, height] = self.pair(key);
        Extent::new(width, height)
    }

    /// Metres, in a scene with this diagonal.
    pub fn length(&self, key: &str, diagonal: f32) -> f32 {
        self.parsed(key, |text| parse_length(text, f64::from(diagonal))) as f32
    }

    /// None: `none`.
    pub fn bytes(&self, key: &str) -> Option<u64> {
        self.parsed(key, parse_bytes)
    }

    /// Numbers of a `Kind::Parts` setting, one for each part.
    pub fn numbers<const COUNT: usize>(&self, key: &str) -> [f64; COUNT] {
        let numbers = self.parsed(key, parse_numbers);
        numbers.try_into().unwrap_or_else(|_| panic!("--{key} was checked and does not have {COUNT} parts"))
    }

    /// Numbers of a `Kind::PartsOrNone` setting, one for each part; None: `none`.
    pub fn numbers_or_none<const COUNT: usize>(&self, key: &str) -> Option<[f64; COUNT]> {
        let numbers = self.parsed(key, parse_numbers_or_none)?;
        Some(numbers.try_into().unwrap_or_else(|_| panic!("--{key} was checked and does not have {COUNT} parts")))
    }

    /// The values of a `Kind::Words` setting with the words of `T`, in the order in which they are listed.
    pub fn listed<T: Choice>(&self, key: &str) -> Vec<T> {
        self.parsed(key, |text| text.split(',').map(T::from_word).collect())
    }

    pub fn color(&self, key: &str) -> Vec3 {
        self.parsed(key, parse_color)
    }

    /// The value of a `Kind::Choice` setting with the words of `T`.
    pub fn choice<T: Choice>(&self, key: &str) -> T {
        self.parsed(key, T::from_word)
    }

    /// Whether a `Kind::Choice` setting with the words of `T` has this value.
    pub fn is<T: Choice>(&self, key: &str, value: T) -> bool {
        self.text(key) == value.into()
    }

    pub fn is_on(&self, key: &str) -> bool {
        self.text(key) == "on"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn setting(kind: Kind) -> Setting {
        Setting {
            key: "pattern",
            symbol: "n x m",
            kind,
            default: "4x4",
            unit: "px",
            paper: "Segovia 2006, 3",
            ..Setting::changing(Changes::Picture)
        }
    }

    #[test]
    fn a_value_out_of_range_says_the_range_the_paper_and_the_default() {
        let pattern = setting(Kind::Pair { min: 1, max: 64 });
        let mut values = Values::defaults(&[pattern]);
        let error = values.set(&pattern, "0x6").unwrap_err();
        assert_eq!(error.exit_code(), 2);
        let text = error.to_string();
        assert!(text.contains("--pattern 0x6: it must be NxM, both 1 to 64 (Segovia 2006, 3)"), "{text}");
        assert!(text.contains("4x4"), "{text}");
        assert_eq!(values.pair("pattern"), [4, 4]);
        values.set(&pattern, "3x2").unwrap();
        assert_eq!(values.pair("pattern"), [3, 2]);
    }

    #[test]
    fn what_cannot_be_read_is_refused() {
        for (kind, wrong) in [
            (Kind::Pair { min: 1, max: 9 }, &["", "x", "3", "3x", "-1x2", "3x2x1", "99999999999x1"][..]),
            (Kind::Sides { min: 1, max: 9 }, &["", "x", "0", "10", "3x", "3x10", "3x2x1"]),
            (Kind::Integer { min: 0, max: 9 }, &["", "-1", "10", "1.5", "x"]),
            (Kind::Number { min: 0.0, max: 9.0 }, &["", "nan", "inf", "-1", "10"]),
            (Kind::Choice(&["on", "off"]), &["", "ON", "maybe"]),
            (Kind::Length, &["", "%", "-1", "0", "nan", "1e999"]),
            (Kind::Bytes, &["", "0", "-1", "1.5", "64MB", "MiB", "64 M", "inf", "nanMiB", "99999999TiB", "None"]),
            (Kind::PowerOfBytes { min: 4, max: 1 << 20 }, &["", "0", "2", "3MiB", "2MiB", "1048577", "none", "1MB"]),
            (
                Kind::PartsOrNone(&[Part { word: "A", min: 0.0, max: 2.0 }, Part { word: "B", min: -1.0, max: 1.0 }]),
                &["", "1", "1,", "1,1,1", "3,0", "0,-2", "nan,0", "None", "0 0"],
            ),
            (Kind::Color, &["", "1,2", "1,2,3,4", "-1", "nan"]),
        ] {
            for auto in [false, true] {
                for text in wrong.iter().chain(&["AUTO", "autoxauto", "auto,auto", "auto%"]) {
                    assert!(Setting { auto, ..setting(kind) }.check(text).is_err(), "{kind:?} took {text:?}");
                }
                assert_eq!(Setting { auto, ..setting(kind) }.check("auto").is_ok(), auto, "{kind:?}");
            }
        }
    }

    #[test]
    fn auto_is_a_value_of_every_kind_and_stands_first_in_its_range() {
        for (kind, range) in [
            (Kind::Integer { min: 0, max: 9 }, "auto or 0 to 9"),
            (Kind::Number { min: 0.5, max: 9.0 }, "auto or 0.5 to 9"),
            (Kind::Pair { min: 1, max: 9 }, "auto or NxM, both 1 to 9"),
            (Kind::Choice(&["on", "off"]), "auto|on|off"),
            (Kind::PowerOfBytes { min: 4096, max: 1 << 20 }, "auto or a power of two of 4.00 KiB to 1.00 MiB"),
        ] {
            let row = Setting { auto: true, default: "auto", ..setting(kind) };
            assert_eq!(row.range(), range);
            let mut values = Values::defaults(&[row]);
            assert_eq!(values.unless_auto("pattern", Values::pair), None);
            if let Kind::Pair { .. } = kind {
                values.set(&row, "3x2").unwrap();
                assert_eq!(values.unless_auto("pattern", Values::pair), Some([3, 2]));
            }
        }
        assert_eq!(setting(Kind::Choice(&["on", "off"])).range(), "on|off");
    }

    #[test]
    fn a_length_is_metres_or_a_part_of_the_diagonal() {
        let clamp = Setting { key: "vpl-clamp", default: "2%", ..setting(Kind::Length) };
        let mut values = Values::defaults(&[clamp]);
        assert!((values.length("vpl-clamp", 50.0) - 1.0).abs() < 1e-6);
        values.set(&clamp, "0.25").unwrap();
        assert!((values.length("vpl-clamp", 50.0) - 0.25).abs() < 1e-6);
    }

    #[test]
    fn bytes_take_a_binary_unit_or_none() {
        let budget = Setting { key: "memory-budget", default: "none", ..setting(Kind::Bytes) };
        let mut values = Values::defaults(&[budget]);
        assert_eq!(values.bytes("memory-budget"), None);
        values.set(&budget, "1.5GiB").unwrap();
        assert_eq!(values.bytes("memory-budget"), Some(3 << 29));
        let block = setting(Kind::PowerOfBytes { min: 1 << 20, max: 1 << 26 });
        values.set(&block, "16MiB").unwrap();
        assert_eq!(values.power_of_bytes(block.key), 1 << 24);
        let text = values.set(&budget, "64MB").unwrap_err().to_string();
        assert!(text.contains("--memory-budget 64MB: it must be 512MiB") && text.contains("KiB, MiB, GiB"), "{text}");
    }

    #[test]
    fn every_default_of_the_table_is_possible() {
        for setting in COMMON.iter().chain(SHADING).chain(MULTISAMPLE).chain(TREE).chain(SHADOW_MAPS) {
            setting.check(setting.default).unwrap();
        }
    }
}
