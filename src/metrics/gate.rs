//! Gates: bounds on an error, for scripts. One that fails is the exit code 1 of the command.

use super::measure::{Measure, Metrics, or_infinity};
use crate::error::{Error, Result};
use serde::{Deserialize, Serialize};
use std::fmt::Display;

/// Which side of its value a gate lets pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Bound {
    Max,
    Min,
}

impl Bound {
    /// The flag without its dashes.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Max => "max",
            Self::Min => "min",
        }
    }
}

/// A bound on one metric.
#[derive(Clone, Copy, Debug)]
pub struct Gate {
    measure: &'static Measure,
    bound: Bound,
    value: f64,
}

impl Gate {
    /// `argument`: `METRIC=VALUE`; `flag`: what it was typed behind, without its dashes.
    ///
    /// Errors: no such metric, or no number (exit code 2).
    pub fn parse(flag: &str, bound: Bound, argument: &str) -> Result<Self> {
        let refused = |cause: &str| {
            let names = Metrics::NAMES.join(", ");
            Error::request(format!("--{flag} {argument}: {cause}"))
                .note(format!("for example --{flag} rmse=0.01; the metrics are {names}"))
        };
        let (name, value) = argument.split_once('=').ok_or_else(|| refused("it has no ="))?;
        let measure = Measure::named(name).ok_or_else(|| refused(&format!("there is no metric {name}")))?;
        match value.parse::<f64>() {
            Ok(value) if !value.is_nan() => Ok(Self { measure, bound, value }),
            _ => Err(refused(&format!("{value} is not a number"))),
        }
    }

    /// The metric's.
    pub fn name(&self) -> &'static str {
        self.measure.name
    }

    /// What is allowed.
    pub fn value(&self) -> f64 {
        self.value
    }

    /// What it is.
    pub fn measured(&self, metrics: &Metrics) -> f64 {
        (self.measure.value)(metrics)
    }

    fn passes(&self, metrics: &Metrics) -> bool {
        match self.bound {
            Bound::Max => self.measured(metrics) <= self.value,
            Bound::Min => self.measured(metrics) >= self.value,
        }
    }

    /// What a person reads: the gate and its verdict.
    pub fn text(&self, metrics: &Metrics) -> String {
        let verdict = if self.passes(metrics) { "passed" } else { "failed" };
        format!("--{} {}={}: {verdict}", self.bound.name(), self.measure.name, self.value)
    }

    /// What a program reads.
    pub fn verdict(&self, metrics: &Metrics) -> Verdict {
        Verdict {
            metric: self.measure.name.to_owned(),
            bound: self.bound.name().to_owned(),
            value: self.value,
            measured: self.measured(metrics),
            passed: self.passes(metrics),
        }
    }
}

/// A gate and whether it holds, as reports write it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    /// One of `Metrics::NAMES`.
    pub metric: String,
    /// `max` or `min`.
    pub bound: String,
    /// What is allowed, in the metric's unit; infinity is null under serde.
    #[serde(deserialize_with = "or_infinity")]
    pub value: f64,
    /// What it is, in the metric's unit; infinity is null under serde.
    #[serde(deserialize_with = "or_infinity")]
    pub measured: f64,
    pub passed: bool,
}

/// Errors: a gate fails (exit code 1), the first of `gates`. `context`: what was compared.
pub fn judge(gates: &[Gate], metrics: &Metrics, context: impl Display) -> Result<()> {
    let Some(gate) = gates.iter().find(|gate| !gate.passes(metrics)) else { return Ok(()) };
    let side = if gate.bound == Bound::Max { "above" } else { "below" };
    let (name, measured) = (gate.measure.name, gate.measured(metrics));
    Err(Error::gate(format!("{context}: {name} is {measured}, {side} --{} {}", gate.bound.name(), gate.value)))
}
