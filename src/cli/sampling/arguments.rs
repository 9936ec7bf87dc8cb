//! Which pattern and which of its subsets a sub-verb is about.

use crate::error::{Error, Result};
use crate::techniques::patterns::{self, ChosenPattern};
use clap::{Arg, ArgMatches, value_parser};

/// The pattern, by its name and settings.
pub fn pattern_argument() -> Arg {
    Arg::new("pattern").value_name("NAME[:KEY=VALUE,...]").required(true).help(
        "A pattern of `sampling list`, with settings as in tuples:spp=4,seed=7; those left out have their defaults",
    )
}

/// The flag that chooses one subset.
pub fn subset_argument() -> Arg {
    Arg::new("subset")
        .long("subset")
        .value_name("N")
        .value_parser(value_parser!(u32))
        .help("Only the samples of this subset; default: all samples")
}

/// The pattern that was asked for.
///
/// Errors: as `patterns::open` (exit code 2).
pub fn chosen(matches: &ArgMatches) -> Result<ChosenPattern> {
    patterns::open(matches.get_one::<String>("pattern").expect("clap requires it"))
}

/// The subset that `--subset` names.
///
/// Errors: the pattern has no such subset (exit code 2).
pub fn subset(matches: &ArgMatches, chosen: &ChosenPattern) -> Result<Option<u32>> {
    let Some(subset) = matches.get_one::<u32>("subset").copied() else { return Ok(None) };
    let count = chosen.pattern.subset_count();
    if subset < count {
        return Ok(Some(subset));
    }
    let last = count - 1;
    Err(Error::request(format!("--subset {subset}: {} has the subsets 0 to {last}", chosen.spec())))
}
