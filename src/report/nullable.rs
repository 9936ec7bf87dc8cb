//! What JSON says of numbers that are none, and of keys that are there without a value.
//!
//! A key that a document may lack and that may also be null is an `Option<Option<T>>`: None where the key is not there,
//! `Some(None)` where it is null.

use serde::{Deserialize, Deserializer};

/// A value or null of a key that is there; for `#[serde(default, deserialize_with)]`.
pub fn present<'de, T, D>(deserializer: D) -> Result<Option<Option<T>>, D::Error>
where
    T: Deserialize<'de>,
    D: Deserializer<'de>,
{
    Option::deserialize(deserializer).map(Some)
}

/// A number that JSON has as null where it is not finite, such as a ratio to no time at all; NaN then.
pub fn or_nan<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(deserializer)?.unwrap_or(f64::NAN))
}

/// The same of an interval.
pub fn interval<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<[f64; 2]>, D::Error> {
    let ends: Option<[Option<f64>; 2]> = Option::deserialize(deserializer)?;
    Ok(ends.map(|ends| ends.map(|end| end.unwrap_or(f64::NAN))))
}
