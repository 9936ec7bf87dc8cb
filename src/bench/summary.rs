//! The summary of a sweep: all its rows with the Pareto set marked, the best values, what was skipped and why.

use super::best::{self, Best};
use super::csv_file;
use super::machine::BUSY_SHARE;
use super::page::{self, Shown};
use super::pareto;
use super::rates::{self, Rate};
use super::rates_plot;
use super::row::BenchRow;
use super::stats::LEAST_PAIRS;
use super::sweep::Axis;
use super::table::{MARK, Table};
use super::what::What;
use crate::caps::Identity;
use crate::error::Result;
use crate::report::command_line::command_line;
use crate::techniques;
use crate::techniques::bench_stage::flags;
use crate::whole_file::write_whole;
use serde_json::{Value, json};
use std::io::Write;
use std::path::Path;

/// A finished sweep, or the part of it that was.
pub struct Summary {
    what: What,
    axes: Vec<Axis>,
    rows: Vec<BenchRow>,
    best: Vec<Best>,
    /// How fast errors fall with the setting of `--rate`.
    rates: Option<(String, Vec<Rate>)>,
    command: Vec<String>,
}

impl Summary {
    /// `rows`: at least one, in the order of the grid; `command`: the argv that repeats it.
    pub fn new(what: What, axes: &[Axis], mut rows: Vec<BenchRow>, command: &[String]) -> Self {
        pareto::mark(&mut rows);
        // What another stage's sweeps tell is no choice of this one's.
        let best = what.tuned().map_or_else(Vec::new, |key| best::best(key, axes, &rows));
        Self { what, axes: axes.to_vec(), rows, best, rates: None, command: command.to_vec() }
    }

    /// With how fast errors fall with `key`, one of the axes.
    pub fn with_rates(mut self, key: &str, axes: &[Axis]) -> Self {
        self.rates = Some((key.to_owned(), rates::rates(key, axes, &self.rows)));
        self
    }

    pub fn json(&self) -> Value {
        let first = &self.rows[0];
        let errors = if first.reference.is_none() { "error_against_none.rmse" } else { "errors.rmse" };
        let mut document = json!({
            "schema": 1,
            "bench": self.what.name(),
            "command": self.command,
            "device": first.device,
            "commit": first.commit,
            "scene": first.scene,
            "technique": first.technique,
            "baseline": match &self.baselines()[..] {
                [one] => json!(one),
                several => json!(several),
            },
            "repeat": first.repeat,
            "pareto_of": ["ratio.mean", errors],
            "rows": self.rows,
            "best_blocks": self.best,
        });
        if let Some((key, rates)) = &self.rates {
            document["rates"] = rates::json(key, rates);
        }
        document
    }

    /// What a terminal shows.
    pub fn text(&self) -> String {
        let mut text = format!("{}\n{}\n\n{}", self.place(), self.legend(), Table::new(self.what, &self.rows).text());
        for line in self.notes() {
            text.push_str(&line);
            text.push('\n');
        }
        text.push_str(&self.rates_text());
        text
    }

    pub fn markdown(&self) -> String {
        let title = self.heading();
        let table = Table::new(self.what, &self.rows).markdown();
        let mut text = format!("# {title}\n\n{}\n\n    {}\n\n{table}", self.legend(), command_line(&self.command));
        let notes = self.notes();
        if !notes.is_empty() {
            text.push('\n');
        }
        for line in notes {
            text.push_str(&format!("- {line}\n"));
        }
        text.push_str(&self.rates_text());
        text
    }

    fn heading(&self) -> String {
        format!("bench {}: {}", self.what.name(), self.place())
    }

    /// The page of the rows that lie in `folder`.
    ///
    /// Errors: a picture cannot be read (exit code 2).
    fn page(&self, folder: &Path) -> Result<String> {
        page::text(&Shown {
            title: &self.heading(),
            legend: &self.legend(),
            notes: &self.notes(),
            command: &self.command,
            axes: &self.axes,
            rows: &self.rows,
            folder,
        })
    }

    /// What stands behind the notes; nothing without `--rate`.
    fn rates_text(&self) -> String {
        self.rates.as_ref().map_or_else(String::new, |(key, rates)| format!("\n{}", rates::markdown(key, rates)))
    }

    /// Writes `summary.json`, `summary.md`, `rows.csv` and `index.html`, and where there are rates `rates.svg`.
    ///
    /// Errors: they cannot be written, or a picture of the rows cannot be read (exit code 2).
    pub fn write(&self, folder: &Path) -> Result<()> {
        write_whole(&folder.join("summary.json"), |out| writeln!(out, "{:#}", self.json()))?;
        write_whole(&folder.join("summary.md"), |out| out.write_all(self.markdown().as_bytes()))?;
        csv_file::write(folder, &self.rows)?;
        let page = self.page(folder)?;
        write_whole(&folder.join("index.html"), |out| out.write_all(page.as_bytes()))?;
        let Some((key, rates)) = &self.rates else { return Ok(()) };
        write_whole(&folder.join("rates.svg"), |out| out.write_all(rates_plot::svg(key, rates).as_bytes()))
    }

    fn place(&self) -> String {
        let first = &self.rows[0];
        let device = first.device.as_ref();
        let software = if device.is_some_and(Identity::is_software) { ", software driver" } else { "" };
        let (name, driver) = device.map_or(("", ""), |device| (&device.name, &device.driver_info));
        format!("{} on {name} ({driver}{software})", first.scene.name)
    }

    fn legend(&self) -> String {
        let first = &self.rows[0];
        let baselines: Vec<&str> = self.baselines().into_iter().map(|variant| self.title(variant)).collect();
        let (baseline, rounds) = (baselines.join("; "), first.repeat);
        let told = match rounds {
            few if few < LEAST_PAIRS => {
                format!("below {LEAST_PAIRS} rounds no interval is printed, and no two rows are told apart")
            }
            _ => format!("{MARK}: no row with at most its rmse is faster by the interval of their ratio"),
        };
        let errors = self.reference().map_or_else(String::new, |name| format!("errors against {name}; "));
        format!("time ratios to {baseline}, of {} rounds; {errors}{told}", self.rounds())
    }

    /// How many rounds there were: what was asked for, or, where it was left open, from how many to how many.
    fn rounds(&self) -> String {
        let first = &self.rows[0];
        let pairs = || self.rows.iter().filter_map(|row| Some(row.ratio.as_ref()?.pairs));
        match (first.until_interval, pairs().min().zip(pairs().max())) {
            (Some(_), Some((least, most))) if least < most => format!("{least} to {most}"),
            (Some(_), Some((least, _))) => least.to_string(),
            _ => first.repeat.to_string(),
        }
    }

    /// What ratios are to: one row, or one of each part of the sweep.
    fn baselines(&self) -> Vec<&str> {
        let mut names: Vec<&str> = Vec::new();
        for row in &self.rows {
            if !names.contains(&row.baseline.as_str()) {
                names.push(&row.baseline);
            }
        }
        names
    }

    /// What tables call the row of a variant.
    fn title<'a>(&'a self, variant: &'a str) -> &'a str {
        self.rows.iter().find(|row| row.variant == variant).map_or(variant, BenchRow::title)
    }

    /// What errors are against: the reference that was asked for, else the plain form of the first technique that has
    /// one.
    fn reference(&self) -> Option<String> {
        let asked = self.rows[0].reference.as_ref().map(|reference| reference.name.clone());
        let plain = |row: &BenchRow| Some(flags(techniques::find(&row.technique).ok()?.plain()?.settings));
        asked.or_else(|| self.rows.iter().find_map(plain))
    }

    fn notes(&self) -> Vec<String> {
        let skipped =
            self.rows.iter().filter_map(|row| Some(format!("skipped {}: {}", row.title(), row.skipped.as_ref()?)));
        let named = self.rows.iter().filter_map(|row| Some(format!("{}: {}", row.name.as_ref()?, row.variant)));
        let found = self.best.iter().map(Best::sentence).chain(self.untold()).chain(self.busy());
        named.chain(found).chain(skipped).collect()
    }

    /// Rows that are in the Pareto set because there were too few rounds.
    fn untold(&self) -> Option<String> {
        let pair = |row: &BenchRow| {
            let rivals = row.pareto_not_told_from.as_ref()?;
            let rivals: Vec<&str> = rivals.iter().map(|rival| self.title(rival)).collect();
            Some(format!("{} ({})", row.title(), rivals.join(", ")))
        };
        let pairs: Vec<String> = self.rows.iter().filter_map(pair).collect();
        let which = pairs.join("; ");
        (!pairs.is_empty()).then(|| {
            format!("marked because the rounds do not prove that a rival with a shorter time is faster: {which}")
        })
    }

    /// Rows whose times others have had a part in.
    fn busy(&self) -> Option<String> {
        let count = self.rows.iter().filter(|row| row.is_busy()).count();
        let all = self.rows.iter().filter(|row| row.was_measured()).count();
        let percent = 100.0 * BUSY_SHARE;
        (count > 0).then(|| {
            format!(
                "{count} of {all} rows were measured while the machine was busy: over {percent} % of its processors' time \
                 went to others; measure them again when it is not"
            )
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::machine::Load;
    use crate::bench::row::SceneName;
    use crate::bench::stats::Ratio;
    use crate::metrics::Metrics;

    fn row(variant: &str, ratio: f64, rmse: f64) -> BenchRow {
        let (name, driver_info) = ("d".to_owned(), "i".to_owned());
        let (device_type, driver, api) = ("cpu".to_owned(), String::new(), String::new());
        BenchRow {
            variant: variant.to_owned(),
            baseline: "a".to_owned(),
            repeat: 5,
            technique: "interleaved_deferred".to_owned(),
            scene: SceneName { name: "box".to_owned(), hash: String::new() },
            device: Some(Identity { name, device_type, driver, driver_info, api }),
            ratio: Some(Ratio { mean: ratio, interval: Some([0.9 * ratio, 1.1 * ratio]), pairs: 5 }),
            error_against_none: Some(Metrics { rmse, ..Metrics::EQUAL }),
            ..BenchRow::default()
        }
    }

    #[test]
    fn a_kept_row_may_say_anything() {
        let mut kept = row("a", 1e308, f64::MAX);
        kept.bytes_read = Some(u64::MAX);
        kept.bytes_written = Some(u64::MAX);
        // Longer than a column can be padded to.
        kept.variant = "x".repeat(70_000);
        let empty = BenchRow { technique: "none of these".to_owned(), ..BenchRow::default() };
        let rows = vec![kept, empty, row("b", f64::NAN, f64::NAN)];
        for what in What::all() {
            let summary = Summary::new(what, &[], rows.clone(), &[]);
            assert!(summary.text().contains("xxx") && summary.markdown().contains("xxx"));
        }
    }

    #[test]
    fn a_summary_marks_the_pareto_set_and_says_what_was_skipped() {
        let mut skipped = row("c", 0.0, 0.0);
        skipped.skipped = Some("it cannot be".to_owned());
        skipped.ratio = None;
        let rows = vec![row("a", 1.0, 0.0), row("b", 2.0, 0.0), skipped];
        let summary = Summary::new(What::Frame, &[], rows, &["quincunx".to_owned()]);
        let marks: Vec<Option<bool>> = summary.rows.iter().map(|row| row.pareto).collect();
        assert_eq!(marks, [Some(true), None, None]);
        let text = summary.text();
        assert!(text.starts_with("box on d (i, software driver)\n"), "{text}");
        assert!(text.contains("skipped c: it cannot be") && !text.contains("busy"), "{text}");
        let lines: Vec<&str> = text.lines().filter(|line| line.ends_with(MARK)).collect();
        assert!(lines.len() == 1 && lines[0].starts_with("a "), "{text}");
        assert!(summary.markdown().contains("| variant | median ms |"), "{}", summary.markdown());
        assert_eq!(summary.json()["rows"].as_array().unwrap().len(), 3);
    }

    #[test]
    fn a_row_is_called_by_its_name_and_the_name_is_told() {
        let named = |row: BenchRow, name: &str| BenchRow { name: Some(name.to_owned()), ..row };
        let skipped = BenchRow { skipped: Some("it cannot be".to_owned()), ratio: None, ..row("c=3", 0.0, 0.0) };
        let rows =
            vec![named(row("a", 1.0, 0.0), "first"), named(row("b=2", 1.05, 0.1), "other"), named(skipped, "last")];
        let summary = Summary::new(What::Frame, &[], rows, &[]);
        let text = summary.text();
        assert!(text.contains("time ratios to first, of 5 rounds"), "{text}");
        assert!(text.contains("\nother: b=2\n") && text.contains("skipped last: it cannot be"), "{text}");
        assert!(text.contains("is faster: other (first)"), "{text}");
        let lines: Vec<&str> = text.lines().filter(|line| line.starts_with("other  ")).collect();
        assert!(lines.len() == 1 && !lines[0].contains("b=2"), "{text}");
        // What other programs look rows up by stays what is measured.
        let json = summary.json();
        assert_eq!((&json["baseline"], &json["rows"][1]["variant"]), (&json!("a"), &json!("b=2")));
        assert_eq!(
            (&json["rows"][1]["name"], &json["rows"][1]["pareto_not_told_from"]),
            (&json!("other"), &json!(["a"]))
        );
    }

    #[test]
    fn two_rounds_tell_nothing_and_say_so() {
        let few = |mut row: BenchRow| {
            row.repeat = 2;
            row.ratio.as_mut().unwrap().interval = None;
            row
        };
        let summary = Summary::new(What::Frame, &[], vec![few(row("a", 1.0, 0.0)), few(row("b", 2.0, 0.0))], &[]);
        let text = summary.text();
        assert!(text.contains("below 3 rounds no interval is printed, and no two rows are told apart"), "{text}");
        assert!(text.lines().all(|line| !line.ends_with(MARK)), "{text}");
    }

    #[test]
    fn rows_of_a_busy_machine_are_marked_and_counted() {
        let mut busy = row("a", 1.0, 0.0);
        busy.machine = Some(Some(Load { other_cpu_share: 0.2, steal_share: 0.0, busy: true }));
        let text = Summary::new(What::Stage("shade"), &[], vec![busy, row("b", 2.0, 0.0)], &[]).text();
        assert!(text.contains("1 of 2 rows were measured while the machine was busy: over 5 %"), "{text}");
        let lines: Vec<&str> = text.lines().filter(|line| line.ends_with("  busy")).collect();
        assert!(lines.len() == 1 && lines[0].starts_with("a "), "{text}");
    }

    #[test]
    fn rows_that_rounds_do_not_tell_apart_are_named() {
        let text = Summary::new(What::Frame, &[], vec![row("a", 1.0, 0.0), row("b", 1.05, 0.1)], &[]).text();
        assert!(
            text.contains("marked because the rounds do not prove that a rival with a shorter time is faster: b (a)"),
            "{text}"
        );
    }
}
