//! `quincunx sampling export`: the samples of a pattern as CSV or JSON, or its spectrum as EXR. docs/sampling.md has
//! the columns.

use super::arguments::{chosen, pattern_argument, subset, subset_argument};
use super::reach;
use crate::cli::{output, spectrum};
use crate::error::{Error, Result};
use crate::sampling::pattern::{Dimension, Sample};
use crate::techniques::patterns::ChosenPattern;
use crate::whole_file::{require_folder, write_whole};
use clap::{Arg, ArgMatches, Command, value_parser};
use serde_json::{Map, Value, json};
use std::io::Write;
use std::path::{Path, PathBuf};

/// The sub-verb with its arguments.
pub fn command() -> Command {
    Command::new("export")
        .about("Write the samples of a pattern as CSV or JSON, or its spectrum as EXR")
        .arg(pattern_argument())
        .arg(
            Arg::new("output")
                .short('o')
                .long("output")
                .value_name("FILE.csv|FILE.json|FILE.exr")
                .required(true)
                .value_parser(value_parser!(PathBuf))
                .help("File to write, whole or not at all: samples as .csv or .json, the spectrum as .exr"),
        )
        .arg(reach::reach_argument())
        .arg(subset_argument())
        .arg(output::quiet_flag())
}

#[derive(Clone, Copy, PartialEq)]
enum Format {
    Csv,
    Json,
    Exr,
}

impl Format {
    fn of(path: &Path) -> Result<Self> {
        let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
        match extension.to_str() {
            Some("csv") => Ok(Self::Csv),
            Some("json") => Ok(Self::Json),
            Some("exr") => Ok(Self::Exr),
            _ => Err(Error::request(format!("-o {}: samples are .csv or .json, a spectrum is .exr", path.display()))),
        }
    }
}

/// Writes the file and prints what it holds.
///
/// Errors: no such pattern or subset, another suffix, a spectrum that is too large, a file that cannot be written (exit
/// code 2).
pub fn run(matches: &ArgMatches) -> Result<()> {
    let path = matches.get_one::<PathBuf>("output").expect("clap requires it");
    let format = Format::of(path)?;
    if format != Format::Exr && matches.contains_id("reach") {
        return Err(Error::request(format!("--reach with -o {}: samples have no frequencies", path.display()))
            .note("-o FILE.exr writes the spectrum"));
    }
    let chosen = chosen(matches)?;
    let subset = subset(matches, &chosen)?;
    require_folder(path)?;
    let held = match format {
        Format::Exr => {
            let powers = reach::spectrum(matches, &chosen, subset)?;
            spectrum::write_powers(path, &powers, reach::attributes(&chosen, subset, &powers))?;
            let [width, height] = powers.size();
            format!("{width}x{height} frequencies")
        }
        Format::Csv => {
            let rows = csv(&chosen, subset);
            write_whole(path, |out| out.write_all(rows.as_bytes()))?;
            format!("{} samples", count(&chosen, subset))
        }
        Format::Json => {
            let document = format!("{:#}\n", document(&chosen, subset));
            write_whole(path, |out| out.write_all(document.as_bytes()))?;
            format!("{} samples", count(&chosen, subset))
        }
    };
    output::print_text(matches, &format!("{}: {held} of {}\n", path.display(), chosen.spec()))
}

/// Samples that are meant, each with its pixel.
fn samples(chosen: &ChosenPattern, subset: Option<u32>) -> impl Iterator<Item = ([u32; 2], &Sample)> {
    chosen.pattern.placed().filter(move |(_, sample)| subset.is_none_or(|one| one == sample.subset))
}

fn count(chosen: &ChosenPattern, subset: Option<u32>) -> usize {
    samples(chosen, subset).count()
}

/// Names of the columns, and of the keys of a sample.
fn columns(chosen: &ChosenPattern) -> Vec<&'static str> {
    let further = chosen.pattern.further().iter().copied().map(Dimension::name);
    ["pixel_x", "pixel_y", "place_x_px", "place_y_px", "subset"].into_iter().chain(further).collect()
}

/// A sample's numbers in the order of `columns`.
fn cells(chosen: &ChosenPattern, ([x, y], sample): ([u32; 2], &Sample)) -> Vec<Value> {
    let further = &sample.further[..chosen.pattern.further().len()];
    let [place_x, place_y] = sample.place_px;
    let own = [json!(x), json!(y), json!(place_x), json!(place_y), json!(sample.subset)];
    own.into_iter().chain(further.iter().map(|number| json!(number))).collect()
}

fn csv(chosen: &ChosenPattern, subset: Option<u32>) -> String {
    let mut text = format!("{}\n", columns(chosen).join(","));
    for placed in samples(chosen, subset) {
        let cells: Vec<String> = cells(chosen, placed).iter().map(Value::to_string).collect();
        text.extend([cells.join(","), "\n".to_owned()]);
    }
    text
}

fn document(chosen: &ChosenPattern, subset: Option<u32>) -> Value {
    let sample = |placed| -> Value {
        let keys = columns(chosen).into_iter().map(str::to_owned);
        keys.zip(cells(chosen, placed)).collect::<Map<String, Value>>().into()
    };
    json!({
        "schema": 1,
        "pattern": chosen.spec(),
        "technique": chosen.technique.name(),
        "period_px": chosen.pattern.period_px(),
        "subsets": chosen.pattern.subset_count(),
        "samples": samples(chosen, subset).map(sample).collect::<Vec<_>>(),
    })
}
