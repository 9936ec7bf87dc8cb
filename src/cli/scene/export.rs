//! `quincunx scene export`: a built-in scene as a .glb.

use super::seed::{seed, seed_argument};
use crate::cli::output;
use crate::error::{Error, Result};
use crate::scene::glb;
use crate::scene::procedural::{self, ProceduralScene};
use crate::shading::medium::Medium;
use crate::units::Bytes;
use crate::whole_file::write_whole;
use clap::{Arg, ArgMatches, Command, value_parser};
use std::io::Write;
use std::path::PathBuf;

/// The sub-verb with its arguments.
pub fn command() -> Command {
    Command::new("export")
        .about("Write a built-in scene as a .glb, with its materials, textures, lights, cameras and animations")
        .arg(
            Arg::new("scene")
                .value_name("NAME")
                .required(true)
                .help("A built-in scene, with parameters as in lamps:objects=101,lights=81"),
        )
        .arg(
            Arg::new("output")
                .short('o')
                .long("output")
                .value_name("FILE.glb")
                .required(true)
                .value_parser(value_parser!(PathBuf))
                .help("File to write, whole or not at all"),
        )
        .arg(seed_argument())
        .arg(output::quiet_flag())
}

/// Writes the file and prints what it holds.
///
/// Errors: no such built-in scene, another suffix than .glb, a file that cannot be written (exit code 2).
pub fn run(matches: &ArgMatches) -> Result<()> {
    let spec = matches.get_one::<String>("scene").expect("clap requires it");
    let path = matches.get_one::<PathBuf>("output").expect("clap requires it");
    if !path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("glb")) {
        return Err(Error::request(format!("-o {}: scenes are written as .glb", path.display())));
    }
    let ProceduralScene { scene, motions } = procedural::open(spec, seed(matches)).unwrap_or_else(|| {
        let names: Vec<&str> = procedural::ALL.iter().map(|built_in| built_in.name).collect();
        Err(Error::request(format!("scene {spec}: there is no built-in scene of that name"))
            .note(format!("built-in scenes: {}", names.join(", "))))
    })?;
    let bytes = glb::encode(&scene, &motions).map_err(|error| error.within(spec))?;
    write_whole(path, |out| out.write_all(&bytes))?;
    let (bytes, triangles) = (Bytes(bytes.len() as u64), scene.triangle_count());
    let mut text = format!("{}: {bytes}, {triangles} triangles\n", path.display());
    if scene.medium.is_some() {
        let medium = Medium::text(scene.medium);
        text += &format!("  note: a .glb cannot hold the scene's medium; --medium {medium} renders the file in it\n");
    }
    output::print_text(matches, &text)
}
