//! `quincunx man`: the manual page of the program, or of a verb, on standard output.

use super::output;
use crate::error::{Error, Result};
use clap::{Arg, ArgMatches, Command};
use clap_mangen::Man;

/// The verb with its arguments.
pub fn command() -> Command {
    Command::new("man")
        .about("Print the manual page of the program, or of a verb, in roff")
        .after_help("quincunx man render | man -l - shows it; quincunx man > quincunx.1 keeps it")
        .arg(
            Arg::new("verb")
                .value_name("VERB")
                .num_args(0..)
                .help("The verb, as in `man render` or `man scene list`; default: the page that names them all"),
        )
}

/// Prints the page of `program`, the whole command line, or of one of its verbs.
///
/// Errors: there is no such verb (exit code 2).
pub fn run(matches: &ArgMatches, mut program: Command) -> Result<()> {
    program.build();
    let mut page_of = &program;
    for verb in matches.get_many::<String>("verb").into_iter().flatten() {
        page_of = page_of.find_subcommand(verb).ok_or_else(|| {
            let verbs: Vec<&str> = page_of.get_subcommands().map(Command::get_name).collect();
            let error = Error::request(format!("man: {} has no verb {verb}", page_of.get_name()));
            if verbs.is_empty() { error } else { error.note(format!("there are {}", verbs.join(", "))) }
        })?;
    }
    let mut page = Vec::new();
    Man::new(page_of.clone()).render(&mut page).expect("writing to a list of bytes");
    output::print(&String::from_utf8_lossy(&page))
}
