//! `quincunx scene`: what scenes there are, what a scene holds, and built-in ones as files.

mod export;
mod inspect;
mod list;
mod seed;

use crate::error::Result;
use clap::{ArgMatches, Command};

/// The verb with its arguments.
pub fn command() -> Command {
    Command::new("scene").about("Built-in scenes and scene files").subcommand_required(true).subcommands([
        list::command(),
        inspect::command(),
        export::command(),
    ])
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
