//! A grid of settings: `--sweep KEY=V,V,...`, each axis given once, all combinations.

use crate::error::{Error, Result};

/// One axis of the grid.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Axis {
    pub key: String,
    pub values: Vec<String>,
}

/// A combination: a value for each axis, in the axes' order.
pub type Point = Vec<(String, String)>;

/// Reads `KEY=V,V,...`.
///
/// Errors: no key, no value, or a key given twice (exit code 2).
pub fn axes(texts: &[String]) -> Result<Vec<Axis>> {
    let mut axes: Vec<Axis> = Vec::new();
    for text in texts {
        let wrong = |why: &str| {
            Error::request(format!("--sweep {text}: {why}")).note("for example --sweep pattern=2x2,4x4,8x8")
        };
        let (key, values) = text.split_once('=').ok_or_else(|| wrong("it must be KEY=VALUE,VALUE,..."))?;
        let key = key.trim_start_matches("--");
        let values: Vec<String> = values.split(',').map(str::to_owned).collect();
        if key.is_empty() || values.iter().any(String::is_empty) {
            return Err(wrong("a key or a value is empty"));
        }
        if axes.iter().any(|axis| axis.key == key) {
            return Err(wrong("this key is swept already"));
        }
        axes.push(Axis { key: key.to_owned(), values });
    }
    Ok(axes)
}

/// Every combination, the last axis changing fastest; one empty point without axes.
pub fn grid(axes: &[Axis]) -> Vec<Point> {
    axes.iter().fold(vec![Vec::new()], |points, axis| {
        points
            .iter()
            .flat_map(|point| {
                axis.values.iter().map(move |value| {
                    let mut longer = point.clone();
                    longer.push((axis.key.clone(), value.clone()));
                    longer
                })
            })
            .collect()
    })
}

/// `key=value key=value`, for tables; `defaults` without axes.
pub fn label(point: &Point) -> String {
    if point.is_empty() {
        return "defaults".to_owned();
    }
    point.iter().map(|(key, value)| format!("{key}={value}")).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grid_holds_every_combination_once() {
        let axes = axes(&["split=none,one-pass".to_owned(), "--kernel=5,7,9".to_owned()]).unwrap();
        let labels: Vec<String> = grid(&axes).iter().map(label).collect();
        assert_eq!(labels.len(), 6);
        assert_eq!((labels[0].as_str(), labels[5].as_str()), ("split=none kernel=5", "split=one-pass kernel=9"));
        assert_eq!(grid(&[]), vec![Vec::new()]);
    }

    #[test]
    fn a_broken_axis_is_refused() {
        for text in ["split", "=1", "split=", "split=a,,b"] {
            assert_eq!(axes(&[text.to_owned()]).unwrap_err().exit_code(), 2, "{text}");
        }
        assert!(axes(&["a=1".to_owned(), "a=2".to_owned()]).is_err());
    }
}
