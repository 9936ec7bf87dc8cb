//! `quincunx bench device`: what a device does with memory and triangles, and passes of reports held against it.

use super::output::{self, print, print_text, quiet_flag};
use super::progress;
use crate::bench::device;
use crate::bench::device::explained::{self, Explained};
use crate::error::{Error, Result};
use crate::gpu::{DeviceRequest, Gpu};
use crate::job::fail_on_validation;
use crate::progress::Stage;
use crate::report::roofline::Roofline;
use crate::report::run::RunReport;
use crate::report::work_row::WorkRow;
use crate::units::Bytes;
use crate::whole_file::read_document;
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use serde_json::json;
use std::path::{Path, PathBuf};

pub const NAME: &str = "device";

/// Sizes of a buffer: more than caches hold, and as much as one dispatch reaches.
const LEAST_BYTES: u64 = 1 << 20;
const MOST_BYTES: u64 = 512 << 20;

/// The sub-verb with its arguments.
pub fn command() -> Command {
    let flag = |name: &'static str| Arg::new(name).long(name).action(ArgAction::SetTrue);
    Command::new(NAME)
        .about("What the device does with memory and triangles: clears, copies, reads and writes, far words, words in no order, atomics, draws")
        .arg(
            Arg::new("bytes")
                .long("bytes")
                .value_name("BYTES")
                .value_parser(bytes)
                .default_value("256MiB")
                .help("Bytes of each of two buffers, a power of two: more than the caches hold"),
        )
        .arg(output::repeat_flag("Number of rounds, each of which measures all work once"))
        .arg(
            Arg::new("explain")
                .long("explain")
                .value_name("REPORT.json")
                .action(ArgAction::Append)
                .value_parser(value_parser!(PathBuf))
                .help("Say of each pass of a report of render --profile what share of its time it takes at least; may be repeated"),
        )
        .arg(Arg::new("device").long("device").value_name("SUBSTRING|INDEX").help("Device, by a part of its name or its index in `quincunx devices`"))
        .arg(flag("validate").help("Run under the validation layer; a message fails the command"))
        .arg(quiet_flag())
        .arg(flag("json").help("Print a line of JSON for each work, and one for each report, on standard output"))
}

/// A power of two in the range.
fn bytes(text: &str) -> std::result::Result<u64, String> {
    let range = || format!("it must be a power of two, {} to {}", Bytes(LEAST_BYTES), Bytes(MOST_BYTES));
    let bytes = Bytes::parse(text).ok_or_else(range)?.0;
    let is_possible = bytes.is_power_of_two() && (LEAST_BYTES..=MOST_BYTES).contains(&bytes);
    is_possible.then_some(bytes).ok_or_else(range)
}

/// Measures and prints.
pub fn run(matches: &ArgMatches) -> Result<()> {
    progress::install(matches.get_flag("quiet"));
    let reports = matches.get_many::<PathBuf>("explain").into_iter().flatten();
    let reports = reports.map(|path| Ok((path, report(path)?))).collect::<Result<Vec<_>>>()?;
    let request = DeviceRequest {
        selector: matches.get_one::<String>("device").cloned(),
        validate: matches.get_flag("validate"),
        robust: false,
        ..DeviceRequest::default()
    };
    let gpu = Gpu::open(&request)?;
    let bytes = *matches.get_one::<u64>("bytes").expect("it has a default");
    let repeat = *matches.get_one::<u32>("repeat").expect("it has a default") as usize;
    let stage = Stage::counted("measuring", "works");
    let rows = device::run(&gpu, bytes, repeat, &mut |done, all| stage.reach(done as u64, all as u64))?;
    drop(stage);
    let explained = |(path, report): &(&PathBuf, RunReport)| {
        let held = Roofline::of(&rows).and_then(|roofline| explained::explained(report, &roofline));
        let passes = held.map_err(|error| error.within(path.display()))?;
        Ok((path.display().to_string(), passes))
    };
    let explained = reports.iter().map(explained).collect::<Result<Vec<(String, Vec<Explained>)>>>()?;
    if matches.get_flag("json") {
        let lines = rows.iter().map(WorkRow::line);
        let of_reports =
            explained.iter().map(|(report, passes)| json!({ "report": report, "passes": passes }).to_string());
        print(&lines.chain(of_reports).map(|line| line + "\n").collect::<String>())?;
    } else {
        let of_reports = explained.iter().map(|(report, passes)| format!("\n{report}\n\n{}", explained::text(passes)));
        print_text(matches, &(device::text(&rows) + &of_reports.collect::<String>()))?;
    }
    let log = gpu.validation_log();
    drop(gpu);
    fail_on_validation(log.as_deref())
}

fn report(path: &Path) -> Result<RunReport> {
    let text = read_document(path)?;
    serde_json::from_str(&text).map_err(|error| Error::request(format!("{}: it is no report: {error}", path.display())))
}
