//! Settings as reports and rows write them.

use super::Values;
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;

/// A setting's value: a number where its text is one.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum SettingValue {
    Number(serde_json::Number),
    Text(String),
}

/// Values of settings by key, in the order of `Values`.
pub type WrittenSettings = IndexMap<String, SettingValue>;

impl SettingValue {
    pub fn of(text: &str) -> Self {
        text.parse().map_or_else(|_| Self::Text(text.to_owned()), Self::Number)
    }

    /// A finite number, with its decimal point; of another its text.
    pub fn of_number(number: f64) -> Self {
        let text = || Self::Text(number.to_string());
        serde_json::Number::from_f64(number).map_or_else(text, Self::Number)
    }

    pub fn as_f64(&self) -> Option<f64> {
        match self {
            Self::Number(number) => number.as_f64(),
            Self::Text(_) => None,
        }
    }
}

impl fmt::Display for SettingValue {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => number.fmt(formatter),
            Self::Text(text) => formatter.write_str(text),
        }
    }
}

/// Every setting of `values`. `resolved`: what `auto` and percentages came to, by key.
pub fn written(values: &Values, resolved: &BTreeMap<&'static str, String>) -> WrittenSettings {
    let value = |key: &str, text: &str| SettingValue::of(resolved.get(key).map_or(text, String::as_str));
    values.iter().map(|(key, text)| (key.to_owned(), value(key, text))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_a_number_is_written_as_one_and_read_back() {
        for (text, json) in [("5", "5"), ("0.5", "0.5"), ("4x4", "\"4x4\""), ("auto", "\"auto\""), ("nan", "\"nan\"")] {
            let value = SettingValue::of(text);
            assert_eq!(serde_json::to_string(&value).unwrap(), json);
            assert_eq!(serde_json::from_str::<SettingValue>(json).unwrap(), value);
            assert_eq!(value.to_string(), text);
        }
        assert_eq!(serde_json::to_string(&SettingValue::of_number(2.0)).unwrap(), "2.0");
    }
}
