//! `quincunx sampling list`: the patterns of all techniques, with the settings that choose them.

use crate::cli::output;
use crate::error::Result;
use crate::settings::Setting;
use crate::techniques::{NamedPattern, Technique, patterns, settings_of};
use clap::{Arg, ArgAction, ArgMatches, Command};
use serde_json::{Value, json};
use std::fmt::Write;

/// The sub-verb with its arguments.
pub fn command() -> Command {
    Command::new("list")
        .about("List the patterns of the techniques, with the settings that choose them")
        .arg(Arg::new("json").long("json").action(ArgAction::SetTrue).help("Print one JSON document"))
        .arg(output::quiet_flag())
}

/// Prints the list.
pub fn run(matches: &ArgMatches) -> Result<()> {
    if matches.get_flag("json") {
        let all: Vec<Value> = patterns::all().map(|(technique, named)| document(technique, named)).collect();
        return output::print(&format!("{:#}\n", json!({ "schema": 1, "patterns": all })));
    }
    let mut text = String::new();
    for (technique, named) in patterns::all() {
        describe(&mut text, technique, named).expect("writing to a string");
    }
    output::print_text(matches, &text)
}

/// Settings that choose the pattern.
fn settings(technique: &dyn Technique, named: &NamedPattern) -> Vec<Setting> {
    settings_of(technique).into_iter().filter(|setting| named.keys.contains(&setting.key)).collect()
}

fn document(technique: &dyn Technique, named: &NamedPattern) -> Value {
    let setting =
        |setting: &Setting| json!({ "key": setting.key, "default": setting.default, "range": setting.range() });
    let settings: Vec<Value> = settings(technique, named).iter().map(setting).collect();
    json!({ "name": named.name, "summary": named.summary, "technique": technique.name(), "settings": settings })
}

fn describe(text: &mut String, technique: &dyn Technique, named: &NamedPattern) -> std::fmt::Result {
    writeln!(text, "{:<12} {}", named.name, named.summary)?;
    writeln!(text, "             --technique {}, chosen by", technique.name())?;
    for setting in settings(technique, named) {
        writeln!(text, "             --{} {} ({})", setting.key, setting.default, setting.range())?;
    }
    Ok(())
}
