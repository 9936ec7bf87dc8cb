//! The flags of a reference, which `render` and `bench` share, and how the making of one is shown.

use super::gate_args;
use crate::error::Result;
use crate::reference::made::Watch;
use crate::reference::recipe::Recipe;
use crate::reference::{Asked, DEFAULT_SPP};
use clap::{Arg, ArgMatches, Command, value_parser};
use indicatif::{ProgressBar, ProgressState, ProgressStyle};
use std::cell::RefCell;
use std::io::IsTerminal;
use std::time::Duration;

/// How often the bar moves.
const TICK: Duration = Duration::from_millis(200);

/// Adds --reference, --reference-spp and the gates.
pub fn with_reference_args(command: Command) -> Command {
    let command = command
        .arg(Arg::new("reference").long("reference").value_name("FILE.exr|FILE.png|auto").help(
            "What pictures are judged against, for the report's `errors`: a picture of the same size, or auto: the \
             path-traced one of the same transport, made where it is not kept",
        ))
        .arg(
            Arg::new("reference-spp")
                .long("reference-spp")
                .value_name("N")
                .value_parser(value_parser!(u64).range(1..=65_536))
                .requires("reference")
                .help(format!("Samples a pixel of --reference auto [default: {DEFAULT_SPP}]")),
        );
    let command = gate_args::with_gate_args(command);
    ["max", "min", "threshold"]
        .into_iter()
        .fold(command, |command, name| command.mut_arg(name, |arg| arg.requires("reference")))
}

/// The reference that the flags ask for.
///
/// Errors: as `Asked::new`; a bad gate or threshold (exit code 2).
pub fn asked(matches: &ArgMatches) -> Result<Option<Asked>> {
    let Some(text) = matches.get_one::<String>("reference") else { return Ok(None) };
    let spp = matches.get_one::<u64>("reference-spp").copied().unwrap_or(DEFAULT_SPP);
    let (gates, threshold) = (gate_args::gates(matches)?, gate_args::threshold(matches)?);
    let watch = Shown { quiet: matches.get_flag("quiet"), bar: RefCell::default() };
    Asked::new(text, spp, threshold, gates, Box::new(watch)).map(Some)
}

/// A bar on a terminal, by the clock; a line elsewhere.
struct Shown {
    quiet: bool,
    bar: RefCell<Option<ProgressBar>>,
}

impl Watch for Shown {
    fn note(&self, text: &str) {
        if !self.quiet {
            eprintln!("note: {text}");
        }
    }

    fn begins(&self, recipe: &Recipe, estimate: Option<Duration>) {
        if self.quiet {
            return;
        }
        let samples = recipe.samples().map_or_else(String::new, |samples| format!(", {samples} samples a pixel"));
        let time = estimate.map_or_else(String::new, |time| format!(", about {:.0} s", time.as_secs_f64().ceil()));
        eprintln!("making the reference: {}{samples}{time}", recipe.technique.name());
        if let Some(estimate) = estimate.filter(|_| std::io::stderr().is_terminal()) {
            let part = move |state: &ProgressState, out: &mut dyn std::fmt::Write| {
                // An estimate that is passed is no end.
                let part = (state.elapsed().as_secs_f64() / estimate.as_secs_f64().max(1e-3)).min(0.99);
                let filled = (30.0 * part) as usize;
                let _ = write!(out, "{}{} {:>2.0} %", "█".repeat(filled), "░".repeat(30 - filled), 100.0 * part);
            };
            let bar = ProgressBar::new_spinner();
            if let Ok(style) = ProgressStyle::with_template("{part} of the estimated time, {elapsed}") {
                bar.set_style(style.with_key("part", part));
            }
            bar.enable_steady_tick(TICK);
            *self.bar.borrow_mut() = Some(bar);
        }
    }

    fn ends(&self) {
        if let Some(bar) = self.bar.borrow_mut().take() {
            bar.finish_and_clear();
        }
    }
}
