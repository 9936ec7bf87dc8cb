//! `quincunx compare`: a picture against its reference, as a table or JSON, with gates for scripts.

use crate::cli::output::{print, print_text, quiet_flag};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use serde_json::json;

use super::gate_args;
use super::spectrum::{self, Spectrum};
use crate::error::{Error, Result};
use crate::metrics::gate::{self, Gate};
use crate::metrics::{self, Comparison, ErrorSpectrum, Measure, Metrics, Part};
use crate::picture::image_file;
use crate::units::Extent;

/// The verb with its arguments.
pub fn command() -> Command {
    let titles: Vec<&str> = Metrics::MEASURES.iter().map(|measure| measure.title).collect();
    let command = Command::new("compare")
        .about(format!("Compare a picture with its reference: {}", titles.join(", ")))
        .long_about(format!(
            "Compare a picture with its reference (PNG or EXR, of one size).\n\n\
             {} measure scene-linear light; {} measure 8-bit sRGB at exposure 0. A PNG holds no light above 1: where one is \
             compared, the measures of light are marked as cut. Equal pictures have psnr inf (null in JSON). Exit code 1: a \
             gate failed, or a picture holds NaN or infinity.",
            with_units(true),
            with_units(false),
        ))
        .arg(path_arg("a", "A").required(true).help("Picture to measure"))
        .arg(path_arg("b", "B").required(true).help("Reference picture"))
        .arg(path_arg("diff", "FILE.png").long("diff").help("File to write FLIP's error map to, in the magma colours"))
        .arg(path_arg("hdr-diff", "FILE.png").long("hdr-diff").help("File to write HDR-FLIP's error map to, in the same colours"))
        .arg(spectrum::argument("the error (A minus B, scene-linear luminance)", "its variance"))
        .arg(Arg::new("where").long("where").value_name("CHANNEL=FILE.exr[,FILE.exr]").help(
            "Also measure, apart from the other pixels, those in which this channel differs between two EXR files, such as \
             geometry.dsf.id.Y=low.exr,high.exr, or in which it is not 0 if one file is given",
        ))
        .arg(Arg::new("json").long("json").action(ArgAction::SetTrue).help("Print one JSON document"))
        .arg(quiet_flag());
    gate_args::with_gate_args(command)
}

/// The names of the measures that are of light, or of the others, each with its unit, as a sentence lists them.
fn with_units(is_of_light: bool) -> String {
    let measures = Metrics::MEASURES.iter().filter(|measure| measure.is_of_light == is_of_light);
    let names = measures.map(|measure| match (measure.unit)(&"--threshold") {
        unit if unit.is_empty() => measure.name.to_owned(),
        unit => format!("{} ({unit})", measure.name),
    });
    let names: Vec<String> = names.collect();
    match names.split_last() {
        Some((last, others)) if !others.is_empty() => format!("{} and {last}", others.join(", ")),
        _ => names.concat(),
    }
}

fn path_arg(name: &'static str, value_name: &'static str) -> Arg {
    Arg::new(name).value_name(value_name).value_parser(value_parser!(PathBuf))
}

/// Frequencies below this are slow: what one sees as moire and as steps, and not as grain.
const LOW_CYCLES_PER_PX: f64 = 0.125;

/// Compares, writes the difference picture, prints, and only then fails on the first failed gate.
pub fn run(matches: &ArgMatches) -> Result<()> {
    let output = outcome(matches)?;
    if matches.get_flag("json") {
        print(&output.text)?;
    } else {
        print_text(matches, &output.text)?;
    }
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
    let (diff, hdr_diff) = (path("diff"), path("hdr-diff"));
    // Everything that can be refused without reading a picture is refused first.
    let (gates, threshold) = (gate_args::gates(matches)?, gate_args::threshold(matches)?);
    let place = matches.get_one::<String>("where").map(|argument| Where::parse(argument)).transpose()?;
    [diff, hdr_diff].into_iter().flatten().try_for_each(image_file::require_png)?;
    let spectrum_files = spectrum::files(matches)?;
    let (actual, reference) = (image_file::read(a)?, image_file::read(b)?);
    let context = format!("comparing {} with {}", a.display(), b.display());
    let comparison =
        metrics::compare(&actual, &reference, threshold).map_err(|error| error.within(context.as_str()))?;
    for (path, draw) in [(diff, Comparison::error_picture as fn(&_) -> _), (hdr_diff, Comparison::hdr_error_picture)] {
        if let Some(path) = path {
            image_file::write_srgb8(path, &draw(&comparison))?;
        }
    }
    let error_spectrum = (!spectrum_files.is_empty()).then(|| ErrorSpectrum::new(&actual, &reference));
    if let Some(found) = &error_spectrum {
        let title = format!("{} - {}", a.display(), b.display());
        let of = Spectrum { periodogram: &found.periodogram, grey_power: found.variance, title: &title };
        spectrum_files.iter().try_for_each(|file| file.write(&of, vec![("error".to_owned(), title.clone())]))?;
    }
    let parts = match place {
        None => Vec::new(),
        Some(place) => {
            let chosen = place.chosen(comparison.extent)?;
            let others: Vec<bool> = chosen.iter().map(|is_chosen| !is_chosen).collect();
            let part = |chosen: &[bool]| comparison.part(&actual, &reference, threshold, chosen);
            vec![("where", part(&chosen)), ("elsewhere", part(&others))]
        }
    };
    let spectrum = error_spectrum.as_ref();
    let seen = Seen { a, b, comparison: &comparison, parts: &parts, spectrum, threshold, gates: &gates };
    let text = if matches.get_flag("json") { seen.json() } else { seen.table() };
    Ok(Outcome { text, gates: gate::judge(&gates, &comparison.metrics, context) })
}

/// Which pixels are measured apart: `--where`.
struct Where<'a> {
    channel: &'a str,
    file: &'a Path,
    /// What the first is held against; None: 0.
    other: Option<&'a Path>,
}

impl<'a> Where<'a> {
    /// Errors: no channel, or not one or two files (exit code 2).
    fn parse(argument: &'a str) -> Result<Self> {
        let example = "for example --where geometry.dsf.id.Y=low.exr,high.exr";
        let refused = |cause: &str| Error::request(format!("--where {argument}: {cause}")).note(example);
        let (channel, files) = argument.split_once('=').ok_or_else(|| refused("it has no ="))?;
        let (file, other) = files.split_once(',').map_or((files, None), |(file, other)| (file, Some(other)));
        if [Some(channel), Some(file), other].contains(&Some("")) || other.is_some_and(|other| other.contains(',')) {
            return Err(refused("it must name a channel and one EXR file or two"));
        }
        Ok(Self { channel, file: Path::new(file), other: other.map(Path::new) })
    }

    /// A flag for each pixel of a picture of `extent`.
    ///
    /// Errors: a file that cannot be read, is of another size or has no such channel (exit code 2).
    fn chosen(&self, extent: Extent) -> Result<Vec<bool>> {
        let read = |file: &Path| image_file::read_exr_channels(file, extent, [self.channel]).map(|(values, _)| values);
        let values = read(self.file)?;
        Ok(match self.other.map(read).transpose()? {
            Some(others) => values.iter().zip(&others).map(|(a, b)| a != b).collect(),
            None => values.iter().map(|[value]| *value != 0.0).collect(),
        })
    }
}

/// What is printed.
struct Seen<'a> {
    a: &'a Path,
    b: &'a Path,
    comparison: &'a Comparison,
    /// What `--where` chooses, and the rest.
    parts: &'a [(&'static str, Part)],
    /// With `--spectrum` alone.
    spectrum: Option<&'a ErrorSpectrum>,
    threshold: f64,
    gates: &'a [Gate],
}

impl Seen<'_> {
    fn is_cut(&self) -> bool {
        [self.a, self.b].into_iter().any(image_file::is_cut)
    }

    fn table(&self) -> String {
        let Self { a, b, comparison, .. } = self;
        let mut text = format!("{} against {}, {}\n", a.display(), b.display(), comparison.extent);
        for (measure, value) in comparison.metrics.each() {
            let line = measure.line(value, self.threshold, self.is_cut());
            writeln!(text, "{line}").expect("a string takes any text");
        }
        for (name, part) in self.parts {
            let percent = 100.0 * part.pixels as f64 / comparison.extent.pixel_count() as f64;
            writeln!(text, "{name}: {} pixels, {percent:.2} %", part.pixels).expect("a string takes any text");
            for (name, mean) in part.means() {
                let (Some(measure), Some(value)) = (Measure::named(name), mean) else { continue };
                let line = measure.line(value, self.threshold, self.is_cut());
                writeln!(text, "{line}").expect("a string takes any text");
            }
        }
        if let Some(ErrorSpectrum { mean, variance, periodogram }) = self.spectrum {
            let low = periodogram.energy_below(LOW_CYCLES_PER_PX);
            writeln!(
                text,
                "spectrum of A - B: mean {mean:.3e}, kept apart; variance {variance:.3e}, {low:.3e} of it below 1/8 cycle a pixel"
            )
                .expect("a string takes any text");
        }
        for gate in self.gates {
            writeln!(text, "  {}", gate.text(&comparison.metrics)).expect("a string takes any text");
        }
        text
    }

    /// One document on one line. What is infinite (the PSNR of equal pictures, or a bound) is null.
    fn json(&self) -> String {
        let Self { a, b, comparison, .. } = self;
        let mut document = json!({
            "schema": 1,
            "a": a.display().to_string(),
            "b": b.display().to_string(),
            "width": comparison.extent.width,
            "height": comparison.extent.height,
            "metrics": comparison.metrics,
            "threshold": self.threshold,
            "cut": if self.is_cut() { Metrics::of_light() } else { Vec::new() },
            "gates": self.gates.iter().map(|gate| gate.verdict(&comparison.metrics)).collect::<Vec<_>>(),
        });
        for (name, part) in self.parts {
            document[name] = json!(part);
        }
        if let Some(ErrorSpectrum { mean, variance, periodogram }) = self.spectrum {
            let rings = spectrum::rings(periodogram);
            let low = periodogram.energy_below(LOW_CYCLES_PER_PX);
            document["spectrum"] = json!({ "mean": mean, "variance": variance, "low_energy": low, "rings": rings });
        }
        format!("{document}\n")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::image_file::WriteOptions;
    use crate::picture::{Aov, AovChannels, Picture};

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
        assert_eq!(lines[0], "  rmse                0.250000");
        assert!(lines[2].starts_with("  psnr ") && lines[2].ends_with(" dB"), "{}", lines[2]);
        assert!(
            lines[6].starts_with("  over_threshold ") && lines[6].ends_with(" % of pixels above 0.1"),
            "{}",
            lines[6]
        );
        assert_eq!(lines[7..], ["  --max rmse=0.25: passed", "  --min ssim=0.99: failed"]);
        let equal = compare(folder.path(), "a.exr", "a.exr", &["--min", "psnr=inf"]).unwrap();
        assert!(equal.text.contains("psnr                     inf dB"), "{}", equal.text);
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
            ("rmse=small", "small is not a number"),
            ("rmse=nan", "nan is not a number"),
            ("rmse=", " is not a number"),
        ] {
            let error = compare(Path::new("/nowhere"), "a.exr", "b.exr", &["--max", argument]).err().unwrap();
            assert_eq!(error.exit_code(), 2);
            assert!(error.message().ends_with(cause), "{error}");
            assert!(error.to_string().contains("the metrics are rmse, relmse, psnr, ssim, flip, hdr_flip"), "{error}");
        }
        for threshold in ["-0.1", "1.5", "nan", "much"] {
            let error = compare(Path::new("/nowhere"), "a.exr", "b.exr", &["--threshold", threshold]).err().unwrap();
            assert!(error.exit_code() == 2 && error.message().contains("0 to 1"), "{error}");
        }
        let error = compare(Path::new("/nowhere"), "a.exr", "b.exr", &["--diff", "d.exr"]).err().unwrap();
        assert!(error.message().contains("name it .png"), "{error}");
    }

    #[test]
    fn pixels_are_measured_apart_by_a_channel_of_one_file_or_of_two() {
        let folder = folder();
        let extent = Extent::new(16, 12);
        for (name, limit) in [("low.exr", 3), ("high.exr", 5)] {
            let values = (0..extent.pixel_count() as u32).map(|at| u32::from(at % 16 < limit)).collect();
            let aovs = [Aov { name: "id".to_owned(), channels: AovChannels::YU32(values) }];
            let options = WriteOptions { aovs: &aovs, ..WriteOptions::default() };
            image_file::write(&folder.path().join(name), &Picture::filled(extent, [0.0; 3]), &options).unwrap();
        }
        let [low, high] = ["low.exr", "high.exr"].map(|name| folder.path().join(name).display().to_string());
        for (argument, count) in [(format!("id.Y={low},{high}"), 24), (format!("id.Y={high}"), 60)] {
            let text = compare(folder.path(), "a.exr", "b.exr", &["--json", "--where", &argument]).unwrap().text;
            let document: serde_json::Value = serde_json::from_str(&text).unwrap();
            let pixels = ["where", "elsewhere"].map(|part| document[part]["pixels"].as_u64().unwrap());
            assert_eq!(pixels, [count, 192 - count]);
            assert_eq!(document["where"]["rmse"], 0.25);
            let text = compare(folder.path(), "a.exr", "b.exr", &["--where", &argument]).unwrap().text;
            let found = format!("where: {count} pixels, {:.2} %", count as f64 / 1.92);
            assert!(text.contains(&found), "{text}");
        }
        for (argument, cause) in [
            ("id.Y", "it has no ="),
            ("=a.exr", "it must name a channel and one EXR file or two"),
            ("id.Y=a.exr,", "it must name a channel and one EXR file or two"),
            ("id.Y=a,b,c", "it must name a channel and one EXR file or two"),
        ] {
            let error = compare(Path::new("/nowhere"), "a.exr", "b.exr", &["--where", argument]).err().unwrap();
            assert!(error.exit_code() == 2 && error.message().ends_with(cause), "{error}");
        }
        let missing = format!("depth.Y={low}");
        let error = compare(folder.path(), "a.exr", "b.exr", &["--where", &missing]).err().unwrap();
        assert!(error.exit_code() == 2 && error.message().contains("depth.Y"), "{error}");
    }

    #[test]
    fn the_difference_is_written_even_when_a_gate_fails() {
        let folder = folder();
        let diff = folder.path().join("diff.png");
        let hdr = folder.path().join("hdr.png");
        let more = ["--max", "rmse=0", "--diff", diff.to_str().unwrap(), "--hdr-diff", hdr.to_str().unwrap()];
        assert!(compare(folder.path(), "a.exr", "b.exr", &more).unwrap().gates.is_err());
        let [diff, hdr] = [diff, hdr].map(|path| image_file::read(&path).unwrap());
        assert_eq!((diff.extent, hdr.extent), (Extent::new(16, 12), Extent::new(16, 12)));
        assert_ne!(diff, hdr);
    }

    /// A wave of luminance, as an error of its own picture: two peaks in one ring, and a mean that stays apart.
    #[test]
    fn the_spectrum_of_the_error_is_drawn_written_plotted_and_told() {
        let folder = folder();
        let path = |name: &str| folder.path().join(name).display().to_string();
        let extent = Extent::new(15, 12);
        let wave = |index: u32| 0.5 + 0.1 * (std::f64::consts::TAU * f64::from(index / 15) / 4.0).cos() as f32;
        let pixels = (0..15 * 12).map(|index| [wave(index); 3]).collect();
        image_file::write(&folder.path().join("wave.exr"), &Picture { extent, pixels }, &WriteOptions::default())
            .unwrap();
        let flat = Picture::filled(extent, [0.25; 3]);
        image_file::write(&folder.path().join("flat.exr"), &flat, &WriteOptions::default()).unwrap();
        let [drawn, powers, plot] = ["s.png", "s.exr", "s.svg"].map(path);
        let more = ["--json", "--spectrum", &drawn, "--spectrum", &powers, "--spectrum", &plot];
        let text = compare(folder.path(), "wave.exr", "flat.exr", &more).unwrap().text;
        let spectrum = &serde_json::from_str::<serde_json::Value>(&text).unwrap()["spectrum"];
        assert!((spectrum["mean"].as_f64().unwrap() - 0.25).abs() < 1e-6, "{spectrum}");
        assert!((spectrum["variance"].as_f64().unwrap() - 0.005).abs() < 1e-6, "{spectrum}");
        // A wave of a quarter cycle a pixel is not slow.
        assert!(spectrum["low_energy"].as_f64().unwrap() < 1e-9, "{spectrum}");
        let rings = spectrum["rings"].as_array().unwrap();
        let loud: Vec<_> = rings.iter().filter(|ring| ring["power"].as_f64().unwrap() > 1e-6).collect();
        assert_eq!((loud.len(), &loud[0]["cycles_per_px"]), (1, &json!(0.25)), "{spectrum}");
        let sum = loud[0]["power"].as_f64().unwrap() * loud[0]["frequencies"].as_f64().unwrap();
        assert!((sum - 0.005 * 180.0).abs() < 1e-5 && loud[0]["anisotropy"].as_f64().unwrap() > 1.0, "{spectrum}");

        let powers = image_file::read(Path::new(&powers)).unwrap();
        // Frequency 0 is in the middle, the wave's three cycles are above and below it.
        let at = |x: usize, y: usize| f64::from(powers.pixels[y * 15 + x][1]);
        assert!((at(7, 6) - 0.0625 * 180.0).abs() < 1e-4 && (at(7, 3) - 0.45).abs() < 1e-5 && at(8, 3) < 1e-9);
        // Either of the two powers is 90 times the variance.
        let drawn = image_file::read(Path::new(&drawn)).unwrap();
        assert_eq!(drawn.extent, Extent::new(15 * 34, 12 * 34));
        let code = |x: usize, y: usize| drawn.pixels[(34 * y + 17) * 510 + 34 * x + 17][0];
        assert!(code(7, 3) == code(7, 9) && code(7, 3) > 0.95 && code(8, 3) == 0.0);
        assert!(std::fs::read_to_string(plot).unwrap().contains("wave.exr - "));
        let text = compare(folder.path(), "wave.exr", "flat.exr", &["--spectrum", &path("s.png")]).unwrap().text;
        assert!(text.contains("spectrum of A - B: mean 2.500e-1, kept apart; variance 5.000e-3, "), "{text}");
        assert!(compare(folder.path(), "a.exr", "a.exr", &["--spectrum", &path("same.png")]).is_ok());
    }

    #[test]
    fn a_spectrum_that_cannot_be_written_is_refused_before_a_picture_is_read() {
        for (name, cause) in
            [("s.jpg", ".svg (a plot"), ("s", ".exr (its powers)"), ("missing/s.png", "does not exist")]
        {
            let error = compare(Path::new("/nowhere"), "a.exr", "b.exr", &["--spectrum", name]).err().unwrap();
            assert!(error.exit_code() == 2 && error.message().contains(cause), "{error}");
            assert!(error.message().contains(name), "{error}");
        }
        let folder = folder();
        image_file::write(
            &folder.path().join("small.exr"),
            &Picture::filled(Extent::new(3, 3), [0.5; 3]),
            &WriteOptions::default(),
        )
        .unwrap();
        let drawn = folder.path().join("s.png");
        let more = ["--spectrum", drawn.to_str().unwrap()];
        let error = compare(folder.path(), "small.exr", "b.exr", &more).err().unwrap();
        assert!(error.exit_code() == 2 && error.message().contains("3x3") && !drawn.exists(), "{error}");
    }

    #[test]
    fn a_png_says_what_it_cuts_and_a_threshold_is_heeded() {
        let folder = folder();
        let picture = image_file::read(&folder.path().join("a.exr")).unwrap();
        image_file::write(&folder.path().join("a.png"), &picture, &WriteOptions::default()).unwrap();
        let document = |a: &str, more: &[&str]| -> serde_json::Value {
            let text = compare(folder.path(), a, "b.exr", &[&["--json"], more].concat()).unwrap().text;
            serde_json::from_str(&text).unwrap()
        };
        assert_eq!(document("a.exr", &[])["cut"], json!([]));
        assert_eq!(document("a.png", &[])["cut"], json!(Metrics::of_light()));
        let text = compare(folder.path(), "a.png", "b.exr", &[]).unwrap().text;
        assert_eq!(text.lines().filter(|line| line.ends_with("(light above 1 is cut by a PNG)")).count(), 4, "{text}");
        // The pictures are flat: every pixel is above a threshold or none.
        assert_eq!(document("a.exr", &[])["threshold"], 0.1);
        assert_eq!(document("a.exr", &["--threshold", "0"])["metrics"]["over_threshold"], 100.0);
        assert_eq!(document("a.exr", &["--threshold", "1"])["metrics"]["over_threshold"], 0.0);
    }
}
