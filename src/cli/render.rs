//! `quincunx render`: one picture, or one a frame, and what it cost.

use super::asked::Asked;
use super::{frames_args, job_args, progress, reference_args};
use crate::cli::output::{print, print_text};
use crate::continuation::Continuation;
use crate::error::{Error, Result};
use crate::job::Job;
use crate::memory::trace::Trace;
use crate::progress::say;
use crate::report::roofline::Roofline;
use crate::report::run::RunReport;
use crate::report::trace;
use crate::sequence::Frames;
use crate::whole_file::{require_folder, write_whole};
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use std::io::Write;
use std::path::PathBuf;
use std::sync::Arc;

/// The verb with its arguments.
pub fn command(asked: &Asked) -> Command {
    let path = |name: &'static str, value: &'static str| {
        Arg::new(name).long(name).value_name(value).value_parser(value_parser!(PathBuf))
    };
    let command = job_args::with_job_args(
        asked,
        Command::new("render")
            .about("Render a scene")
            .arg(
                path("output", "FILE.exr|FILE.png")
                    .short('o')
                    .help("File to write the picture to; default: SCENE-TECHNIQUE.png in the current folder"),
            )
            .arg(path("report", "FILE.json").help("File to write the report to: settings, times, memory, hashes"))
            .arg(path("trace-events", "FILE.json").conflicts_with("frames").help(
                "File to write the passes to as events that Chrome and Perfetto draw, with memory as a counter; implies --profile",
            ))
            .arg(
                Arg::new("aov")
                    .long("aov")
                    .value_name("NAME,...")
                    .value_delimiter(',')
                    .action(ArgAction::Append)
                    .help("Also write these stages of the technique: as layers of an EXR, or as pictures FILE.NAME.png beside a PNG"),
            )
            .arg(path("record-allocations", "FILE.jsonl").help(
                "File to write to what is asked of the device's memory and comes back, in order, for `bench allocate`",
            ))
            .arg(path("continue", "FILE.exr").conflicts_with("frames").help(
                "Add samples to an earlier picture of path_traced, of the same scene, size and settings, up to --spp or \
                 --until-error; the result is the picture of a single run",
            ))
            .arg(
                Arg::new("profile")
                    .long("profile")
                    .action(ArgAction::SetTrue)
                    .help("Time each pass, with a submit and a fence for each, in three frames after one to warm up"),
            )
            .arg(path("device-rows", "FILE.jsonl").help(
                "What `bench device --json` printed of this device: with --profile the report says what share of its time a pass takes at \
                 least for its bytes, and with --statistics for its triangles and fragments",
            ))
            .arg(Arg::new("statistics").long("statistics").action(ArgAction::SetTrue).help(
                "Report what the device counts in each pass: vertices, primitives, shader invocations. Counting may cost time, \
                 and drivers differ in what they count: lavapipe of Mesa 22.3 counts whole blocks of 4x4 pixels",
            )),
    );
    let frames = "Render frames A to B, both included, into FILE.0001.png and so on";
    reference_args::with_reference_args(frames_args::with_frames_args(command, frames))
}

/// Renders and prints.
pub fn run(matches: &ArgMatches, argv: &[String]) -> Result<()> {
    progress::install(matches.get_flag("quiet"));
    let mut job = job_args::job(matches, argv)?;
    job.output = matches.get_one::<PathBuf>("output").cloned();
    job.report = matches.get_one::<PathBuf>("report").cloned();
    job.aovs = matches.get_many::<String>("aov").into_iter().flatten().cloned().collect();
    let earlier = matches.get_one::<PathBuf>("continue");
    job.continuation = earlier.map(|path| Continuation::read(path, job.values.extent("size"))).transpose()?;
    job.reference = reference_args::asked(matches)?;
    let trace = matches.get_one::<PathBuf>("trace-events");
    trace.map_or(Ok(()), |path| require_folder(path))?;
    job.profile = matches.get_flag("profile") || trace.is_some();
    job.statistics = matches.get_flag("statistics");
    job.roofline = matches.get_one::<PathBuf>("device-rows").map(|path| Roofline::read(path)).transpose()?;
    let record = matches.get_one::<PathBuf>("record-allocations");
    record.map_or(Ok(()), |path| require_folder(path))?;
    job.recorder = record.map(|_| Arc::default());
    if let Some(frames) = frames_args::asked(matches)? {
        return run_sequence(&job, &frames, matches);
    }
    let outcome = job.run()?;
    write_allocations(&job, matches, &outcome.report)?;
    if let Some(path) = trace {
        write_whole(path, |out| writeln!(out, "{}", trace::document(&outcome.report)))?;
    }
    if matches.get_flag("json") {
        print(&format!("{:#}\n", outcome.report.json()))?;
    } else {
        print_text(matches, &outcome.report.text())?;
    }
    outcome.gates
}

/// What the device of the job was asked for, where --record-allocations names a file.
fn write_allocations(job: &Job, matches: &ArgMatches, report: &RunReport) -> Result<()> {
    let (Some(recorder), Some(path)) = (&job.recorder, matches.get_one::<PathBuf>("record-allocations")) else {
        return Ok(());
    };
    Trace::write(path, &report.device.identity.name, &recorder.events())
}

/// Renders each frame, with a line for each on standard error, and prints how many are written.
fn run_sequence(job: &Job, frames: &Frames, matches: &ArgMatches) -> Result<()> {
    let mut done = 0;
    let sequence = job.run_sequence(frames, &mut |frame, outcome| {
        done += 1;
        say(format!("frame {frame}, {done} of {}: wrote {}", frames.count(), outcome.path.display()));
        outcome.notes.iter().for_each(|note| say(format!("frame {frame}: note: {note}")));
    })?;
    if let Some(report) = sequence.reports.first() {
        write_allocations(job, matches, report)?;
    }
    if matches.get_flag("json") {
        print(&format!("{:#}\n", sequence.json()))?;
    } else {
        let written = format!("{} of {} frames are written\n", sequence.reports.len(), frames.count());
        print_text(matches, &written)?;
    }
    match sequence.is_interrupted {
        true => Err(Error::interrupted("interrupted; finished frames are valid")),
        false => sequence.gates,
    }
}
