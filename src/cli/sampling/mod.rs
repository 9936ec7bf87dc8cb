//! `quincunx sampling`: what patterns of samples there are, what one holds, and its samples or its spectrum as files.

mod arguments;
mod drawn;
mod export;
mod inspect;
mod list;
mod reach;

use crate::error::Result;
use clap::{ArgMatches, Command};

/// The verb with its arguments.
pub fn command() -> Command {
    Command::new("sampling")
        .about("Patterns of samples: which there are, their numbers, pictures and spectra")
        .subcommand_required(true)
        .subcommands([list::command(), inspect::command(), export::command()])
}

/// Runs the sub-verb.
pub fn run(matches: &ArgMatches) -> Result<()> {
    match matches.subcommand() {
        Some(("list", matches)) => list::run(matches),
        Some(("inspect", matches)) => inspect::run(matches),
        Some(("export", matches)) => export::run(matches),
        _ => unreachable!("clap requires one of them"),
    }
}
