//! `quincunx scene list`: the scenes that the program makes itself.

use crate::error::Result;
use crate::scene::procedural;
use clap::Command;
use std::fmt::Write;

/// The sub-verb.
pub fn command() -> Command {
    Command::new("list").about("List the built-in scenes with their parameters")
}

/// Prints the list.
pub fn run() -> Result<()> {
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
    crate::cli::print(&text)
}
