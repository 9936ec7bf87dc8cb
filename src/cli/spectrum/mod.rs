//! `--spectrum` of `compare` and of `sampling inspect`: a periodogram as a picture, as its powers and as a plot of its
//! rings.

mod drawn;
mod plot;

use crate::error::{Error, Result};
use crate::picture::Picture;
use crate::picture::image_file::{self, WriteOptions};
use crate::sampling::periodogram::{Periodogram, Ring};
use crate::units::Extent;
use crate::whole_file::{require_folder, write_whole};
use clap::{Arg, ArgAction, ArgMatches, value_parser};
use serde_json::{Value, json};
use std::io::Write;
use std::path::{Path, PathBuf};

/// The flag. `of`: whose spectrum it is; `grey`: the power that is drawn half way between black and white.
pub fn argument(of: &str, grey: &str) -> Arg {
    Arg::new("spectrum")
        .long("spectrum")
        .value_name("FILE.png|FILE.exr|FILE.svg")
        .action(ArgAction::Append)
        .value_parser(value_parser!(PathBuf))
        .help(format!(
            "File for the spectrum of {of}; may be repeated. .png: drawn with 0 in the middle, power 0 black, {grey} grey, \
             more white; .exr: its powers; .svg: a plot of radial mean and anisotropy. --json has these numbers then"
        ))
}

#[derive(Clone, Copy)]
enum Format {
    Drawn,
    Powers,
    Plot,
}

/// A file that `--spectrum` names.
pub struct SpectrumFile<'a> {
    pub path: &'a Path,
    format: Format,
}

/// The files in the order of the arguments.
///
/// Errors: another ending, or no such folder (exit code 2).
pub fn files(matches: &ArgMatches) -> Result<Vec<SpectrumFile<'_>>> {
    let paths = matches.get_many::<PathBuf>("spectrum").into_iter().flatten();
    paths
        .map(|path| {
            let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
            let format = match extension.to_str() {
                Some("png") => Format::Drawn,
                Some("exr") => Format::Powers,
                Some("svg") => Format::Plot,
                _ => {
                    let cause = "a spectrum is .png (drawn), .exr (its powers) or .svg (a plot of its rings)";
                    return Err(Error::request(format!("--spectrum {}: {cause}", path.display())));
                }
            };
            require_folder(path)?;
            Ok(SpectrumFile { path, format })
        })
        .collect()
}

/// What the files show.
pub struct Spectrum<'a> {
    pub periodogram: &'a Periodogram,
    /// The power that is drawn half way between black and white.
    pub grey_power: f64,
    pub title: &'a str,
}

impl SpectrumFile<'_> {
    /// Writes the file whole or not at all. `attributes`: names and texts for the header of powers.
    ///
    /// Errors: it cannot be written (exit code 2).
    pub fn write(&self, of: &Spectrum, attributes: Vec<(String, String)>) -> Result<()> {
        match self.format {
            Format::Drawn => image_file::write_srgb8(self.path, &drawn::powers(of.periodogram, of.grey_power)),
            Format::Powers => write_powers(self.path, of.periodogram, attributes),
            Format::Plot => {
                let text = plot::svg(&of.periodogram.rings(), of.title);
                write_whole(self.path, |out| out.write_all(text.as_bytes()))
            }
        }
    }
}

/// Writes the powers as an EXR, the same in R, G and B, frequency 0 in the middle. `attributes`: names and texts for its
/// header.
///
/// Errors: it cannot be written (exit code 2).
pub fn write_powers(path: &Path, powers: &Periodogram, attributes: Vec<(String, String)>) -> Result<()> {
    let [width, height] = powers.size();
    let pixels = powers.powers().iter().map(|power| [*power; 3]).collect();
    let options = WriteOptions { attributes, ..WriteOptions::default() };
    image_file::write(path, &Picture { extent: Extent::new(width, height), pixels }, &options)
}

/// The rings as `--json` has them.
pub fn rings(powers: &Periodogram) -> Vec<Value> {
    let ring = |Ring { cycles_per_px, frequency_count, power, anisotropy }: Ring| {
        json!({
            "cycles_per_px": cycles_per_px,
            "frequencies": frequency_count,
            "power": power,
            "anisotropy": anisotropy,
        })
    };
    powers.rings().into_iter().map(ring).collect()
}
