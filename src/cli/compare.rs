//! `quincunx compare`: a picture against its reference, as a table or JSON, with gates for scripts.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use serde_json::json;

use crate::error::{Error, Result};
use crate::metrics::{self, Comparison, Metrics};
use crate::report::image_file;

/// The verb with its arguments.
pub fn command() -> Command {
    let gate = |name: &'static str, help: &'static str| {
        Arg::new(name).long(name).value_name("METRIC=VALUE").action(ArgAction::Append).help(help)
    };
    Command::new("compare")
        .about("Compare a picture with its reference: RMSE, relMSE, PSNR, SSIM, FLIP")
        .long_about(
            "Compare a picture with its reference (PNG or EXR, of one size).\n\n\
             rmse and relmse are of scene-linear light; psnr (dB), ssim and flip of 8-bit sRGB at exposure 0. Equal \
             pictures have psnr inf (null in JSON). Exit code 1: a gate failed, or a picture holds NaN or infinity.",
        )
        .arg(path_arg("a", "A").required(true).help("The picture"))
        .arg(path_arg("b", "B").required(true).help("The reference"))
        .arg(gate("max", "Fail when METRIC (rmse, relmse, psnr, ssim, flip) is above VALUE; may be repeated"))
        .arg(gate("min", "Fail when METRIC is below VALUE; may be repeated"))
        .arg(path_arg("diff", "FILE.png").long("diff").help("Write FLIP's error map in the magma colours"))
        .arg(Arg::new("json").long("json").action(ArgAction::SetTrue).help("Print one JSON document"))
}

fn path_arg(name: &'static str, value_name: &'static str) -> Arg {
    Arg::new(name).value_name(value_name).value_parser(value_parser!(PathBuf))
}

/// Compares, writes the difference picture, prints, and only then fails on the first failed gate.
pub fn run(matches: &ArgMatches) -> Result<()> {
    let output = outcome(matches)?;
    let mut stdout = std::io::stdout().lock();
    stdout
        .write_all(output.text.as_bytes())
        .and_then(|()| stdout.flush())
        .map_err(|error| Error::request(format!("cannot write to standard output: {error}")))?;
    output.gates
}

/// What a comparison prints, and whether its gates hold.
struct Outcome {
    text: String,
    gates: Result<()>,
}

fn outcome(matches: &ArgMatches) -> Result<Outcome> {
    let path = |name| matches.get_one::<PathBuf>(name).map(PathBuf::as_path);
    let (a, b) = (path("a").expect("clap requires A"), path("b").expect("clap requires B"));
    let diff = path("diff");
    // Everything that can be refused without reading a picture is refused first.
    let gates = gates(matches)?;
    diff.map_or(Ok(()), image_file::require_png)?;
    let (actual, reference) = (image_file::read(a)?, image_file::read(b)?);
    let comparison = metrics::compare(&actual, &reference)
        .map_err(|error| error.within(format!("comparing {} with {}", a.display(), b.display())))?;
    if let Some(diff) = diff {
        image_file::write_srgb8(diff, &comparison.error_picture())?;
    }
    let text =
        if matches.get_flag("json") { json_text(a, b, &comparison, &gates) } else { table(a, b, &comparison, &gates) };
    let failed = gates.iter().find(|gate| !gate.passes(&comparison.metrics));
    Ok(Outcome { text, gates: failed.map_or(Ok(()), |gate| Err(gate.failure(a, b, &comparison.metrics))) })
}

#[derive(Clone, Copy, PartialEq)]
enum Bound {
    Max,
    Min,
}

impl Bound {
    const fn name(self) -> &'static str {
        match self {
            Self::Max => "max",
            Self::Min => "min",
        }
    }
}

/// A bound on one metric.
struct Gate {
    /// Index into `Metrics::NAMES`.
    metric_index: usize,
    bound: Bound,
    value: f64,
}

impl Gate {
    fn parse(bound: Bound, argument: &str) -> Result<Self> {
        let refused = |cause: &str| {
            let (flag, names) = (bound.name(), Metrics::NAMES.join(", "));
            Error::request(format!("--{flag} {argument}: {cause}"))
                .note(format!("for example --{flag} rmse=0.01; the metrics are {names}"))
        };
        let (name, value) = argument.split_once('=').ok_or_else(|| refused("it has no ="))?;
        let metric_index = Metrics::NAMES
            .iter()
            .position(|known| *known == name)
            .ok_or_else(|| refused(&format!("there is no metric {name}")))?;
        match value.parse::<f64>() {
            Ok(value) if !value.is_nan() => Ok(Self { metric_index, bound, value }),
            _ => Err(refused(&format!("{value} is no number"))),
        }
    }

    fn name(&self) -> &'static str {
        Metrics::NAMES[self.metric_index]
    }

    fn measured(&self, metrics: &Metrics) -> f64 {
        metrics.values()[self.metric_index]
    }

    fn passes(&self, metrics: &Metrics) -> bool {
        match self.bound {
            Bound::Max => self.measured(metrics) <= self.value,
            Bound::Min => self.measured(metrics) >= self.value,
        }
    }

    fn failure(&self, a: &Path, b: &Path, metrics: &Metrics) -> Error {
        let side = if self.bound == Bound::Max { "above" } else { "below" };
        Error::gate(format!(
            "comparing {} with {}: {} is {}, {side} --{} {}",
            a.display(),
            b.display(),
            self.name(),
            self.measured(metrics),
            self.bound.name(),
            self.value
        ))
    }
}

/// The gates in the order max, min, each as given.
fn gates(matches: &ArgMatches) -> Result<Vec<Gate>> {
    [Bound::Max, Bound::Min]
        .into_iter()
        .flat_map(|bound| {
            let arguments = matches.get_many::<String>(bound.name()).into_iter().flatten();
            arguments.map(move |argument| Gate::parse(bound, argument))
        })
        .collect()
}

fn table(a: &Path, b: &Path, comparison: &Comparison, gates: &[Gate]) -> String {
    let mut text = format!("{} against {}, {}\n", a.display(), b.display(), comparison.extent);
    for (name, value) in Metrics::NAMES.into_iter().zip(comparison.metrics.values()) {
        let unit = if name == "psnr" { " dB" } else { "" };
        writeln!(text, "  {name:<6}  {value:>12.6}{unit}").expect("a string takes any text");
    }
    for gate in gates {
        let verdict = if gate.passes(&comparison.metrics) { "passed" } else { "failed" };
        writeln!(text, "  --{} {}={}: {verdict}", gate.bound.name(), gate.name(), gate.value)
            .expect("a string takes any text");
    }
    text
}

/// One document on one line. What is infinite (the PSNR of equal pictures, or a bound) is null.
fn json_text(a: &Path, b: &Path, comparison: &Comparison, gates: &[Gate]) -> String {
    let gates: Vec<_> = gates
        .iter()
        .map(|gate| {
            json!({
                "metric": gate.name(),
                "bound": gate.bound.name(),
                "value": gate.value,
                "measured": gate.measured(&comparison.metrics),
                "passed": gate.passes(&comparison.metrics),
            })
        })
        .collect();
    let document = json!({
        "schema": 1,
        "a": a.display().to_string(),
        "b": b.display().to_string(),
        "width": comparison.extent.width,
        "height": comparison.extent.height,
        "metrics": comparison.metrics,
        "gates": gates,
    });
    format!("{document}\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::image_file::WriteOptions;
    use crate::report::picture::Picture;
    use crate::units::Extent;

    /// A folder with `a.exr` (0.5 everywhere) and `b.exr` (0.25 everywhere): the RMSE is 0.25.
    fn folder() -> tempfile::TempDir {
        let folder = tempfile::tempdir().unwrap();
        for (name, level) in [("a.exr", 0.5), ("b.exr", 0.25)] {
            let picture = Picture::filled(Extent::new(16, 12), [level; 3]);
            image_file::write(&folder.path().join(name), &picture, &WriteOptions::default()).unwrap();
        }
        folder
    }

    fn compare(folder: &Path, a: &str, b: &str, more: &[&str]) -> Result<Outcome> {
        let mut arguments = vec!["compare".into(), folder.join(a).into_os_string(), folder.join(b).into_os_string()];
        arguments.extend(more.iter().map(Into::into));
        outcome(&command().try_get_matches_from(arguments).unwrap())
    }

    #[test]
    fn the_command_is_well_formed() {
        command().debug_assert();
    }

    #[test]
    fn the_table_has_a_line_a_metric_and_a_gate() {
        let folder = folder();
        let output = compare(folder.path(), "a.exr", "b.exr", &["--max", "rmse=0.25", "--min", "ssim=0.99"]).unwrap();
        let lines: Vec<&str> = output.text.lines().skip(1).collect();
        assert_eq!(lines[0], "  rmse        0.250000");
        assert!(lines[2].starts_with("  psnr ") && lines[2].ends_with(" dB"), "{}", lines[2]);
        assert_eq!(lines[5..], ["  --max rmse=0.25: passed", "  --min ssim=0.99: failed"]);
        let equal = compare(folder.path(), "a.exr", "a.exr", &["--min", "psnr=inf"]).unwrap();
        assert!(equal.text.contains("psnr             inf dB"), "{}", equal.text);
        assert!(equal.gates.is_ok());
    }

    #[test]
    fn json_is_one_document_with_every_gate() {
        let folder = folder();
        let gates = ["--json", "--max", "rmse=0.2", "--max", "relmse=10", "--min", "psnr=1"];
        let output = compare(folder.path(), "a.exr", "b.exr", &gates).unwrap();
        let document: serde_json::Value = serde_json::from_str(&output.text).unwrap();
        assert_eq!(document["schema"], 1);
        assert_eq!(document["width"], 16);
        assert_eq!(document["height"], 12);
        assert!(document["b"].as_str().unwrap().ends_with("b.exr"));
        assert_eq!(document["metrics"]["rmse"], 0.25);
        assert_eq!(
            document["gates"][0],
            json!({"metric": "rmse", "bound": "max", "value": 0.2, "measured": 0.25, "passed": false})
        );
        assert_eq!(document["gates"][1]["passed"], true);
        assert_eq!(document["gates"][2]["bound"], "min");
        let equal = compare(folder.path(), "a.exr", "a.exr", &["--json"]).unwrap();
        let document: serde_json::Value = serde_json::from_str(&equal.text).unwrap();
        assert!(document["metrics"]["psnr"].is_null());
    }

    #[test]
    fn a_failed_gate_names_metric_measured_and_bound() {
        let folder = folder();
        let error = compare(folder.path(), "a.exr", "b.exr", &["--max", "rmse=0.2"]).unwrap().gates.unwrap_err();
        assert_eq!(error.exit_code(), 1);
        assert!(error.message().ends_with("b.exr: rmse is 0.25, above --max 0.2"), "{error}");
        let error = compare(folder.path(), "a.exr", "b.exr", &["--min", "rmse=1"]).unwrap().gates.unwrap_err();
        assert!(error.message().ends_with("b.exr: rmse is 0.25, below --min 1"), "{error}");
    }

    #[test]
    fn a_bad_gate_is_refused_before_a_picture_is_read_and_lists_the_metrics() {
        for (argument, cause) in [
            ("mse=1", "there is no metric mse"),
            ("rmse", "it has no ="),
            ("rmse=small", "small is no number"),
            ("rmse=nan", "nan is no number"),
            ("rmse=", " is no number"),
        ] {
            let error = compare(Path::new("/nowhere"), "a.exr", "b.exr", &["--max", argument]).err().unwrap();
            assert_eq!(error.exit_code(), 2);
            assert!(error.message().ends_with(cause), "{error}");
            assert!(error.to_string().contains("the metrics are rmse, relmse, psnr, ssim, flip"), "{error}");
        }
        let error = compare(Path::new("/nowhere"), "a.exr", "b.exr", &["--diff", "d.exr"]).err().unwrap();
        assert!(error.message().contains("name it .png"), "{error}");
    }

    #[test]
    fn the_difference_is_written_even_when_a_gate_fails() {
        let folder = folder();
        let diff = folder.path().join("diff.png");
        let more = ["--max", "rmse=0", "--diff", diff.to_str().unwrap()];
        assert!(compare(folder.path(), "a.exr", "b.exr", &more).unwrap().gates.is_err());
        assert_eq!(image_file::read(&diff).unwrap().extent, Extent::new(16, 12));
    }
}
