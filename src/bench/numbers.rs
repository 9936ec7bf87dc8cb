//! Numbers of a row by their names, for those who ask for them by name.

use super::row::BenchRow;

/// A number, and its 95 % interval where it has one.
pub struct Number {
    pub value: f64,
    pub interval: Option<[f64; 2]>,
}

impl Number {
    pub fn exact(value: f64) -> Self {
        Self { value, interval: None }
    }
}

/// What a row says; None where it does not have it.
pub type Read = fn(&BenchRow) -> Option<Number>;

fn bytes(bytes: u64) -> Number {
    Number::exact(bytes as f64)
}

/// Time in parts of the baseline's, milliseconds, bytes.
pub const NUMBERS: [(&str, Read); 5] = [
    ("time_ratio", |row| {
        let ratio = row.ratio.as_ref()?;
        Some(Number { value: ratio.mean, interval: ratio.interval })
    }),
    ("median_ms", |row| Some(Number::exact(row.times_ms()?.median))),
    ("planned_bytes", |row| row.planned_bytes.map(bytes)),
    ("allocated_bytes", |row| row.memory.as_ref()?.allocated_bytes.map(bytes)),
    ("peak_bytes", |row| Some(bytes(row.memory.as_ref()?.peak_bytes))),
];
