//! `quincunx devices --self-test`: parse, run, print; what is tried and how it is judged is the room `selftest`.

use super::progress;
use crate::cli::output::{print, print_text};
use crate::error::Result;
use crate::gpu::DeviceRequest;
use crate::selftest::{self, Request, document};
use crate::whole_file::write_whole;
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use std::io::Write;
use std::path::PathBuf;

/// The flag that all others here need.
pub const FLAG: &str = "self-test";

/// Adds the flags of the self-test.
pub fn with_args(command: Command) -> Command {
    let of_test = |arg: Arg| arg.requires(FLAG);
    command
        .arg(Arg::new(FLAG).long(FLAG).action(ArgAction::SetTrue).help(
            "Test a device: render a small picture by every technique and every method that the device supports, and \
             compare it with a plain twin or a formula; test its clock too. Exit code 1 if a test fails",
        ))
        .arg(of_test(
            Arg::new("device")
                .long("device")
                .value_name("SUBSTRING|INDEX")
                .help("Device, by a part of its name or its index in the list; default: a GPU before a processor"),
        ))
        .arg(of_test(
            Arg::new("only").long("only").value_name("PART,...").value_delimiter(',').action(ArgAction::Append).help(
                "Run only cases whose names, or whose parts after a slash, begin so (deep_shading/conservative, msaa), or clocks",
            ),
        ))
        .arg(of_test(
            Arg::new("validate")
                .long("validate")
                .action(ArgAction::SetTrue)
                .help("Run under the validation layer; a message fails the case that it came in"),
        ))
        .arg(of_test(
            Arg::new("output")
                .long("output")
                .short('o')
                .value_name("FILE.json")
                .value_parser(value_parser!(PathBuf))
                .help("File to write the results to, for sending in, whether the tests pass or fail"),
        ))
}

/// Tests a device, with a line for each case as it ends.
///
/// Errors: something does not hold (exit code 1); no case has such a name, or the file cannot be written (2); no
/// fitting device (3); Ctrl-C (130).
pub fn run(matches: &ArgMatches, argv: &[String]) -> Result<()> {
    let (is_json, is_quiet) = (matches.get_flag("json"), matches.get_flag("quiet"));
    progress::install(is_quiet);
    let validate = matches.get_flag("validate");
    let request = Request {
        // The layer's checks of what shaders read see nothing where the device mends it.
        device: DeviceRequest {
            selector: matches.get_one::<String>("device").cloned(),
            validate,
            robust: !validate,
            ..DeviceRequest::default()
        },
        only: matches.get_many::<String>("only").into_iter().flatten().cloned().collect(),
    };
    let file = matches.get_one::<PathBuf>("output");
    file.map_or(Ok(()), |file| crate::whole_file::require_folder(file))?;
    let mut printed = Ok(());
    let outcome = selftest::run(&request, &mut |tried| {
        if !is_json && printed.is_ok() {
            printed = print_text(matches, &document::line(tried));
        }
    })?;
    printed?;
    let document = document::json(&outcome, argv);
    if let Some(file) = file {
        write_whole(file, |out| writeln!(out, "{document:#}"))?;
    }
    if is_json {
        print(&format!("{document:#}\n"))?;
    } else {
        let file = file.map(|file| file.display().to_string());
        print_text(matches, &document::closing_text(&outcome, file.as_deref()))?;
    }
    outcome.verdict()
}
