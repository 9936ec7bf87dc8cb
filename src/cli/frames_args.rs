//! --frames and --fps: what `render` and `bench frame` share.

use crate::error::Result;
use crate::sequence::Frames;
use clap::{Arg, ArgMatches, Command};

/// Frames a second of `--frames` without `--fps`.
const DEFAULT_FPS: &str = "24";

/// Adds both. `help`: what becomes of the frames.
pub fn with_frames_args(command: Command, help: &str) -> Command {
    let frame_times = "frame n is drawn n / fps seconds after --time";
    command
        .arg(
            Arg::new("frames")
                .long("frames")
                .value_name("A..B")
                .allow_hyphen_values(true)
                .help(format!("{help}; {frame_times}")),
        )
        .arg(
            Arg::new("fps")
                .long("fps")
                .value_name("N")
                .requires("frames")
                .allow_negative_numbers(true)
                .help(format!("Frames a second of --frames [default: {DEFAULT_FPS}]")),
        )
}

/// The frames that were asked for.
///
/// Errors: as `Frames::parse`.
pub fn asked(matches: &ArgMatches) -> Result<Option<Frames>> {
    let Some(range) = matches.get_one::<String>("frames") else { return Ok(None) };
    Frames::parse(range, matches.get_one::<String>("fps").map_or(DEFAULT_FPS, String::as_str)).map(Some)
}
