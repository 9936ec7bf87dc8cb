//! The flags of a job, made from the settings table: what `render` and `bench` share.

use super::asked::{self, Asked, TechniqueSelection};
use crate::cli::output::quiet_flag;
use crate::error::Result;
use crate::job::Job;
use crate::preset::Presets;
use crate::progress::say;
use crate::settings::{COMMON, Kind, Setting};
use crate::techniques::{self, DEFAULT_TECHNIQUE, Technique, settings_of};
use clap::builder::{PossibleValue, PossibleValuesParser};
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use std::path::PathBuf;

/// Adds SCENE, --technique, --device, --validate and, where they are asked for, every setting; help lists those of the
/// techniques that `asked` names.
pub fn with_job_args(asked: &Asked, command: Command) -> Command {
    let names = techniques::ALL.iter().map(|technique| PossibleValue::new(technique.name()));
    let mut command = command
        .after_help(asked.listed.after_help())
        .arg(Arg::new("scene").value_name("SCENE").help(
            "A built-in scene (`quincunx scene list`), with parameters as in hall:triangles=80000, or a .gltf or .glb \
             file; default: the scene that shows the technique best",
        ))
        .arg(
            Arg::new("technique")
                .long("technique")
                .value_name("NAME")
                // A help flag behind it is not seen where a value is refused.
                .value_parser(PossibleValuesParser::new(names.chain([PossibleValue::new(asked::ALL).hide(true)])))
                .help(format!(
                    "Technique that makes the picture [default: {DEFAULT_TECHNIQUE}]; with --help: list its settings"
                )),
        )
        .arg(
            Arg::new("preset")
                .long("preset")
                .value_name("FILE.toml")
                .value_parser(value_parser!(PathBuf))
                .action(ArgAction::Append)
                .help("Settings from a file, such as `tune` writes; what is typed comes first, then later files; may be repeated"),
        )
        .arg(Arg::new("device").long("device").value_name("SUBSTRING|INDEX").help(
            "Device, by a part of its name or its index in `quincunx devices`; default: a GPU before a processor",
        ))
        .arg(
            Arg::new("validate")
                .long("validate")
                .action(ArgAction::SetTrue)
                .help("Run under the validation layer with synchronization checks; a message fails the command"),
        )
        .arg(quiet_flag())
        .arg(
            Arg::new("json")
                .long("json")
                .action(ArgAction::SetTrue)
                .help("Print the results as JSON on standard output"),
        );
    if !asked.has_settings_of(&command) {
        return command;
    }
    for Row { setting, heading, is_listed } in rows(&asked.listed) {
        command = command.arg(flag(setting).help_heading(heading).hide(!is_listed));
    }
    command
}

/// A setting among all flags.
pub(super) struct Row {
    pub setting: &'static Setting,
    pub heading: String,
    pub is_listed: bool,
}

/// Every setting once: common ones, those that `listed` reads, all others. Where techniques differ in what it may be,
/// with all the choices that one of them has: of those that are listed, if they read it.
pub(super) fn rows(listed: &TechniqueSelection) -> Vec<Row> {
    let common = |setting| Row { setting, heading: "Common settings".to_owned(), is_listed: true };
    let mut all: Vec<Row> = COMMON.iter().map(common).collect();
    let (first, later): (Vec<_>, Vec<_>) =
        techniques::ALL.iter().copied().partition(|technique| listed.has(*technique));
    for technique in first.iter().chain(&later) {
        let is_listed = listed.has(*technique);
        for setting in technique.settings().iter().copied().flatten() {
            if let Some(known) = all.iter_mut().find(|known| known.setting.key == setting.key) {
                if let (Some(few), Some(more)) = (known.setting.choices(), setting.choices())
                    && more.len() > few.len()
                    && (is_listed || !known.is_listed)
                {
                    known.setting = setting;
                }
                continue;
            }
            let among = if is_listed { &first } else { &later };
            let is_reader = |technique: &&&dyn Technique| reads(**technique, setting.key);
            let readers: Vec<&str> = among.iter().filter(is_reader).map(|technique| technique.name()).collect();
            all.push(Row { setting, heading: format!("Settings of {}", readers.join(", ")), is_listed });
        }
    }
    all
}

/// Whether it is one of the technique's own settings, or a common one.
fn reads(technique: &dyn Technique, key: &str) -> bool {
    settings_of(technique).iter().any(|setting| setting.key == key)
}

/// A setting as a flag, whose value is checked where it is set.
pub fn flag(setting: &'static Setting) -> Arg {
    let mut help = format!("{} [{}] [default: {}]", setting.help, setting.range(), setting.default);
    if !setting.unit.is_empty() {
        help = format!("{help} [unit: {}]", setting.unit);
    }
    match (setting.symbol, setting.paper) {
        ("", "") => {}
        ("", paper) => help = format!("{help} ({paper})"),
        (symbol, paper) => help = format!("{help} ({symbol} in {paper})"),
    }
    let argument = Arg::new(setting.key).long(setting.key).value_name(value_name(setting)).help(help);
    match setting.kind {
        // A list that begins with a minus is no negative number, and is not to be taken for a flag.
        Kind::Parts(_) | Kind::PartsOrNone(_) => argument.allow_hyphen_values(true),
        _ => argument.allow_negative_numbers(true),
    }
}

fn value_name(setting: &Setting) -> &'static str {
    match setting.kind {
        Kind::Integer { .. } | Kind::Number { .. } if setting.auto => "auto|N",
        Kind::Integer { .. } | Kind::Number { .. } => "N",
        Kind::Choice(_) => "NAME",
        Kind::Pair { .. } if setting.auto => "auto|NxM",
        Kind::Pair { .. } => "NxM",
        Kind::Sides { .. } => "N|NxM",
        Kind::Length => "LENGTH",
        Kind::PowerOfBytes { .. } if setting.auto => "auto|BYTES",
        Kind::Bytes | Kind::PowerOfBytes { .. } => "BYTES",
        Kind::Color => "COLOR",
        Kind::Parts(_) => "auto|N,N",
        Kind::PartsOrNone(_) => "N,N|none",
        Kind::Words(_) if setting.auto => "auto|NAME,...",
        Kind::Words(_) => "NAME,...",
        Kind::Text(word) => word,
    }
}

/// The job that the flags describe, and the presets that they name.
///
/// Errors: a setting that the technique does not read, an impossible value, or a broken preset (exit code 2).
pub fn job(matches: &ArgMatches, argv: &[String]) -> Result<Job> {
    let mut jobs = jobs(matches, argv)?;
    Ok(jobs.remove(0))
}

/// A job for each technique that the flags name, at least one.
///
/// Errors: a setting that none of them reads, an impossible value, or a broken preset (exit code 2).
pub fn jobs(matches: &ArgMatches, argv: &[String]) -> Result<Vec<Job>> {
    let presets = Presets::read(matches.get_many::<PathBuf>("preset").into_iter().flatten())?;
    let all = match matches.get_many::<String>("technique") {
        None => vec![presets.technique().map_or_else(|| techniques::find(DEFAULT_TECHNIQUE), Ok)?],
        Some(names) => names.map(|name| techniques::find(name)).collect::<Result<Vec<_>>>()?,
    };
    all.iter().map(|technique| job_of(*technique, matches, &presets, argv, &all)).collect()
}

/// A setting that `technique` does not read is passed over where one of `others` does.
fn job_of(
    technique: &'static dyn Technique,
    matches: &ArgMatches,
    presets: &Presets,
    argv: &[String],
    others: &[&'static dyn Technique],
) -> Result<Job> {
    let scene = matches.get_one::<String>("scene").map_or(technique.scene(), String::as_str);
    let mut job = Job::new(scene, technique);
    presets.set(technique, &mut job.values)?;
    let mut typed = Vec::new();
    for Row { setting, .. } in rows(&TechniqueSelection::All) {
        let key = setting.key;
        if let Some(value) = matches.get_one::<String>(key)
            && (reads(technique, key) || !others.iter().any(|other| reads(*other, key)))
        {
            job.set(key, value)?;
            typed.push(key);
        }
    }
    let unread = presets.drop_unread(technique, &mut job.values, |key| typed.contains(&key));
    unread.iter().for_each(|sentence| say(format!("note: passed over of a preset: {sentence}")));
    job.presets = presets.paths().map(|path| path.display().to_string()).collect();
    job.device = matches.get_one::<String>("device").cloned();
    job.validate = matches.get_flag("validate");
    job.command = argv.to_vec();
    Ok(job)
}
