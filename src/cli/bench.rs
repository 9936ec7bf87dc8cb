use crate::error::Result;
use clap::{ArgMatches, Command};
pub fn command() -> Command { Command::new("bench") }
pub fn run(_: &ArgMatches, _: &[String]) -> Result<()> { Ok(()) }
