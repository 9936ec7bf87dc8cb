//! `quincunx completions`: what a shell needs to complete verbs and flags, on standard output.

use super::output;
use crate::error::Result;
use clap::{Arg, ArgMatches, Command, value_parser};
use clap_complete::Shell;

/// The verb with its arguments.
pub fn command() -> Command {
    Command::new("completions")
        .about("Print a shell's completions of every verb and flag")
        .after_help("bash: quincunx completions bash > ~/.local/share/bash-completion/completions/quincunx")
        .arg(
            Arg::new("shell")
                .value_name("SHELL")
                .required(true)
                .value_parser(value_parser!(Shell))
                .help("The shell that reads them"),
        )
}

/// Prints the shell's script for `program`, the whole command line.
pub fn run(matches: &ArgMatches, mut program: Command) -> Result<()> {
    let shell = *matches.get_one::<Shell>("shell").expect("clap requires it");
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut program, "quincunx", &mut script);
    output::print(&String::from_utf8_lossy(&script))
}
