//! `quincunx settings`: every setting of every technique, as text or as the page docs/settings.md.

use super::asked::TechniqueSelection;
use super::job_args::{self, Row};
use super::output;
use crate::error::Result;
use crate::settings::{COMMON, Setting};
use crate::techniques;
use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgAction, ArgMatches, Command};
use std::fmt::Write;

const HEAD: &str = "# Settings

Each setting is a flag of `render`, `bench` and `memory`, an axis of `bench --sweep` and a key of a report's `settings`.
A technique reads the common ones and those of its own section; a flag that it does not read is refused.

Under *changes* stands what another value of a setting changes:

- picture: the light of the pixels, so that it is another picture, or another estimate of it
- samples: only where, or how many, samples are taken
- file: only how a file shows that light
- nothing: only what the picture costs, or what is written beside it

`quincunx settings --markdown` prints this page.
";

/// The verb with its arguments.
pub fn command() -> Command {
    Command::new("settings")
        .about("Print every setting: default, range or choices, unit, paper")
        .arg(
            Arg::new("technique")
                .value_name("TECHNIQUE")
                .value_parser(PossibleValuesParser::new(techniques::ALL.iter().map(|technique| technique.name())))
                .help("The technique whose settings are printed, beside the common ones; default: all techniques"),
        )
        .arg(
            Arg::new("markdown")
                .long("markdown")
                .action(ArgAction::SetTrue)
                .help("Print Markdown with a table for each technique (docs/settings.md)"),
        )
}

/// Prints them.
pub fn run(matches: &ArgMatches) -> Result<()> {
    let listed = match matches.get_one::<String>("technique") {
        None => TechniqueSelection::All,
        Some(name) => TechniqueSelection::Of(vec![name.clone()]),
    };
    let text = if matches.get_flag("markdown") { markdown(&listed) } else { plain(&listed) };
    output::print(&text)
}

/// What `render --help` says of them, alone.
fn plain(listed: &TechniqueSelection) -> String {
    let rows = job_args::rows(listed).into_iter().filter(|row| row.is_listed);
    let flags = rows.map(|Row { setting, heading, .. }| job_args::flag(setting).help_heading(heading));
    let mut command = Command::new("settings").disable_help_flag(true).help_template("{all-args}").args(flags);
    format!("{}\n", command.render_help().to_string().trim_end())
}

fn markdown(listed: &TechniqueSelection) -> String {
    let mut text = HEAD.to_owned();
    section(&mut text, "Common settings", "", COMMON);
    for technique in techniques::ALL.iter().filter(|technique| listed.has(**technique)) {
        let own: Vec<Setting> = technique.settings().iter().copied().flatten().copied().collect();
        let name = technique.name();
        section(&mut text, name, &format!("What it does: [techniques/{name}.md](techniques/{name}.md).\n\n"), &own);
    }
    text
}

/// `intro`: paragraphs before the table.
fn section(text: &mut String, heading: &str, intro: &str, settings: &[Setting]) {
    let head = "| setting | default | range or choices | unit | changes | paper | what it is |\n\
         | --- | --- | --- | --- | --- | --- | --- |";
    writeln!(text, "\n## {heading}\n\n{intro}{head}").expect("writing to a string");
    for setting in settings {
        let range = match setting.choices() {
            Some(choices) => choices.iter().map(|choice| format!("`{choice}`")).collect::<Vec<_>>().join(", "),
            None => cell(&setting.range()),
        };
        let Setting { key, default, unit, .. } = setting;
        let paper = [setting.symbol, setting.paper].into_iter().filter(|words| !words.is_empty()).collect::<Vec<_>>();
        writeln!(
            text,
            "| `--{key}` | `{default}` | {range} | {unit} | {} | {} | {} |",
            setting.changes.name(),
            paper.join("; "),
            cell(setting.help)
        )
        .expect("writing to a string");
    }
}

/// A text inside a table, where a bar would end its cell and angle brackets would be a tag.
fn cell(text: &str) -> String {
    let words: Vec<&str> = text.split_whitespace().collect();
    words.join(" ").replace('|', "\\|").replace('<', "&lt;").replace('*', "\\*")
}
