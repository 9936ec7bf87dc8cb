//! The flags of a job, made from the settings table: what `render` and `bench` share.

use crate::error::Result;
use crate::job::{Job, settings_of};
use crate::settings::{COMMON, Kind, Setting};
use crate::techniques::{self, Technique};
use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgAction, ArgMatches, Command};

/// The technique that a command without --technique runs.
pub const DEFAULT_TECHNIQUE: &str = "interleaved_deferred";

/// Adds SCENE, --technique, --device, --validate and every setting.
pub fn with_job_args(command: Command) -> Command {
    let names = techniques::ALL.iter().map(|technique| technique.name());
    let mut command = command
        .arg(Arg::new("scene").value_name("SCENE").help(
            "A built-in scene (`quincunx scene list`), with parameters as in hall:triangles=80000, or a .gltf or .glb \
             file; default: the scene that shows the technique best",
        ))
        .arg(
            Arg::new("technique")
                .long("technique")
                .value_name("NAME")
                .value_parser(PossibleValuesParser::new(names))
                .help(format!("What makes the picture; default {DEFAULT_TECHNIQUE}")),
        )
        .arg(
            Arg::new("device")
                .long("device")
                .value_name("SUBSTRING|INDEX")
                .help("Which device, as `quincunx devices` lists them; default: a GPU before a processor"),
        )
        .arg(
            Arg::new("validate")
                .long("validate")
                .action(ArgAction::SetTrue)
                .help("Run under the validation layer with synchronization checks; a message fails the command"),
        )
        .arg(Arg::new("quiet").long("quiet").action(ArgAction::SetTrue).help("Print nothing but errors"))
        .arg(Arg::new("json").long("json").action(ArgAction::SetTrue).help("Print JSON on standard output"));
    for (heading, setting) in all_settings() {
        command = command.arg(flag(setting).help_heading(heading));
    }
    command
}

/// Every setting once, under the heading of where it comes from first; where techniques differ in what it may be, with all
/// the choices that one of them has.
fn all_settings() -> Vec<(String, &'static Setting)> {
    let mut all: Vec<(String, &'static Setting)> =
        COMMON.iter().map(|setting| ("Common settings".to_owned(), setting)).collect();
    for setting in techniques::ALL.iter().flat_map(|technique| technique.settings()).copied().flatten() {
        if let Some((_, known)) = all.iter_mut().find(|(_, known)| known.key == setting.key) {
            if let (Kind::Choice(few), Kind::Choice(more)) = (known.kind, setting.kind)
                && more.len() > few.len()
            {
                *known = setting;
            }
            continue;
        }
        let reads = |technique: &&&dyn Technique| {
            technique.settings().iter().copied().flatten().any(|theirs| theirs.key == setting.key)
        };
        let readers: Vec<&str> = techniques::ALL.iter().filter(reads).map(|technique| technique.name()).collect();
        all.push((format!("Settings of {}", readers.join(", ")), setting));
    }
    all
}

/// A setting as a flag, whose value is checked where it is set.
pub fn flag(setting: &'static Setting) -> Arg {
    let mut help = format!("{} [{}] [default: {}]", setting.help, setting.range(), setting.default);
    if !setting.unit.is_empty() {
        help = format!("{help}, in {}", setting.unit);
    }
    if !setting.symbol.is_empty() {
        help = format!("{help}, the paper's {}", setting.symbol);
    }
    if !setting.paper.is_empty() {
        help = format!("{help} ({})", setting.paper);
    }
    let argument = Arg::new(setting.key).long(setting.key).value_name(value_name(setting)).help(help);
    match setting.kind {
        // A list that begins with a minus is no negative number, and is not to be taken for a flag.
        Kind::PartsOrNone(_) => argument.allow_hyphen_values(true),
        _ => argument.allow_negative_numbers(true),
    }
}

fn value_name(setting: &Setting) -> &'static str {
    match setting.kind {
        Kind::Integer { .. } | Kind::Number { .. } => "N",
        Kind::IntegerOrAuto { .. } | Kind::NumberOrAuto { .. } => "auto|N",
        Kind::Choice(_) => "NAME",
        Kind::Pair { .. } => "NxM",
        Kind::PairOrAuto { .. } => "auto|NxM",
        Kind::Sides { .. } => "N|NxM",
        Kind::Length => "LENGTH",
        Kind::Bytes => "BYTES",
        Kind::Color => "COLOR",
        Kind::PartsOrNone(_) => "N,N|none",
        Kind::Text(word) => word,
    }
}

/// The technique that the flags name.
pub fn technique(matches: &ArgMatches) -> Result<&'static dyn Technique> {
    techniques::find(matches.get_one::<String>("technique").map_or(DEFAULT_TECHNIQUE, String::as_str))
}

/// The job that the flags describe.
///
/// Errors: a setting that the technique does not read, or an impossible value (exit code 2).
pub fn job(matches: &ArgMatches, argv: &[String]) -> Result<Job> {
    job_of(technique(matches)?, matches, argv, &[])
}

/// A job for each technique that the flags name.
///
/// Errors: a setting that none of them reads, or an impossible value (exit code 2).
pub fn jobs(matches: &ArgMatches, argv: &[String]) -> Result<Vec<Job>> {
    let names: Vec<&str> = match matches.get_many::<String>("technique") {
        None => vec![DEFAULT_TECHNIQUE],
        Some(names) => names.map(String::as_str).collect(),
    };
    let all = names.iter().map(|name| techniques::find(name)).collect::<Result<Vec<_>>>()?;
    all.iter().map(|technique| job_of(*technique, matches, argv, &all)).collect()
}

/// A setting that `technique` does not read is passed over where one of `others` does.
fn job_of(
    technique: &'static dyn Technique,
    matches: &ArgMatches,
    argv: &[String],
    others: &[&'static dyn Technique],
) -> Result<Job> {
    let scene = matches.get_one::<String>("scene").map_or(technique.scene(), String::as_str);
    let mut job = Job::new(scene, technique);
    let reads = |technique: &dyn Technique, key: &str| settings_of(technique).iter().any(|setting| setting.key == key);
    for (_, setting) in all_settings() {
        let key = setting.key;
        if let Some(value) = matches.get_one::<String>(key)
            && (reads(technique, key) || !others.iter().any(|other| reads(*other, key)))
        {
            job.set(key, value)?;
        }
    }
    job.device = matches.get_one::<String>("device").cloned();
    job.validate = matches.get_flag("validate");
    job.command = argv.to_vec();
    Ok(job)
}
