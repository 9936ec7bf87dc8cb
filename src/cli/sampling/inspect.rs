//! `quincunx sampling inspect`: what a pattern holds, as numbers, as a picture of its samples and of its spectrum.

use super::arguments::{chosen, pattern_argument, subset, subset_argument};
use super::{drawn, reach};
use crate::cli::output;
use crate::cli::spectrum::{self, Spectrum};
use crate::error::{Error, Result};
use crate::picture::image_file;
use crate::sampling::periodogram::pixel_frequency;
use crate::techniques::patterns::ChosenPattern;
use crate::whole_file::require_folder;
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use serde_json::{Map, Value, json};
use std::fmt::Write;
use std::path::PathBuf;

/// The sub-verb with its arguments.
pub fn command() -> Command {
    Command::new("inspect")
        .about(
            "Print a pattern's period, samples, dimensions, subsets and distances; draw its samples and its spectrum",
        )
        .arg(pattern_argument())
        .arg(
            Arg::new("output")
                .short('o')
                .long("output")
                .value_name("FILE.png")
                .value_parser(value_parser!(PathBuf))
                .help("File for a picture of the samples over the pixels of the period, coloured by subset"),
        )
        .arg(spectrum::argument("the pattern", "1"))
        .arg(reach::reach_argument().requires("spectrum"))
        .arg(subset_argument())
        .arg(Arg::new("json").long("json").action(ArgAction::SetTrue).help("Print one JSON document"))
        .arg(output::quiet_flag())
}

/// Prints the numbers and writes the pictures.
///
/// Errors: no such pattern or subset, a spectrum that is too large, a file of another kind or that cannot be written (exit code 2).
pub fn run(matches: &ArgMatches) -> Result<()> {
    let chosen = chosen(matches)?;
    let subset = subset(matches, &chosen)?;
    let output = matches.get_one::<PathBuf>("output");
    // Before anything is computed or written.
    if let Some(path) = output {
        image_file::require_png(path)?;
        require_folder(path)?;
    }
    let files = spectrum::files(matches)?;
    if let Some(path) = output.filter(|output| files.iter().any(|file| file.path == output.as_path())) {
        return Err(Error::request(format!("-o and --spectrum both name {}: give each its own file", path.display())));
    }
    let powers = if files.is_empty() { None } else { Some(reach::spectrum(matches, &chosen, subset)?) };
    if let Some(powers) = &powers {
        let of = Spectrum { periodogram: powers, grey_power: 1.0, title: &chosen.spec() };
        files.iter().try_for_each(|file| file.write(&of, reach::attributes(&chosen, subset, powers)))?;
    }
    if let Some(path) = output {
        image_file::write_srgb8(path, &drawn::samples(&chosen.pattern, subset))?;
    }
    if matches.get_flag("json") {
        let mut document = document(&chosen);
        if let Some(powers) = &powers {
            document["spectrum"] = json!({ "rings": spectrum::rings(powers) });
        }
        return output::print(&format!("{document:#}\n"));
    }
    let mut text = String::new();
    describe(&mut text, &chosen).expect("writing to a string");
    output::print_text(matches, &text)
}

/// Names of all dimensions of a sample.
fn dimensions(chosen: &ChosenPattern) -> Vec<&'static str> {
    ["x", "y"].into_iter().chain(chosen.pattern.further().iter().map(|dimension| dimension.name())).collect()
}

fn document(chosen: &ChosenPattern) -> Value {
    let pattern = &chosen.pattern;
    let setting = |key: &&str| ((*key).to_owned(), Value::from(chosen.values.text(key)));
    let settings: Map<String, Value> = chosen.named.keys.iter().map(setting).collect();
    let [least, most] = pattern.samples_per_pixel();
    let [across, down] = pixel_frequency(pattern);
    json!({
        "schema": 1,
        "name": chosen.named.name,
        "technique": chosen.technique.name(),
        "settings": settings,
        "period_px": pattern.period_px(),
        "samples": pattern.samples().len(),
        "samples_per_pixel": { "least": least, "most": most },
        "dimensions": dimensions(chosen),
        "subsets": pattern.subset_count(),
        "least_distance_px": pattern.least_distance_px(),
        "least_subset_distance_px": pattern.least_subset_distance_px(),
        "pixel_frequency": { "across": across, "down": down },
    })
}

fn describe(text: &mut String, chosen: &ChosenPattern) -> std::fmt::Result {
    let pattern = &chosen.pattern;
    writeln!(text, "{}", chosen.spec())?;
    writeln!(text, "   {}", chosen.named.summary)?;
    writeln!(text, "   of {}", chosen.technique.name())?;
    let [width, height] = pattern.period_px();
    writeln!(text, "   period: {width}x{height} px")?;
    let counts = match pattern.samples_per_pixel() {
        [least, most] if least == most => format!("{least} a pixel"),
        [least, most] => format!("{least} to {most} a pixel"),
    };
    writeln!(text, "   samples: {}, {counts}", pattern.samples().len())?;
    writeln!(text, "   dimensions: {}", dimensions(chosen).join(", "))?;
    writeln!(text, "   subsets: {}", pattern.subset_count())?;
    if let (Some(all), Some(subset)) = (pattern.least_distance_px(), pattern.least_subset_distance_px()) {
        writeln!(text, "   least distance: {all:.4} px, between samples of one subset {subset:.4} px")?;
    }
    let [across, down] = pixel_frequency(pattern).map(|part| 100.0 * part);
    let independent = 100.0 / pattern.samples().len() as f64;
    writeln!(
        text,
        "   moire of the pixel frequency: {across:.2} % of its energy across, {down:.2} % down; independent samples have \
         {independent:.2} %"
    )
}
