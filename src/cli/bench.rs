//! `quincunx bench WHAT`: variants of a frame or of one stage, in turn, as JSON lines and as a table.

use super::asked::{self, Asked};
use super::output;
use super::{
    bench_allocate, bench_device, bench_file, bench_merge, frames_args, job_args, locality, progress, rays,
    reference_args,
};
use crate::bench::candidate::TECHNIQUE;
use crate::bench::fail_if::Condition;
use crate::bench::group::MOST_VARIANTS;
use crate::bench::rates;
use crate::bench::rounds::MOST_TIMES;
use crate::bench::row::BenchRow;
use crate::bench::rows_file::{Existing, RowsFile};
use crate::bench::run::{self, Observer, Request};
use crate::bench::shard::Shard;
use crate::bench::summary::Summary;
use crate::bench::sweep;
use crate::bench::what::What;
use crate::error::{Error, ErrorKind, Result};
use crate::progress::{Pace, Stage, say};
use crate::report::command_line::command_line;
use crate::techniques::bench_stage::BenchStage;
use crate::techniques::{self, Technique, settings_of};
use clap::error::{ContextKind, ContextValue};
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// The verb with its arguments.
pub fn command(asked: &Asked) -> Command {
    Command::new("bench")
        .about("Measure settings against each other: a frame, or one stage of it")
        .after_help(format!(
            "Each command prints a row for each combination of settings, and a table at the end. Compare ratios: they are \
             taken within one round of one run, while milliseconds drift.\n\nStages of each technique:\n{}",
            stages_of_techniques()
        ))
        .subcommand_required(true)
        .arg_required_else_help(true)
        .subcommands(
            What::all()
                .into_iter()
                .map(|what| reference_args::with_reference_args(job_args::with_job_args(asked, sub_command(what)))),
        )
        .subcommand(rays::command())
        .subcommand(locality::command())
        .subcommand(bench_device::command())
        .subcommand(bench_allocate::command())
        .subcommand(bench_merge::command())
        .subcommand(bench_file::command())
}

/// A line a technique: which stages it has.
fn stages_of_techniques() -> String {
    let widest = techniques::ALL.iter().map(|technique| technique.name().len()).max().unwrap_or(0);
    let line = |technique: &&dyn Technique| {
        let names: Vec<&str> = technique.bench_stages().iter().map(|stage| stage.name).collect();
        format!("  {:<widest$}  {}", technique.name(), names.join(", "))
    };
    techniques::ALL.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// What a stage is of each technique that has it, a paragraph each.
fn summaries(what: What) -> String {
    let paragraph = |(technique, stage): &(&str, &BenchStage)| format!("{technique}: {}", stage.summary);
    what.stages().iter().map(paragraph).collect::<Vec<_>>().join("\n\n")
}

fn sub_command(what: What) -> Command {
    let flag = |name: &'static str| Arg::new(name).long(name).action(ArgAction::SetTrue).requires("output");
    let command = Command::new(what.name()).about(what.summary());
    let command = if what.stages().len() > 1 { command.long_about(summaries(what)) } else { command };
    let command = match what {
        What::Frame => frames_args::with_frames_args(
            command,
            "Measure frames A to B, both included, of a scene that moves, and the mean of what a frame takes: its pose, its \
             upload, its tree, host passes and the device; and how much the pictures flicker",
        ),
        What::Stage(_) => command,
    };
    command
        .arg(
            Arg::new("sweep")
                .long("sweep")
                .value_name("KEY=V,V,...")
                .action(ArgAction::Append)
                .help("Values of one setting to measure, one axis of the grid; may be repeated"),
        )
        .arg(
            Arg::new("baseline")
                .long("baseline")
                .value_name("KEY=V ...")
                .help(
                    "Combination that ratios are relative to, or the NAME of a --point; if it leaves axes out, one for each of \
                     their points; default: the first that is possible",
                ),
        )
        .arg(output::repeat_flag("Number of rounds, each of which measures every combination of a group once; intervals need three"))
        .arg(
            Arg::new("rate")
                .long("rate")
                .value_name("KEY")
                .help("Say how fast errors fall with KEY, whose numbers are swept: errors and fitted exponents for each \
                       combination of the other axes, and with -o a plot, rates.svg"),
        )
        .arg(Arg::new("fair").long("fair").action(ArgAction::SetTrue).help(
            "Shade the same number of texels a thread in all rows: one, or --texels; rows that cannot are skipped. Without \
             this flag each row shades as many as suit it best, up to 32 where threads share a list of lights and 1 where \
             they do not",
        ))
        .arg(output::folder_flag("Folder to write rows.jsonl, rows.csv, summary.json, summary.md and index.html to"))
        .arg(
            Arg::new("point").long("point").value_name("[NAME:] KEY=V KEY=V").action(ArgAction::Append).help(
                "A row beside the grid, with these settings, and what tables call it; may be repeated",
            ),
        )
        .arg(Arg::new("until-interval").long("until-interval").value_name("PART").value_parser(part).help(format!(
            "Measure more rounds, up to {MOST_TIMES} times --repeat, until the 95 % interval of each ratio is at most this part \
             of it wide, such as 0.03"
        )))
        .arg(bench_file::shard_flag())
        .arg(
            Arg::new("group")
                .long("group")
                .value_name("N")
                .value_parser(value_parser!(u32).range(1..=MOST_VARIANTS as i64))
                .default_value(MOST_VARIANTS.to_string())
                .help("Variants that are measured in turn, beside the baseline; their rows are written when all of them are done"),
        )
        .arg(Arg::new("fail-if").long("fail-if").value_name("NAME>NUMBER").action(ArgAction::Append).help(
            "Fail with exit code 1 where this holds of a row, by the whole interval where there is one: time_ratio, median_ms, \
             planned_bytes, allocated_bytes, peak_bytes, an error such as rmse, or counters.NAME, > or < a number; may be repeated",
        ))
        .arg(flag("pictures").help("Also write the picture of each row, into DIR/pictures, and show them on the page"))
        .arg(flag("resume").help("Measure only what DIR/rows.jsonl lacks"))
        .arg(flag("force").conflicts_with("resume").help("Replace DIR/rows.jsonl"))
}

/// Measures and prints.
pub fn run(matches: &ArgMatches, argv: &[String]) -> Result<()> {
    let (name, matches) = matches.subcommand().expect("clap requires a sub-verb");
    match name {
        rays::NAME => return rays::run(matches),
        bench_device::NAME => return bench_device::run(matches),
        bench_allocate::NAME => return bench_allocate::run(matches, argv),
        locality::NAME => return locality::run(matches, argv),
        bench_merge::NAME => return bench_merge::run(matches, argv),
        bench_file::NAME => return run_file(matches),
        _ => {}
    }
    let what = What::all().into_iter().find(|what| what.name() == name).expect("clap knows these only");
    let (quiet, json) = (matches.get_flag("quiet"), matches.get_flag("json"));
    progress::install(quiet);
    let mut job = job_args::job(matches, argv)?;
    job.reference = reference_args::asked(matches)?;
    let sweeps: Vec<String> = matches.get_many::<String>("sweep").into_iter().flatten().cloned().collect();
    let axes = sweep::axes(&sweeps)?;
    axes.iter().try_for_each(|axis| require_known("sweep", &axis.key))?;
    let points = matches.get_many::<String>("point").into_iter().flatten();
    let points = points.map(|text| sweep::point(text)).collect::<Result<Vec<_>>>()?;
    points.iter().flat_map(|named| &named.point).try_for_each(|(key, _)| require_known("point", key))?;
    let conditions = matches.get_many::<String>("fail-if").into_iter().flatten();
    let conditions = conditions.map(|text| Condition::parse(text)).collect::<Result<Vec<_>>>()?;
    let rate = matches.get_one::<String>("rate").map(|key| rates::axis(key, &axes)).transpose()?;
    let folder = matches.get_one::<PathBuf>("output");
    let mut file = folder.map(|folder| rows_file(folder, matches)).transpose()?;
    let frames = if what == What::Frame { frames_args::asked(matches)? } else { None };
    let request = Request {
        job: &job,
        frames: frames.as_ref(),
        what,
        axes: &axes,
        baseline: matches.get_one::<String>("baseline").map(String::as_str),
        repeat: *matches.get_one::<u32>("repeat").expect("it has a default") as usize,
        is_fair: matches.get_flag("fair"),
        points: &points,
        until_interval: matches.get_one::<f64>("until-interval").copied(),
        shard: matches.get_one::<Shard>("shard").copied(),
        pictures: folder.filter(|_| matches.get_flag("pictures")).map(PathBuf::as_path),
        group: *matches.get_one::<u32>("group").expect("it has a default") as usize,
        deadline: None,
    };
    let found = run::run(&request, file.as_mut(), &mut Rounds { json, stage: None, pace: Pace::default() })?;
    let held = conditions.iter().try_for_each(|condition| condition.require_false(&found.rows));
    if !found.rows.is_empty() {
        let mut summary = Summary::new(what, &axes, found.rows, argv);
        if let Some(axis) = rate {
            summary = summary.with_rates(&axis.key, &axes);
        }
        if let Some(folder) = folder {
            summary.write(folder)?;
        }
        if !json && !quiet {
            output::print(&summary.text())?;
        }
    }
    if found.interrupted {
        let way_out = if folder.is_some() { "--resume continues" } else { "with -o DIR, --resume could continue" };
        return Err(Error::interrupted("interrupted; finished rows are valid").note(way_out));
    }
    found.gates.and(held)
}

/// Runs the commands of a file, one after the other; a gate that fails ends none of them.
fn run_file(matches: &ArgMatches) -> Result<()> {
    progress::install(matches.get_flag("quiet"));
    let mut gates = Ok(());
    for words in bench_file::commands(matches)? {
        let argv: Vec<String> = std::iter::once("quincunx".to_owned()).chain(words.iter().cloned()).collect();
        say(command_line(&argv));
        let parsed = command(&Asked::by(&words)).try_get_matches_from(&words);
        let parsed = parsed.map_err(|error| {
            // What clap says of usage is of a command that nobody typed.
            let text = error.to_string();
            let first = text.lines().next().unwrap_or_default().trim_start_matches("error: ").to_owned();
            let file = matches.get_one::<PathBuf>("file").expect("clap requires it");
            Error::request(format!("{}: {first}", file.display()))
        })?;
        match run(&parsed, &argv) {
            Err(error) if error.kind() == ErrorKind::Gate => gates = gates.and(Err(error)),
            done => done?,
        }
    }
    gates
}

/// Errors: no technique reads a setting of this name (exit code 2), with the setting that `--KEY` resembles.
pub(super) fn require_known(flag: &str, key: &str) -> Result<()> {
    if key == TECHNIQUE || techniques::ALL.iter().any(|one| settings_of(*one).iter().any(|setting| setting.key == key))
    {
        return Ok(());
    }
    let error = Error::request(format!("--{flag} {key}=: there is no setting --{key}"));
    // The parser itself says what a flag resembles.
    let words = ["bench", What::Frame.name(), "--technique", asked::ALL, &format!("--{key}")].map(str::to_owned);
    let refused = command(&Asked::by(&words)).try_get_matches_from(&words).err();
    let similar = refused.as_ref().and_then(|refused| refused.get(ContextKind::SuggestedArg));
    Err(match similar {
        Some(ContextValue::String(similar)) => error.note(format!("a similar one exists: {similar}")),
        _ => error.note("`quincunx bench frame --help` lists them"),
    })
}

/// A part of a whole, above 0 and up to 1.
fn part(text: &str) -> std::result::Result<f64, String> {
    let number = text.parse().ok().filter(|part: &f64| *part > 0.0 && *part <= 1.0);
    number.ok_or_else(|| "it must be a number above 0 and up to 1".to_owned())
}

fn rows_file(folder: &Path, matches: &ArgMatches) -> Result<RowsFile> {
    let existing = match (matches.get_flag("resume"), matches.get_flag("force")) {
        (true, _) => Existing::Resume,
        (_, true) => Existing::Overwrite,
        _ => Existing::Refuse,
    };
    RowsFile::open(folder, existing)
}

/// Rows where --json asks for them, rounds as a bar, and a line a group where there is no bar.
struct Rounds {
    json: bool,
    /// The rounds of a group.
    stage: Option<Stage>,
    pace: Pace,
}

impl Observer for Rounds {
    fn row(&mut self, row: &BenchRow) -> Result<()> {
        if self.json { output::print(&format!("{}\n", row.line())) } else { Ok(()) }
    }

    fn step(&mut self, done: usize, all: usize) {
        let stage = self.stage.get_or_insert_with(|| Stage::counted("measuring", "rounds of a variant"));
        stage.reach(done as u64, all as u64);
        self.pace.reach(done as u64, all as u64, Instant::now());
    }

    fn group(&mut self, known: usize, all: usize) {
        self.stage = None;
        if !progress::is_bar() {
            let left = progress::left_words(self.pace.left(Instant::now()));
            say(format!("{known} of {all} rows{left}"));
        }
    }
}
