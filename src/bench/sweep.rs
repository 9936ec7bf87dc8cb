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
            Error::request(format!("--sweep {text}: {why}")).note("for example --sweep size=640x360,1280x720")
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
        if let Some(twice) = (1..values.len()).find(|index| values[..*index].contains(&values[*index])) {
            return Err(wrong(&format!("{} is there twice", values[twice])));
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

/// The one point of `grid` that `text`, `KEY=VALUE KEY=VALUE`, names; keys in which no points differ may be left out.
///
/// Errors: no point or several are named (exit code 2).
pub fn baseline(grid: &[Point], text: &str) -> Result<usize> {
    let wrong = |why: &str| {
        let first = grid.first().map(label).unwrap_or_default();
        Error::request(format!("--baseline {text:?}: {why}")).note(format!("for example --baseline \"{first}\""))
    };
    // A value may hold spaces, as names of cameras do: what a table shows is always understood.
    if let Some(index) = grid.iter().position(|point| label(point) == text) {
        return Ok(index);
    }
    let mut named = Vec::new();
    for word in text.split_whitespace() {
        let (key, value) = word.split_once('=').ok_or_else(|| wrong("it must be KEY=VALUE KEY=VALUE"))?;
        named.push((key.trim_start_matches("--").to_owned(), value.to_owned()));
    }
    let found: Vec<usize> =
        (0..grid.len()).filter(|index| named.iter().all(|pair| grid[*index].contains(pair))).collect();
    match found[..] {
        [] => Err(wrong("the sweep has no such combination")),
        [one] => Ok(one),
        _ => Err(wrong(&format!("it names {} combinations of the sweep, and must name one", found.len()))),
    }
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
        assert!(axes(&["a=1,2,1".to_owned()]).unwrap_err().message().contains("1 is there twice"));
    }

    #[test]
    fn a_baseline_names_one_point_of_the_grid() {
        let grid = grid(&axes(&["split=none,one-pass".to_owned(), "kernel=5,7".to_owned()]).unwrap());
        assert_eq!(baseline(&grid, "kernel=7 split=none").unwrap(), 1);
        assert_eq!(baseline(&grid, "--split=one-pass  --kernel=5").unwrap(), 2);
        for (text, why) in
            [("kernel=9", "no such"), ("pattern=2x2", "no such"), ("kernel=5", "2 combi"), ("kernel", "KEY")]
        {
            let error = baseline(&grid, text).unwrap_err();
            assert!(error.exit_code() == 2 && error.message().contains(why), "{error}");
        }
        assert_eq!(baseline(&super::grid(&[]), "").unwrap(), 0);
    }
}
