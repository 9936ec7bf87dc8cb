//! `quincunx tune`: settings for this device, found by measuring them under a bound on the error and on the time.

use super::asked::Asked;
use super::output::{self, print_text};
use super::{job_args, progress, reference_args};
use crate::bench::rows_file::{Existing, RowsFile};
use crate::bench::stats::LEAST_PAIRS;
use crate::bench::summary::Summary;
use crate::bench::sweep::{self, Axis};
use crate::bench::what::What;
use crate::cli::bench::require_known;
use crate::error::{Error, Result};
use crate::job::Job;
use crate::metrics::gate::{Bound, Gate};
use crate::metrics::{DEFAULT_THRESHOLD, Metrics};
use crate::tune::request::Request;
use crate::tune::tune;
use crate::whole_file::write_whole;
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use std::io::Write;
use std::path::PathBuf;
use std::time::Duration;

const PRESET: &str = "preset.toml";

/// The verb with its arguments.
pub fn command(asked: &Asked) -> Command {
    let command = Command::new("tune")
        .about("Find the fastest settings on this device whose picture is near enough, and write them as a preset")
        .arg(
            Arg::new("error-below")
                .long("error-below")
                .value_name("METRIC=VALUE")
                .required(true)
                .action(ArgAction::Append)
                .help(format!(
                    "Most error of a picture ({}) that is near enough, against --reference, or the technique's plain form; may be \
                     repeated",
                    errors().join(", ")
                )),
        )
        .arg(
            Arg::new("search-time")
                .long("search-time")
                .value_name("TIME")
                .value_parser(duration)
                .default_value("5m")
                .help("About how long the search may take: 90s, 5m, 1h"),
        )
        .arg(
            Arg::new("sweep")
                .long("sweep")
                .value_name("KEY=V,V,...")
                .action(ArgAction::Append)
                .help("Values of one setting to choose from; may be repeated; default: those of the technique, which `tune` says"),
        )
        .arg(
            output::bare_repeat_flag("Rounds of the last measurement: of the fastest, and of what differs from it in one setting")
                .value_parser(value_parser!(u32).range(LEAST_PAIRS as i64..=1000))
                .default_value("10"),
        )
        .arg(output::folder_flag("Folder to write preset.toml, tune.json and tune.txt to, and the last measurement as `bench` does, with pictures"))
        .arg(
            Arg::new("force")
                .long("force")
                .action(ArgAction::SetTrue)
                .requires("output")
                .help("Replace what is there"),
        );
    reference_args::with_bare_reference_args(job_args::with_job_args(asked, command))
}

/// Metrics that are smaller where pictures are nearer.
fn errors() -> Vec<&'static str> {
    let is_error = |measure: &&crate::metrics::Measure| (measure.value)(&Metrics::EQUAL) == 0.0;
    Metrics::MEASURES.iter().filter(is_error).map(|measure| measure.name).collect()
}

/// Searches, prints and writes.
pub fn run(matches: &ArgMatches, argv: &[String]) -> Result<()> {
    progress::install(matches.get_flag("quiet"));
    let mut job = job_args::job(matches, argv)?;
    job.reference = reference_args::asked_with(matches, Vec::new(), DEFAULT_THRESHOLD)?;
    let texts: Vec<String> = matches.get_many::<String>("sweep").into_iter().flatten().cloned().collect();
    let axes = axes(&job, &texts)?;
    let bounds = matches.get_many::<String>("error-below").into_iter().flatten();
    let bounds = bounds.map(|text| bound(text)).collect::<Result<Vec<_>>>()?;
    if job.reference.is_none() && job.technique.plain().is_none() {
        let name = job.technique.name();
        return Err(Error::request(format!("{name} has no plain form to judge pictures by"))
            .note("--reference auto judges them by the path-traced picture"));
    }
    let folder = matches.get_one::<PathBuf>("output");
    let existing = if matches.get_flag("force") { Existing::Overwrite } else { Existing::Refuse };
    let mut file = folder.map(|folder| RowsFile::open(folder, existing)).transpose()?;
    let request = Request {
        job: &job,
        axes: &axes,
        bounds: &bounds,
        folder: folder.map(PathBuf::as_path),
        time: *matches.get_one::<Duration>("search-time").expect("it has a default"),
        repeat: *matches.get_one::<u32>("repeat").expect("it has a default") as usize,
    };
    let tuned = tune(&request, file.as_mut())?;
    let (document, mut text) = (tuned.json(), tuned.text());
    if let Some(folder) = folder {
        let preset = folder.join(PRESET);
        tuned.write_preset(&preset)?;
        Summary::new(What::Frame, &axes, tuned.rows().to_vec(), argv).write(folder)?;
        text += &format!("wrote {}; render --preset has its settings\n", preset.display());
        write_whole(&folder.join("tune.json"), |out| writeln!(out, "{document:#}"))?;
        write_whole(&folder.join("tune.txt"), |out| out.write_all(text.as_bytes()))?;
    }
    match matches.get_flag("json") {
        true => output::print(&format!("{document:#}\n")),
        false => print_text(matches, &text),
    }
}

/// The axes of the search.
///
/// Errors: a setting is none of the technique's (exit code 2).
fn axes(job: &Job, texts: &[String]) -> Result<Vec<Axis>> {
    if texts.is_empty() {
        return Ok(job.technique.tuned().iter().map(|(key, values)| Axis::new(key, values)).collect());
    }
    let axes = sweep::axes(texts)?;
    for axis in &axes {
        require_known("sweep", &axis.key)?;
        if job.values.get(&axis.key).is_none() {
            let name = job.technique.name();
            return Err(Error::request(format!(
                "--sweep {}=: {name} does not read it; one technique is tuned",
                axis.key
            )));
        }
    }
    Ok(axes)
}

fn bound(text: &str) -> Result<Gate> {
    let gate = Gate::parse("error-below", Bound::Max, text)?;
    match errors().contains(&gate.name()) {
        true => Ok(gate),
        false => {
            Err(Error::request(format!("--error-below {text}: {} is greater where pictures are nearer", gate.name()))
                .note(format!("the errors are {}", errors().join(", "))))
        }
    }
}

/// `90s`, `5m`, `1h`: more than nothing, up to a week.
fn duration(text: &str) -> std::result::Result<Duration, String> {
    let number = text.trim_end_matches(|letter: char| letter.is_ascii_alphabetic());
    let seconds = match &text[number.len()..] {
        "s" => 1.0,
        "m" => 60.0,
        "h" => 3600.0,
        _ => return Err("it must be a number with s, m or h, such as 5m".to_owned()),
    };
    let time = number.parse().ok().map(|number: f64| number * seconds).filter(|time| *time > 0.0 && *time <= 604_800.0);
    time.map(Duration::from_secs_f64).ok_or_else(|| "it must be more than nothing and at most a week".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_has_a_unit() {
        for (text, seconds) in [("90s", 90.0), ("5m", 300.0), ("1.5h", 5400.0)] {
            assert_eq!(duration(text).unwrap().as_secs_f64(), seconds);
        }
        for wrong in ["", "5", "m", "5 m", "0s", "-1m", "nans", "infs", "1e9h", "5d"] {
            assert!(duration(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn what_grows_with_nearness_is_no_error() {
        assert_eq!(errors(), ["rmse", "relmse", "flip", "hdr_flip", "over_threshold"]);
        let error = bound("ssim=0.9").unwrap_err();
        assert!(error.message().contains("--error-below ssim=0.9: ssim is greater"), "{error}");
        assert!(bound("flop=1").unwrap_err().message().starts_with("--error-below flop=1: there is no metric"));
    }
}
