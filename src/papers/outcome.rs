//! A reproduction as it came out: what the paper prints, what we found, and what may be laid side by side.
//!
//! The structs' fields are the keys of `result.json`.

use super::digits::digits;
use super::found::{Found, Left, NOT_ASKED_FOR};
use super::item::{Item, Paper, Published, Scale, Verdict};
use super::recipe::{Cell, Number, Recipe, Source};
use super::request::Request;
use crate::error::{Error, Result};
use serde::Serialize;
use serde_json::Value;

/// Number of the set of keys.
pub const SCHEMA: u32 = 1;

#[derive(Clone, Debug, Serialize)]
pub struct Outcome {
    pub schema: u32,
    /// `segovia-2006`.
    pub paper: String,
    pub citation: String,
    /// `table-1`.
    pub item: String,
    pub title: String,
    pub place: String,
    /// Its name and its reason.
    pub verdict: String,
    pub reason: String,
    /// Commit of the program.
    pub commit: String,
    /// Year, month and day (UTC) on which the last step ended; today's where there are no steps.
    pub date: String,
    /// As the first step that ran on one has it; None where none did.
    pub device: Option<Value>,
    pub effort: String,
    /// In place of the item's own.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub scene: Option<String>,
    pub tables: Vec<TableOutcome>,
    pub pictures: Vec<PictureOutcome>,
    pub steps: Vec<StepOutcome>,
}

#[derive(Clone, Debug, Serialize)]
pub struct TableOutcome {
    pub title: String,
    pub unit: String,
    /// What parts are parts of; None where numbers stand for themselves.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub parts_of: Option<String>,
    pub cells: Vec<CellOutcome>,
}

/// One number of the paper, of ours, or of both.
#[derive(Clone, Debug, Serialize)]
pub struct CellOutcome {
    pub row: String,
    pub column: String,
    pub published: Option<f64>,
    pub ours: Option<Number>,
    /// The published number in parts of the table's whole.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub published_part: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub our_part: Option<Number>,
    /// Ours in parts of the published: of the parts, where there are parts.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ratio: Option<Number>,
    /// Why there is no number of ours that a recipe asks for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub missing: Option<String>,
}

#[derive(Clone, Debug, Serialize)]
pub struct PictureOutcome {
    pub title: String,
    /// In the item's folder.
    pub file: String,
}

#[derive(Clone, Debug, Serialize)]
pub struct StepOutcome {
    pub name: String,
    /// What repeats it, a word an entry, without the program.
    pub command: Vec<String>,
    /// Why it has left nothing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub failed: Option<String>,
    /// A failed command's; None where it was ended from outside.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub exit_code: Option<i32>,
}

impl Outcome {
    /// The first step that failed, with the exit code that it had.
    pub fn error(&self) -> Option<Error> {
        let step = self.steps.iter().find(|step| step.failed.is_some())?;
        let message = format!("{}/{}, step {}: {}", self.paper, self.item, step.name, step.failed.as_ref()?);
        Some(match step.exit_code {
            Some(1) => Error::gate(message),
            Some(2) => Error::request(message),
            Some(3) => Error::no_device(message),
            _ => Error::device(message),
        })
    }

    /// Errors: there is no ratio of ours to the published, or one is below `least` (exit code 1).
    pub fn require_ratios(&self, least: f64) -> Result<()> {
        let cells = self.tables.iter().flat_map(|table| &table.cells);
        let ratios: Vec<_> = cells.filter_map(|cell| Some((cell, cell.ratio?.value))).collect();
        if ratios.is_empty() {
            return Err(Error::gate(format!("{}/{}: --min-ratio {least}: it has no ratio", self.paper, self.item)));
        }
        let too_small = ratios.into_iter().filter(|(_, ratio)| *ratio < least);
        let lines: Vec<String> =
            too_small.map(|(cell, ratio)| format!("{}, {}: {}", cell.row, cell.column, digits(ratio))).collect();
        if lines.is_empty() {
            return Ok(());
        }
        let error =
            Error::gate(format!("{}/{}: --min-ratio {least}: {} ratios are less", self.paper, self.item, lines.len()));
        Err(lines.into_iter().fold(error, Error::note))
    }
}

/// Lays side by side what `found` has of `recipe` and what the item publishes.
pub fn outcome(paper: &Paper, item: &Item, recipe: &Recipe, found: &Found, request: &Request, commit: &str) -> Outcome {
    let tables = item.published.iter().enumerate();
    let failed = |name: &str| match found.steps.get(name) {
        Some(Left::Nothing { reason, exit_code }) => (Some(reason.clone()), *exit_code),
        _ => (None, None),
    };
    Outcome {
        schema: SCHEMA,
        paper: paper.name.to_owned(),
        citation: format!("{}: {}, {}", paper.authors, paper.title, paper.venue),
        item: item.name.to_owned(),
        title: item.title.to_owned(),
        place: item.place.to_owned(),
        verdict: item.verdict.name().to_owned(),
        reason: item.verdict.reason().to_owned(),
        commit: commit.to_owned(),
        date: date(found),
        device: recipe.steps.iter().find_map(|step| device(found.steps.get(&step.name)?)),
        effort: request.effort.name().to_owned(),
        scene: request.scene.clone(),
        tables: tables.map(|(index, published)| table(index, published, item, recipe, found)).collect(),
        pictures: recipe
            .pictures
            .iter()
            .filter(|picture| request.folder.join(&picture.file).is_file())
            .map(|picture| PictureOutcome { title: picture.title.clone(), file: picture.file.clone() })
            .collect(),
        steps: recipe
            .steps
            .iter()
            .map(|step| {
                let (failed, exit_code) = failed(&step.name);
                let command = step.command(request);
                StepOutcome { name: step.name.clone(), command, failed, exit_code }
            })
            .collect(),
    }
}

fn date(found: &Found) -> String {
    let written = found.latest.and_then(|time| jiff::Timestamp::try_from(time).ok());
    written.unwrap_or_else(jiff::Timestamp::now).strftime("%Y-%m-%d").to_string()
}

fn device(left: &Left) -> Option<Value> {
    match left {
        Left::Rows(rows) => serde_json::to_value(rows.iter().find_map(|row| row.device.as_ref())?).ok(),
        Left::Document(document) => document.get("device").filter(|device| device.is_object()).cloned(),
        Left::Nothing { .. } => None,
    }
}

/// Rows and columns in the paper's order, then our own.
fn table(index: usize, published: &Published, item: &Item, recipe: &Recipe, found: &Found) -> TableOutcome {
    let own: Vec<&Cell> = recipe.cells.iter().filter(|cell| cell.table == index).collect();
    let source = |row: &str, column: &str| {
        own.iter().find(|cell| cell.row == row && cell.column == column).map(|cell| &cell.source)
    };
    let mut rows: Vec<&str> = published.rows.iter().map(|(name, _)| *name).collect();
    let mut columns: Vec<&str> = published.columns.to_vec();
    for cell in &own {
        if !rows.contains(&cell.row.as_str()) {
            rows.push(&cell.row);
        }
        if !columns.contains(&cell.column.as_str()) {
            columns.push(&cell.column);
        }
    }
    let places = rows.iter().flat_map(|row| columns.iter().map(move |column| (*row, *column)));
    let cells = places.filter_map(|(row, column)| {
        let (number, own) = (published.number(row, column), source(row, column));
        if number.is_none() && own.is_none() {
            return None;
        }
        let whole = published.whole_of(row, column);
        let whole_source = whole.and_then(|(row, column)| source(row, column));
        let whole_number = whole.and_then(|(row, column)| published.number(row, column));
        Some(cell((row, column), (number, whole_number), (own, whole_source), (published.scale, item.verdict), found))
    });
    let parts_of = match published.scale {
        Scale::PartsOfRow(whole) | Scale::PartsOfColumn(whole) => Some(whole.to_owned()),
        Scale::Itself | Scale::ItsMachine => None,
    };
    TableOutcome {
        title: published.title.to_owned(),
        unit: published.unit.to_owned(),
        parts_of,
        cells: cells.collect(),
    }
}

/// A number and its whole, of the paper and of ours.
fn cell(
    (row, column): (&str, &str),
    (published, published_whole): (Option<f64>, Option<f64>),
    (own, own_whole): (Option<&Source>, Option<&Source>),
    (scale, verdict): (Scale, Verdict),
    found: &Found,
) -> CellOutcome {
    let finite = |number: Result<Number, String>| match number {
        Ok(number) if !number.value.is_finite() => Err("it is no finite number".to_owned()),
        number => number,
    };
    let ours = own.map(|source| finite(found.number(source)));
    let published_part = published.zip(published_whole).map(|(part, whole)| part / whole);
    let our_part = own.zip(own_whole).and_then(|(part, whole)| finite(found.part(part, whole)).ok());
    let missing = ours.as_ref().and_then(|ours| ours.as_ref().err().cloned()).filter(|why| why != NOT_ASKED_FOR);
    let ours = ours.and_then(Result::ok);
    let ratio = match (scale, verdict) {
        (_, Verdict::NotHere(_)) | (Scale::ItsMachine, _) => None,
        (Scale::Itself, _) => ours.zip(published),
        (Scale::PartsOfRow(_) | Scale::PartsOfColumn(_), _) => our_part.zip(published_part),
    };
    CellOutcome {
        row: row.to_owned(),
        column: column.to_owned(),
        published,
        ours,
        published_part,
        our_part,
        ratio: ratio.filter(|(_, theirs)| *theirs != 0.0).map(|(ours, theirs)| ours.times(1.0 / theirs)),
        missing,
    }
}
