//! `quincunx scene list`: the scenes that the program makes itself.

use crate::cli::output;
use crate::error::Result;
use crate::scene::procedural::{self, Choice, Parameter};
use clap::{ArgMatches, Command};
use std::fmt::Write;

/// The sub-verb.
pub fn command() -> Command {
    Command::new("list").about("List the built-in scenes with their parameters").arg(output::quiet_flag())
}

/// Prints the list.
pub fn run(matches: &ArgMatches) -> Result<()> {
    let mut text = String::new();
    for scene in procedural::ALL {
        writeln!(text, "{:<8} {}", scene.name, scene.description).expect("writing to a string");
        for parameter in scene.parameters {
            let Parameter { key, description, choice } = parameter;
            let kind = if let Choice::Number { .. } = choice { "N" } else { "WORD" };
            writeln!(text, "         {}:{key}={kind}  {description}; {}", scene.name, choice.described())
                .expect("writing to a string");
        }
    }
    let Parameter { key, description, choice } = procedural::SEED;
    writeln!(text, "any scene\n         :{key}=N  {description}; {}", choice.described()).expect("writing to a string");
    output::print_text(matches, &text)
}
