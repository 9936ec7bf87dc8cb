//! Printing what a verb has to say.

use crate::error::{Error, Result};
use clap::builder::StyledStr;
use clap::{Arg, ArgAction, ArgMatches, value_parser};
use std::io::Write;
use std::path::PathBuf;

/// The flag that every verb has.
pub fn quiet_flag() -> Arg {
    Arg::new("quiet")
        .long("quiet")
        .action(ArgAction::SetTrue)
        .help("Print nothing but errors, and what --json asks for")
}

/// `--repeat N`, of verbs that measure in rounds; `help`: what a round is.
pub fn repeat_flag(help: &'static str) -> Arg {
    bare_repeat_flag(help).default_value("5")
}

/// The same without a default.
pub fn bare_repeat_flag(help: &'static str) -> Arg {
    Arg::new("repeat").long("repeat").value_name("N").value_parser(value_parser!(u32).range(1..=10_000)).help(help)
}

/// `-o DIR`.
pub fn folder_flag(help: impl Into<StyledStr>) -> Arg {
    Arg::new("output").short('o').long("output").value_name("DIR").value_parser(value_parser!(PathBuf)).help(help)
}

/// Prints what is for a person's eyes, unless --quiet.
pub fn print_text(matches: &ArgMatches, text: &str) -> Result<()> {
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
