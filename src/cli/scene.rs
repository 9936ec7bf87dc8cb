//! `quincunx scene`: the scenes that the program makes itself.

use crate::error::Result;
use crate::scene::procedural;
use clap::{ArgMatches, Command};
use std::fmt::Write;

/// The verb with its arguments.
pub fn command() -> Command {
    Command::new("scene")
        .about("Built-in scenes")
        .subcommand_required(true)
        .subcommand(Command::new("list").about("List the built-in scenes with their parameters"))
}

/// Prints the list, the only sub-verb.
pub fn run(_: &ArgMatches) -> Result<()> {
    let mut text = String::new();
    for scene in procedural::ALL {
        writeln!(text, "{:<8} {}", scene.name, scene.description).expect("writing to a string");
        for parameter in scene.parameters {
            let [least, greatest] = parameter.range;
            let (key, default, description) = (parameter.key, parameter.default, parameter.description);
            writeln!(text, "         {}:{key}=N  {description}; {least} to {greatest}, default {default}", scene.name)
                .expect("writing to a string");
        }
    }
    super::print(&text)
}
