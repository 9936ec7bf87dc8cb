//! The flags of a reference, which `render` and `bench` share, and how the making of one is shown.

use super::gate_args;
use crate::error::Result;
use crate::metrics::gate::Gate;
use crate::progress::say;
use crate::reference::made::Watch;
use crate::reference::recipe::Recipe;
use crate::reference::{DEFAULT_SPP, ReferenceRequest};
use clap::{Arg, ArgMatches, Command, value_parser};
use std::time::Duration;

/// Adds --reference and --reference-spp.
pub fn with_bare_reference_args(command: Command) -> Command {
    command
        .arg(Arg::new("reference").long("reference").value_name("FILE.exr|FILE.png|auto").help(
            "Reference that pictures are compared with, for the report's `errors`: a picture of the same size, or auto, \
             the path-traced picture of the same light transport, which is made unless it is kept from before",
        ))
        .arg(
            Arg::new("reference-spp")
                .long("reference-spp")
                .value_name("N")
                .value_parser(value_parser!(u64).range(1..=65_536))
                .requires("reference")
                .help(format!("Samples a pixel for --reference auto [default: {DEFAULT_SPP}]")),
        )
}

/// Adds them and the gates.
pub fn with_reference_args(command: Command) -> Command {
    let command = gate_args::with_gate_args(with_bare_reference_args(command));
    ["max", "min", "threshold"]
        .into_iter()
        .fold(command, |command, name| command.mut_arg(name, |arg| arg.requires("reference")))
}

/// The reference that the flags ask for.
///
/// Errors: as `ReferenceRequest::new`; a bad gate or threshold (exit code 2).
pub fn asked(matches: &ArgMatches) -> Result<Option<ReferenceRequest>> {
    if !matches.contains_id("reference") {
        return Ok(None);
    }
    asked_with(matches, gate_args::gates(matches)?, gate_args::threshold(matches)?)
}

/// The same where the gates are not typed as gates.
///
/// Errors: as `ReferenceRequest::new`.
pub fn asked_with(matches: &ArgMatches, gates: Vec<Gate>, threshold: f64) -> Result<Option<ReferenceRequest>> {
    let Some(text) = matches.get_one::<String>("reference") else { return Ok(None) };
    let spp = matches.get_one::<u64>("reference-spp").copied().unwrap_or(DEFAULT_SPP);
    ReferenceRequest::new(text, spp, threshold, gates, Box::new(Said)).map(Some)
}

/// Lines beside the progress of the rendering itself; none with --quiet, where there is no observer.
struct Said;

impl Watch for Said {
    fn note(&self, text: &str) {
        say(format!("note: {text}"));
    }

    fn begins(&self, recipe: &Recipe, estimate: Option<Duration>) {
        let samples = recipe.samples().map_or_else(String::new, |samples| format!(", {samples} samples a pixel"));
        let time = estimate.map_or_else(String::new, |time| format!(", about {:.0} s", time.as_secs_f64().ceil()));
        say(format!("making the reference: {}{samples}{time}", recipe.technique.name()));
    }
}
