//! The spectrum of a pattern as `inspect` and `export` write it: powers up to some cycles a pixel.

use crate::error::{Error, Result};
use crate::sampling::periodogram::Periodogram;
use crate::techniques::patterns::ChosenPattern;
use clap::{Arg, ArgMatches, value_parser};

/// Sums of a spectrum: samples times frequencies. As many take some seconds on one processor core.
const MOST_STEPS: u64 = 1 << 31;
/// Frequencies of a spectrum: a picture of 4096 x 4096.
const MOST_FREQUENCIES: u64 = 1 << 24;
/// `--reach` without the flag, cycles a pixel.
const DEFAULT_REACH: u32 = 4;

/// The flag that both sub-verbs have.
pub fn reach_argument() -> Arg {
    let help = format!("Highest frequency of the spectrum, in cycles a pixel, 1 to 64 [default: {DEFAULT_REACH}]");
    Arg::new("reach").long("reach").value_name("CYCLES").value_parser(value_parser!(u32).range(1..=64)).help(help)
}

/// Highest frequency along x and y, cycles a period.
fn reach(period_px: [u32; 2], cycles_per_px: u32) -> [u32; 2] {
    period_px.map(|side| side * cycles_per_px)
}

/// The spectrum of all samples, or of those of `subset`, up to `--reach`.
///
/// Errors: it would take too long, or have too many frequencies (exit code 2).
pub fn spectrum(matches: &ArgMatches, chosen: &ChosenPattern, subset: Option<u32>) -> Result<Periodogram> {
    let asked = matches.get_one::<u32>("reach").copied().unwrap_or(DEFAULT_REACH);
    let (pattern, period_px) = (&chosen.pattern, chosen.pattern.period_px());
    let is_meant = |of: u32| subset.is_none_or(|subset| subset == of);
    let count = pattern.samples().iter().filter(|sample| is_meant(sample.subset)).count();
    let is_possible = |cycles_per_px: u32| {
        let reach = reach(period_px, cycles_per_px);
        let frequencies: u64 = reach.iter().map(|reach| u64::from(*reach) * 2 + 1).product();
        frequencies <= MOST_FREQUENCIES && Periodogram::steps(count, reach) <= MOST_STEPS
    };
    if !is_possible(asked) {
        let [width, height] = period_px;
        let error = Error::request(format!(
            "--reach {asked}: the spectrum of {count} samples over {width}x{height} pixels is too large"
        ));
        return Err(match (1..asked).rev().find(|cycles| is_possible(*cycles)) {
            Some(cycles) => error.note(format!("--reach {cycles} works")),
            None => error.note("a pattern of a shorter period has a smaller one"),
        });
    }
    Ok(Periodogram::new(pattern, reach(period_px, asked), |sample| is_meant(sample.subset)))
}

/// What a file of powers says of them in its header.
pub fn attributes(chosen: &ChosenPattern, subset: Option<u32>, spectrum: &Periodogram) -> Vec<(String, String)> {
    let cycles_per_px = spectrum.reach[0] / spectrum.period_px[0];
    let always = [("pattern", chosen.spec()), ("reach_cycles_per_px", cycles_per_px.to_string())];
    let subset = subset.map(|subset| ("subset", subset.to_string()));
    always.into_iter().chain(subset).map(|(name, text)| (name.to_owned(), text)).collect()
}
