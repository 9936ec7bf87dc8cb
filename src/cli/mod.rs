//! The command line: one file per verb. Parse, run, print; the library does the rest.

mod asked;
pub mod bench;
mod bench_allocate;
mod bench_device;
mod bench_file;
mod bench_merge;
pub mod compare;
pub mod completions;
pub mod devices;
mod frames_args;
mod gate_args;
mod job_args;
mod locality;
pub mod man;
pub mod memory;
mod output;
mod progress;
mod rays;
mod reference_args;
pub mod render;
pub mod reproduce;
pub mod sampling;
pub mod scene;
mod self_test;
pub mod settings;
mod spectrum;
pub mod tune;

use crate::error::Result;
use asked::Asked;
use clap::Command;

/// The program with its verbs, and with the settings of those that are asked for.
fn command(asked: &Asked) -> Command {
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
            render::command(asked),
            compare::command(),
            bench::command(asked),
            reproduce::command(asked),
            tune::command(asked),
            memory::command(asked),
            scene::command(),
            sampling::command(),
            devices::command(),
            settings::command(),
            completions::command(),
            man::command(),
        ])
}

/// Runs the verb of `argv`.
pub fn run(argv: &[String]) -> Result<()> {
    let matches = match command(&Asked::by(argv)).try_get_matches_from(argv) {
        Ok(matches) => matches,
        // clap prints help to standard output, and its own words for what it cannot parse; exit code 2 for the latter.
        Err(error) => error.exit(),
    };
    match matches.subcommand() {
        Some(("render", matches)) => render::run(matches, argv),
        Some(("compare", matches)) => compare::run(matches),
        Some(("bench", matches)) => bench::run(matches, argv),
        Some(("reproduce", matches)) => reproduce::run(matches),
        Some(("tune", matches)) => tune::run(matches, argv),
        Some(("memory", matches)) => memory::run(matches, argv),
        Some(("scene", matches)) => scene::run(matches),
        Some(("sampling", matches)) => sampling::run(matches),
        Some(("devices", matches)) => devices::run(matches, argv),
        Some(("settings", matches)) => settings::run(matches),
        Some(("completions", matches)) => completions::run(matches, command(&Asked::all())),
        Some(("man", matches)) => man::run(matches, command(&Asked::all())),
        _ => unreachable!("clap requires one of the verbs"),
    }
}
