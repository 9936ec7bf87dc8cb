//! What a command line asks for, as far as it must be known before it is parsed: which verbs need their settings, and whose
//! settings help lists.

use crate::techniques::{self, DEFAULT_TECHNIQUE, Technique};
use clap::Command;
use std::collections::HashSet;

/// What `--technique` takes beside names, for help alone.
pub const ALL: &str = "all";

/// What is made of all flags, and which of them help lists.
#[derive(Clone, Debug)]
pub struct Asked {
    pub listed: TechniqueSelection,
    /// None: whatever there is.
    words: Option<HashSet<String>>,
}

impl Asked {
    /// Everything.
    pub fn all() -> Self {
        Self { listed: TechniqueSelection::All, words: None }
    }

    /// What this command line can read or list.
    pub fn by(argv: &[String]) -> Self {
        Self { listed: TechniqueSelection::of(argv), words: Some(argv.iter().cloned().collect()) }
    }

    /// Whether the settings of this verb can be read or listed. A dozen verbs take hundreds: to make all of them would be most of
    /// what a short command does.
    pub fn has_settings_of(&self, verb: &Command) -> bool {
        self.words.as_ref().is_none_or(|words| words.contains(verb.get_name()))
    }
}

/// Whose settings help lists: those of the techniques that the command names, of all with `--technique all`, or of the
/// default one. The other flags are there all the same, so that a technique can say what it does not read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum TechniqueSelection {
    All,
    /// By name.
    Of(Vec<String>),
}

impl TechniqueSelection {
    /// As the command line asks for it. It is read before it is parsed, because a help flag ends the parsing where it
    /// stands.
    pub fn of(argv: &[String]) -> Self {
        let flag = "--technique";
        let behind = argv.windows(2).filter(|pair| pair[0] == flag).map(|pair| pair[1].as_str());
        let joined = argv.iter().filter_map(|argument| argument.strip_prefix(flag)?.strip_prefix('='));
        let asked: Vec<&str> = behind.chain(joined).collect();
        if asked.contains(&ALL) {
            return Self::All;
        }
        let known = asked.into_iter().filter(|name| techniques::find(name).is_ok());
        let names: Vec<String> = known.map(str::to_owned).collect();
        Self::Of(if names.is_empty() { vec![DEFAULT_TECHNIQUE.to_owned()] } else { names })
    }

    pub fn has(&self, technique: &dyn Technique) -> bool {
        match self {
            Self::All => true,
            Self::Of(names) => names.iter().any(|name| name == technique.name()),
        }
    }

    /// How to see the others.
    pub fn after_help(&self) -> String {
        let all: Vec<&str> = techniques::ALL.iter().map(|technique| technique.name()).collect();
        match self {
            Self::All => format!("--technique NAME --help lists the settings of one technique: {}", all.join(", ")),
            Self::Of(names) => {
                let others: Vec<&str> =
                    all.into_iter().filter(|name| names.iter().all(|listed| listed != name)).collect();
                format!(
                    "Listed are the common settings and those of {}. --technique NAME --help lists those of another ({}), \
                     --technique {ALL} --help all of them. A number after a paper and its year is a section of it.",
                    names.join(", "),
                    others.join(", ")
                )
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn verbs_that_are_named_have_their_settings() {
        let of = |line: &str| Asked::by(&line.split(' ').map(str::to_owned).collect::<Vec<_>>());
        let bench_of = |line| crate::cli::command(&of(line)).find_subcommand("bench").cloned().unwrap();
        for (line, has_shade, has_frame) in [
            ("quincunx bench shade cornell", true, false),
            ("quincunx help bench frame", false, true),
            ("quincunx --version", false, false),
        ] {
            let bench = bench_of(line);
            let found = ["shade", "frame"]
                .map(|verb| bench.find_subcommand(verb).unwrap().get_arguments().any(|flag| flag.get_id() == "size"));
            assert_eq!(found, [has_shade, has_frame], "{line}");
        }
    }

    #[test]
    fn the_command_says_whose_settings_are_listed() {
        let of = |line: &str| TechniqueSelection::of(&line.split(' ').map(str::to_owned).collect::<Vec<_>>());
        let names = |names: &[&str]| TechniqueSelection::Of(names.iter().map(|name| (*name).to_owned()).collect());
        for (line, expected) in [
            ("quincunx render --help", names(&[DEFAULT_TECHNIQUE])),
            ("quincunx render --technique forward --help", names(&["forward"])),
            ("quincunx render --help --technique=forward", names(&["forward"])),
            ("quincunx render --technique forwards -h", names(&[DEFAULT_TECHNIQUE])),
            ("quincunx render -h --technique", names(&[DEFAULT_TECHNIQUE])),
            ("quincunx memory --technique forward --technique deferred", names(&["forward", "deferred"])),
            ("quincunx memory --technique forward --technique all", TechniqueSelection::All),
        ] {
            assert_eq!(of(line), expected, "{line}");
        }
    }
}
