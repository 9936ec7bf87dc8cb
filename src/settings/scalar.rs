//! A setting's value in a file of TOML: a number, a switch or a text, as its flag has it.

use serde::Deserialize;
use std::fmt;

#[derive(Deserialize)]
#[serde(untagged)]
pub enum Scalar {
    Switch(bool),
    Integer(i64),
    Number(f64),
    Text(String),
}

impl fmt::Display for Scalar {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Switch(is_on) => f.write_str(if *is_on { "on" } else { "off" }),
            Self::Integer(number) => number.fmt(f),
            Self::Number(number) => number.fmt(f),
            Self::Text(text) => text.fmt(f),
        }
    }
}
