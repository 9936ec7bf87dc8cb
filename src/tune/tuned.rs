//! What a search has found: the chosen settings, what each of them is worth, and how they were found; as text, as JSON, as a preset.

use super::halving::Rung;
use super::judge::{is_near, words};
use super::request::Request;
use super::search::Found;
use super::shown::{Counts, Shown};
use crate::bench::row::BenchRow;
use crate::bench::sweep::{Point, label};
use crate::bench::table::{self, Table};
use crate::error::{Error, Result};
use crate::metrics::gate::Gate;
use crate::preset;
use crate::report::command_line::command_line;
use crate::settings::written::{SettingValue, WrittenSettings};
use crate::techniques::Technique;
use indexmap::IndexMap;
use serde_json::{Value, json};
use std::path::Path;
use std::time::Duration;

/// What a row of the last measurement says beside the chosen one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Verdict {
    Chosen,
    /// Other words for the chosen settings, such as `auto` for what that comes to.
    Same,
    Slower,
    Faster,
    NotToldApart,
    TooFar,
    Skipped,
}

impl Verdict {
    fn words(self) -> &'static str {
        match self {
            Self::Chosen => "chosen",
            Self::Same => "the same settings",
            Self::Slower => "slower",
            Self::Faster => "faster",
            Self::NotToldApart => "not told apart",
            Self::TooFar => "too far off",
            Self::Skipped => "not possible",
        }
    }
}

/// The result.
pub struct Tuned {
    technique: &'static dyn Technique,
    command: Vec<String>,
    bounds: Vec<Gate>,
    counts: Counts,
    shown: Vec<Shown>,
    rungs: Vec<Rung>,
    /// Those of the last measurement, the request's own settings first.
    rows: Vec<BenchRow>,
    chosen: Point,
    /// How often a neighbour took the place of the fastest.
    moves: usize,
    time: Duration,
}

/// Whether a row is within the bounds.
fn row_is_near(row: &BenchRow, bounds: &[Gate]) -> bool {
    row.best_known_errors().is_some_and(|errors| is_near(bounds, errors))
}

/// A row takes the place of the fastest where its mean is below this, if the interval does not tell.
const NOTICEABLE: f64 = 0.97;

/// The fastest of the rows that are near enough, where it is faster than the baseline by its whole interval, or by some percent on
/// average.
pub(super) fn faster<'a>(rows: impl Iterator<Item = &'a BenchRow>, bounds: &[Gate]) -> Option<&'a BenchRow> {
    let mean = |row: &BenchRow| row.ratio.as_ref().map_or(f64::INFINITY, |ratio| ratio.mean);
    let is_told = |row: &BenchRow| row.interval().is_some_and(|[_, high]| high < 1.0);
    let faster = rows.filter(|row| (mean(row) < NOTICEABLE || is_told(row)) && row_is_near(row, bounds));
    faster.min_by(|a, b| mean(a).total_cmp(&mean(b)))
}

impl Tuned {
    /// Errors: the chosen settings could not be measured (exit code 2).
    pub(super) fn new(
        request: &Request<'_>,
        found: Found,
        rows: Vec<BenchRow>,
        chosen: usize,
        moves: usize,
        time: Duration,
    ) -> Result<Self> {
        let Found { space, counts, shown, rungs, .. } = found;
        let chosen = space.points[chosen].clone();
        let named = label(&chosen);
        match rows.iter().find(|row| row.variant == named) {
            Some(row) if row.was_measured() => {}
            row => {
                let why = row.and_then(|row| row.skipped.as_deref()).unwrap_or("it has no row");
                return Err(Error::request(format!("{named} was fastest and cannot be measured again: {why}")));
            }
        }
        Ok(Self {
            technique: request.job.technique,
            command: request.job.command.clone(),
            bounds: request.bounds.to_vec(),
            counts,
            shown,
            rungs,
            rows,
            chosen,
            moves,
            time,
        })
    }

    /// Those of the last measurement.
    pub fn rows(&self) -> &[BenchRow] {
        &self.rows
    }

    fn row(&self) -> &BenchRow {
        let named = label(&self.chosen);
        self.rows.iter().find(|row| row.variant == named).expect("`new` has looked for it")
    }

    /// The row of the request's own settings; None where they could not be measured.
    fn asked(&self) -> Option<&BenchRow> {
        let named = label(&Point::new());
        self.rows.iter().find(|row| row.variant == named && row.was_measured())
    }

    fn verdict(&self, row: &BenchRow) -> Verdict {
        match row.interval() {
            _ if row.variant == self.row().variant => Verdict::Chosen,
            _ if !row.was_measured() => Verdict::Skipped,
            _ if row.settings == self.row().settings => Verdict::Same,
            _ if !row_is_near(row, &self.bounds) => Verdict::TooFar,
            Some([low, _]) if low > 1.0 => Verdict::Slower,
            Some([_, high]) if high < 1.0 => Verdict::Faster,
            _ => Verdict::NotToldApart,
        }
    }

    /// What a row has that the chosen one does not.
    fn difference(&self, row: &BenchRow) -> String {
        let chosen = self.chosen.iter().map(|(key, text)| format!("{key}={text}")).collect::<Vec<_>>();
        let own: Vec<&str> = row.variant.split(' ').filter(|pair| !chosen.iter().any(|known| known == pair)).collect();
        match (row.variant == label(&Point::new()), own.is_empty()) {
            (true, _) => "the settings as asked".to_owned(),
            (_, true) => label(&self.chosen),
            _ => own.join(" "),
        }
    }

    fn errors_of(&self, row: &BenchRow) -> String {
        row.best_known_errors().map(|errors| words(&self.bounds, errors)).unwrap_or_default()
    }

    /// What a person reads.
    pub fn text(&self) -> String {
        let Counts { combinations, candidates, near_candidates, measured, search_frames, sweep_frames, .. } =
            self.counts;
        let mut text = format!(
            "{combinations} combinations, {candidates} that differ, {near_candidates} with pictures near enough, {measured} \
             measured: {search_frames} frames, where a sweep takes {sweep_frames}\n\n"
        );
        let cells = |cells: &[&str]| cells.iter().map(|cell| (*cell).to_owned()).collect::<Vec<String>>();
        let mut lines = vec![cells(&["picture", "error", "near enough"])];
        lines.extend(self.shown.iter().map(|shown| {
            let errors = shown.errors.map_or_else(|| "not made".to_owned(), |errors| words(&self.bounds, &errors));
            cells(&[&shown.settings, &errors, if shown.is_near { "yes" } else { "no" }])
        }));
        text += &format!("{}\n", Table::of_lines(lines).text());
        let mut lines =
            vec![cells(&["rung", "candidates", "rounds", "go on", "time of the fastest, in parts of those as asked"])];
        lines.extend(self.rungs.iter().enumerate().map(|(index, rung)| {
            let numbers = [index + 1, rung.candidates, rung.rounds, rung.kept].map(|number| number.to_string());
            numbers.into_iter().chain([format!("{:.3}", rung.best_ratio)]).collect()
        }));
        text += &format!("{}\n", Table::of_lines(lines).text());
        let mut lines = vec![cells(&["changed", "time, in parts of the chosen", "error", "verdict"])];
        lines.extend(self.rows.iter().map(|row| {
            let ratio = row.ratio.as_ref().map(table::ratio).unwrap_or_default();
            cells(&[&self.difference(row), &ratio, &self.errors_of(row), self.verdict(row).words()])
        }));
        text += &format!("{}\n", Table::of_lines(lines).text());
        text += &format!("chosen: {}\n", label(&self.chosen));
        if let Some(asked) = self.asked() {
            let ratio = asked.speed_up.as_ref().map(|speed_up| table::ratio(&speed_up.ratio)).unwrap_or_default();
            let verdict = self.verdict(asked);
            if matches!(verdict, Verdict::Chosen | Verdict::Same) {
                text += "these are the settings as asked: keep them\n";
            } else {
                text += &format!("its time is {ratio} of that of the settings as asked\n");
            }
            if verdict == Verdict::Faster {
                text += "the settings as asked are faster than all that were searched: keep them\n";
            }
        }
        text
    }

    /// What a program reads.
    pub fn json(&self) -> Value {
        let row = self.row();
        let bound = |bound: &Gate| json!({ "metric": bound.name(), "below": bound.value() });
        let beside = |row: &BenchRow| {
            json!({
                "settings": row.variant,
                "changed": self.difference(row),
                "ratio": row.ratio,
                "errors": row.best_known_errors(),
                "verdict": self.verdict(row).words(),
            })
        };
        json!({
            "schema": 1,
            "command": self.command,
            "commit": row.commit,
            "device": row.device,
            "scene": row.scene,
            "technique": row.technique,
            "bounds": self.bounds.iter().map(bound).collect::<Vec<_>>(),
            "time_s": self.time.as_secs_f64(),
            "counts": self.counts,
            "pictures": self.shown,
            "rungs": self.rungs,
            "moves": self.moves,
            "chosen": {
                "settings": self.settings(),
                "ratio_to_asked": self.asked().and_then(|asked| asked.speed_up.as_ref()).map(|speed_up| &speed_up.ratio),
                "errors": row.best_known_errors(),
                "planned_bytes": row.planned_bytes,
            },
            "beside": self.rows.iter().map(beside).collect::<Vec<_>>(),
        })
    }

    fn settings(&self) -> WrittenSettings {
        self.chosen.iter().map(|(key, text)| (key.clone(), SettingValue::of(text))).collect()
    }

    /// Writes the chosen settings, for `--preset`.
    ///
    /// Errors: the file cannot be written (exit code 2).
    pub fn write_preset(&self, path: &Path) -> Result<()> {
        let row = self.row();
        let mut tuned: IndexMap<String, toml::Value> = IndexMap::new();
        let mut say = |key: &str, value: toml::Value| tuned.insert(key.to_owned(), value);
        say("command", command_line(&self.command).into());
        say("scene", row.scene.name.clone().into());
        say("device", row.device.as_ref().map(|device| device.name.clone()).unwrap_or_default().into());
        say("commit", row.commit.clone().into());
        if let Some(speed_up) = self.asked().and_then(|asked| asked.speed_up.as_ref()) {
            say("time-ratio", speed_up.ratio.mean.into());
        }
        if let Some(errors) = row.best_known_errors() {
            for bound in &self.bounds {
                say(bound.name(), bound.measured(errors).into());
            }
        }
        preset::write(path, self.technique, &self.settings(), &tuned)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::stats::Ratio;
    use crate::metrics::Metrics;
    use crate::metrics::gate::Bound;

    fn row(variant: &str, mean: f64, interval: [f64; 2], flip: f64) -> BenchRow {
        BenchRow {
            variant: variant.to_owned(),
            ratio: Some(Ratio { mean, interval: Some(interval), pairs: 10 }),
            error_against_none: Some(Metrics { flip, ..Metrics::EQUAL }),
            ..BenchRow::default()
        }
    }

    #[test]
    fn a_row_is_faster_where_rounds_tell_or_by_some_percent_and_where_it_is_near() {
        let bounds = [Gate::parse("error-below", Bound::Max, "flip=0.1").unwrap()];
        let found = |rows: &[BenchRow]| faster(rows.iter(), &bounds).map(|row| row.variant.clone());
        let chosen = row("chosen", 1.0, [1.0, 1.0], 0.05);
        let untold = row("untold", 0.98, [0.9, 1.06], 0.05);
        assert_eq!(found(&[chosen.clone(), untold.clone()]), None);
        let told = row("told", 0.99, [0.985, 0.995], 0.05);
        assert_eq!(found(&[chosen.clone(), untold.clone(), told.clone()]).unwrap(), "told");
        let mean = row("mean", 0.9, [0.7, 1.1], 0.05);
        let far = row("far", 0.5, [0.4, 0.6], 0.2);
        assert_eq!(found(&[chosen, untold, told, mean, far]).unwrap(), "mean");
    }
}
