//! The command line: one file per verb. Parse, run, print; the library does the rest.

pub mod bench;
pub mod compare;
pub mod completions;
pub mod devices;
mod gate_args;
mod job_args;
mod listed;
pub mod man;
pub mod memory;
mod progress;
mod rays;
mod reference_args;
pub mod render;
pub mod scene;
mod self_test;
pub mod settings;

use crate::error::{Error, Result};
use clap::{Arg, ArgAction, ArgMatches, Command};
use listed::Listed;
use std::io::Write;

/// The program with its verbs. `listed`: whose settings help lists.
fn command(listed: &Listed) -> Command {
    Command::new("quincunx")
        .version(concat!(env!("CARGO_PKG_VERSION"), " (", env!("QUINCUNX_COMMIT"), ")"))
        .about("A headless Vulkan renderer: interleaved, inferred and decoupled shading side by side")
        .after_help(
            "Exit codes: 0 done; 1 a comparison, a gate or --validate failed, or a picture holds NaN or infinity; 2 a bad \
             request or file; 3 no fitting device; 4 the device failed or memory is too small; 130 interrupted.\n\n\
             VK_DRIVER_FILES (VK_ICD_FILENAMES in older loaders) chooses drivers; NO_COLOR is honoured.",
        )
        .subcommand_required(true)
        .arg_required_else_help(true)
        .subcommands([
            render::command(listed),
            compare::command(),
            bench::command(listed),
            memory::command(listed),
            scene::command(),
            devices::command(),
            settings::command(),
            completions::command(),
            man::command(),
        ])
}

/// Runs the verb of `argv`.
pub fn run(argv: &[String]) -> Result<()> {
    let matches = match command(&Listed::of(argv)).try_get_matches_from(argv) {
        Ok(matches) => matches,
        // clap prints help to standard output, and its own words for what it cannot parse; exit code 2 for the latter.
        Err(error) => error.exit(),
    };
    match matches.subcommand() {
        Some(("render", matches)) => render::run(matches, argv),
        Some(("compare", matches)) => compare::run(matches),
        Some(("bench", matches)) => bench::run(matches, argv),
        Some(("memory", matches)) => memory::run(matches, argv),
        Some(("scene", matches)) => scene::run(matches),
        Some(("devices", matches)) => devices::run(matches, argv),
        Some(("settings", matches)) => settings::run(matches),
        Some(("completions", matches)) => completions::run(matches),
        Some(("man", matches)) => man::run(matches),
        _ => unreachable!("clap requires one of the verbs"),
    }
}

/// The flag that every verb has.
fn quiet_flag() -> Arg {
    Arg::new("quiet")
        .long("quiet")
        .action(ArgAction::SetTrue)
        .help("Print nothing but errors, and what --json asks for")
}

/// Prints what is for a person's eyes, unless --quiet.
fn print_text(matches: &ArgMatches, text: &str) -> Result<()> {
    if matches.get_flag("quiet") { Ok(()) } else { print(text) }
}

/// Prints to standard output; a reader that has gone (`| head`) is no failure.
pub(crate) fn print(text: &str) -> Result<()> {
    let mut stdout = std::io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => Ok(()),
        Err(error) => Err(Error::request(format!("cannot write to standard output: {error}"))),
        Ok(()) => Ok(()),
    }
}
