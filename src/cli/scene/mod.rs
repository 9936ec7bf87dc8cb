//! `quincunx scene`: what scenes there are, what a scene holds, and built-in ones as files.

mod export;
mod inspect;
mod list;

use crate::error::Result;
use clap::{Arg, ArgMatches, Command, value_parser};

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

/// The seed of a built-in scene, as `render` has it.
fn seed_argument() -> Arg {
    Arg::new("seed")
        .long("seed")
        .value_name("N")
        .value_parser(value_parser!(u32))
        .default_value("1")
        .help("Seed of what a built-in scene scatters")
}

fn seed(matches: &ArgMatches) -> u64 {
    u64::from(*matches.get_one::<u32>("seed").expect("it has a default"))
}
