//! What the steps of a recipe have left: rows, documents, and why there are none.

use super::recipe::{FigureKind, Number, Source};
use crate::bench::row::BenchRow;
use serde_json::Value;
use std::collections::BTreeMap;
use std::time::SystemTime;

/// Why a step that `--only` leaves out has left nothing.
pub const NOT_ASKED_FOR: &str = "it was not asked for";

/// What one step has left.
#[derive(Debug)]
pub enum Left {
    Rows(Vec<BenchRow>),
    Document(Value),
    /// Why it has left nothing, and its exit code; None where it was ended from outside.
    Nothing {
        reason: String,
        exit_code: Option<i32>,
    },
}

/// By the names of the steps.
#[derive(Default)]
pub struct Found {
    pub steps: BTreeMap<String, Left>,
    /// When the last of their results was written; None where there are none.
    pub latest: Option<SystemTime>,
}

impl Found {
    /// The number that `source` names.
    ///
    /// Errors: why there is none.
    pub fn number(&self, source: &Source) -> Result<Number, String> {
        match source {
            Source::Computed(value) => Ok(Number::exact(*value)),
            Source::Row { step, variant, figure } => {
                let row = self.row(step, variant)?;
                if let Some(reason) = &row.skipped {
                    return Err(reason.clone());
                }
                (figure.read)(row).ok_or_else(|| format!("the row {variant} of {step} does not have it"))
            }
            Source::Rows { step, read, otherwise } => match self.left(step)? {
                Left::Rows(rows) => {
                    let measured: Vec<&BenchRow> = rows.iter().filter(|row| row.was_measured()).collect();
                    read(&measured).ok_or_else(|| (*otherwise).to_owned())
                }
                _ => Err(format!("{step} leaves no rows")),
            },
            Source::Document { step, read } => match self.left(step)? {
                Left::Document(document) => {
                    let value = read(document).map(Number::exact);
                    value.ok_or_else(|| format!("what {step} leaves does not have it"))
                }
                _ => Err(format!("{step} leaves rows, and no document")),
            },
            Source::Combined { parts, combine } => {
                let parts: Vec<f64> =
                    parts.iter().map(|part| Ok(self.number(part)?.value)).collect::<Result<_, String>>()?;
                Ok(Number::exact(combine(&parts)))
            }
        }
    }

    /// `number` of `part`, in parts of `whole`: the paired ratio of their rows where they have one.
    ///
    /// Errors: why there is none.
    pub fn part(&self, part: &Source, whole: &Source) -> Result<Number, String> {
        if let Some(paired) = self.paired(part, whole) {
            return Ok(paired);
        }
        let (part, whole) = (self.number(part)?, self.number(whole)?);
        Ok(Number::exact(part.value / whole.value))
    }

    /// The ratio that a row has to its baseline, where that is `whole`.
    fn paired(&self, part: &Source, whole: &Source) -> Option<Number> {
        let (
            Source::Row { step, variant, figure },
            Source::Row { step: whole_step, variant: whole_variant, figure: of },
        ) = (part, whole)
        else {
            return None;
        };
        let row = self.row(step, variant).ok()?;
        if step != whole_step || *whole_variant != row.baseline || figure.kind != of.kind {
            return None;
        }
        let ratio = row.ratio.as_ref()?;
        let number = Number { value: ratio.mean, bounds: ratio.interval };
        match figure.kind {
            FigureKind::Time => Some(number),
            FigureKind::Rate => Some(number.divides(1.0)),
            FigureKind::Other => None,
        }
    }

    fn left(&self, step: &str) -> Result<&Left, String> {
        match self.steps.get(step) {
            Some(Left::Nothing { reason, .. }) => Err(reason.clone()),
            Some(left) => Ok(left),
            None => Err(NOT_ASKED_FOR.to_owned()),
        }
    }

    /// The row of `variant` that was measured last.
    fn row(&self, step: &str, variant: &str) -> Result<&BenchRow, String> {
        match self.left(step)? {
            Left::Rows(rows) => {
                let row = rows.iter().rev().find(|row| row.variant == variant);
                row.ok_or_else(|| format!("{step} has no row {variant}"))
            }
            _ => Err(format!("{step} leaves no rows")),
        }
    }
}
