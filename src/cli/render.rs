//! `quincunx render`: one picture, and what it cost.

use super::job_args;
use crate::error::Result;
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use std::path::PathBuf;

/// The verb with its arguments.
pub fn command() -> Command {
    let path = |name: &'static str, value: &'static str| {
        Arg::new(name).long(name).value_name(value).value_parser(value_parser!(PathBuf))
    };
    job_args::with_job_args(
        Command::new("render")
            .about("Render a scene")
            .arg(
                path("output", "FILE.exr|FILE.png")
                    .short('o')
                    .help("The picture; default SCENE-TECHNIQUE.png in the current folder"),
            )
            .arg(path("report", "FILE.json").help("Write the report: settings, times, memory, hashes"))
            .arg(
                Arg::new("aov")
                    .long("aov")
                    .value_name("NAME,...")
                    .value_delimiter(',')
                    .action(ArgAction::Append)
                    .help("Stages of the technique: layers of an EXR, pictures FILE.NAME.png beside a PNG"),
            )
            .arg(
                Arg::new("profile")
                    .long("profile")
                    .action(ArgAction::SetTrue)
                    .help("Time each pass: one submit and fence a pass, three frames after one that warms up"),
            ),
    )
}

/// Renders and prints.
pub fn run(matches: &ArgMatches, argv: &[String]) -> Result<()> {
    let mut job = job_args::job(matches, argv)?;
    job.output = matches.get_one::<PathBuf>("output").cloned();
    job.report = matches.get_one::<PathBuf>("report").cloned();
    job.aovs = matches.get_many::<String>("aov").into_iter().flatten().cloned().collect();
    job.profile = matches.get_flag("profile");
    let outcome = job.run()?;
    if matches.get_flag("json") {
        super::print(&format!("{:#}\n", outcome.report.json()))
    } else if matches.get_flag("quiet") {
        Ok(())
    } else {
        super::print(&outcome.report.text())
    }
}
