//! `quincunx bench frame`: variants of one frame, in turn, as a table and as JSON lines.

use super::job_args;
use crate::bench::{run, sweep};
use crate::error::{Error, Result};
use crate::report::whole_file::write_whole;
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use indicatif::{ProgressBar, ProgressStyle};
use serde_json::Value;
use std::fmt::Write as _;
use std::io::Write as _;
use std::path::PathBuf;

/// The verb with its arguments.
pub fn command() -> Command {
    let frame = Command::new("frame")
        .about("Whole frames of each combination of a sweep, measured in turn")
        .arg(
            Arg::new("sweep")
                .long("sweep")
                .value_name("KEY=V,V,...")
                .action(ArgAction::Append)
                .help("An axis of the grid; may be repeated. The first combination is the baseline"),
        )
        .arg(
            Arg::new("repeat")
                .long("repeat")
                .value_name("N")
                .value_parser(value_parser!(u32).range(1..=10_000))
                .default_value("5")
                .help("Rounds: one frame of every combination each"),
        )
        .arg(
            Arg::new("output")
                .short('o')
                .long("output")
                .value_name("DIR")
                .value_parser(value_parser!(PathBuf))
                .help("Write rows.jsonl there"),
        );
    Command::new("bench").about("Measure").subcommand_required(true).subcommand(job_args::with_job_args(frame))
}

/// Measures and prints.
pub fn run(matches: &ArgMatches, argv: &[String]) -> Result<()> {
    let (_, matches) = matches.subcommand().expect("clap requires a sub-verb");
    let mut job = job_args::job(matches, argv)?;
    let sweeps: Vec<String> = matches.get_many::<String>("sweep").into_iter().flatten().cloned().collect();
    let grid = sweep::grid(&sweep::axes(&sweeps)?);
    let repeat = *matches.get_one::<u32>("repeat").expect("it has a default") as usize;
    let folder = matches.get_one::<PathBuf>("output");
    if let Some(folder) = folder {
        std::fs::create_dir_all(folder).map_err(|error| Error::request(format!("-o {}: {error}", folder.display())))?;
    }
    let quiet = matches.get_flag("quiet");
    let bar = if quiet { ProgressBar::hidden() } else { ProgressBar::new((repeat * grid.len()) as u64) };
    if let Ok(style) = ProgressStyle::with_template("{bar:30} {pos}/{len} frames, {eta} left") {
        bar.set_style(style);
    }
    let rows = run::frames(&mut job, &grid, repeat, &|done, _| bar.set_position(done as u64))?;
    bar.finish_and_clear();
    if let Some(folder) = folder {
        write_whole(&folder.join("rows.jsonl"), |out| rows.rows.iter().try_for_each(|row| writeln!(out, "{row}")))?;
    }
    if matches.get_flag("json") {
        super::print(&rows.rows.iter().map(|row| format!("{row}\n")).collect::<String>())?;
    } else if !quiet {
        super::print(&table(&rows.rows))?;
    }
    if rows.interrupted {
        return Err(Error::interrupted("interrupted; the rows hold the rounds that ended before"));
    }
    Ok(())
}

fn table(rows: &[Value]) -> String {
    let mut text = String::new();
    write_table(&mut text, rows).expect("writing to a string");
    text
}

fn write_table(text: &mut String, rows: &[Value]) -> std::fmt::Result {
    let Some(first) = rows.first() else { return Ok(()) };
    let number = |value: &Value| value.as_f64().unwrap_or(f64::NAN);
    let software = if first["device"]["type"] == "cpu" { ", software driver" } else { "" };
    let word = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    writeln!(
        text,
        "{} on {} ({}{software})",
        word(&first["scene"]["name"]),
        word(&first["device"]["name"]),
        word(&first["device"]["driver_info"])
    )?;
    writeln!(text, "speed-up over {}; error and overhead against --split none", word(&first["speed_up"]["baseline"]))?;
    writeln!(text)?;
    writeln!(
        text,
        "{:<40} {:>11} {:>9} {:>17} {:>9} {:>8} {:>22}",
        "variant", "median ms", "speed-up", "95 % interval", "rmse", "flip", "overhead, evals/pixel"
    )?;
    for row in rows {
        let ratio = &row["speed_up"];
        let interval = match ratio["interval_95"].as_array() {
            Some(sides) => format!("{:.2} to {:.2}", number(&sides[0]), number(&sides[1])),
            None => "-".to_owned(),
        };
        let error = &row["error_against_none"];
        let cell = |value: &Value, digits: usize| match value.as_f64() {
            Some(value) => format!("{value:.digits$}"),
            None => "-".to_owned(),
        };
        writeln!(
            text,
            "{:<40} {:>11.2} {:>9.2} {:>17} {:>9} {:>8} {:>22}",
            word(&row["variant"]),
            number(&row["frame_ms"]["median"]),
            number(&ratio["mean"]),
            interval,
            cell(&error["rmse"], 5),
            cell(&error["flip"], 4),
            cell(&row["overhead_evaluations_per_pixel"], 2)
        )?;
    }
    Ok(())
}
