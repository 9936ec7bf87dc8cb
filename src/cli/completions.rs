//! `quincunx completions`: what a shell needs to complete verbs and flags, on standard output.

use super::listed::Listed;
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

/// Prints the shell's script.
pub fn run(matches: &ArgMatches) -> Result<()> {
    let shell = *matches.get_one::<Shell>("shell").expect("clap requires it");
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut super::command(&Listed::All), "quincunx", &mut script);
    super::print(&String::from_utf8_lossy(&script))
}
