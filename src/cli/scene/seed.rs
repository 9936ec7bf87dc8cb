//! The seed of a built-in scene.

use clap::{Arg, ArgMatches, value_parser};

/// The seed of a built-in scene, as `render` has it.
pub fn seed_argument() -> Arg {
    Arg::new("seed")
        .long("seed")
        .value_name("N")
        .value_parser(value_parser!(u32))
        .default_value("1")
        .help("Seed of what a built-in scene scatters")
}

pub fn seed(matches: &ArgMatches) -> u64 {
    u64::from(*matches.get_one::<u32>("seed").expect("it has a default"))
}
