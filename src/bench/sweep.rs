//! A grid of settings: `--sweep KEY=V,V,...`, each axis given once, all combinations.

use crate::error::{Error, Result};

/// One axis of the grid.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Axis {
    pub key: String,
    pub values: Vec<String>,
}

impl Axis {
    pub fn new(key: &str, values: &[&str]) -> Self {
        Self { key: key.to_owned(), values: values.iter().map(|value| (*value).to_owned()).collect() }
    }
}

/// A combination: a value for each axis, in the axes' order.
pub type Point = Vec<(String, String)>;

/// What a row is of, and what it is called.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NamedPoint {
    /// None: its label. Points of the grid have none.
    pub name: Option<String>,
    pub point: Point,
}

/// What a point without settings is called.
const DEFAULTS: &str = "defaults";

/// A name's longest: it is the first column of tables.
const MOST_NAME_CHARS: usize = 64;

/// Errors: `name` cannot be a point's (exit code 2). One that can is told from `KEY=VALUE`, and stands in a table as it is.
pub fn require_name(name: &str) -> Result<()> {
    let is_of_name = |letter: char| letter.is_alphanumeric() || "-_.".contains(letter);
    if name == DEFAULTS {
        return Err(Error::request(format!("name {name:?}: a row without settings of its own is called so")));
    }
    if name.is_empty() || name.chars().count() > MOST_NAME_CHARS || !name.chars().all(is_of_name) {
        let why =
            format!("name {name:?}: it must be 1 to {MOST_NAME_CHARS} letters, digits, dashes, underscores and dots");
        return Err(Error::request(why).note("for example --point \"as-published: size=640x360 seed=2\""));
    }
    Ok(())
}

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

/// Reads `KEY=VALUE KEY=VALUE`, or `NAME: KEY=VALUE KEY=VALUE`.
///
/// Errors: a word is no such pair, a key is given twice, or the name cannot be one (exit code 2).
pub fn point(text: &str) -> Result<NamedPoint> {
    let wrong = |why: &str| {
        Error::request(format!("--point {text:?}: {why}")).note("for example --point \"size=640x360 seed=2\"")
    };
    // Values may hold colons, keys and names do not.
    let (name, pairs) = match text.split_once(':').filter(|(before, _)| !before.contains('=')) {
        Some((name, pairs)) => (Some(name.trim().to_owned()), pairs),
        None => (None, text),
    };
    name.iter().try_for_each(|name| require_name(name)).map_err(|error| error.within(format!("--point {text:?}")))?;
    let mut point = Point::new();
    for word in pairs.split_whitespace() {
        let (key, value) = word.split_once('=').ok_or_else(|| wrong("it must be KEY=VALUE KEY=VALUE"))?;
        let key = key.trim_start_matches("--");
        if point.iter().any(|(known, _)| known == key) {
            return Err(wrong(&format!("{key} is there twice")));
        }
        point.push((key.to_owned(), value.to_owned()));
    }
    if point.is_empty() { Err(wrong("it sets nothing")) } else { Ok(NamedPoint { name, point }) }
}

/// The grid, and `points` behind it.
///
/// Errors: one of them, or its name, is there already (exit code 2).
pub fn with_points(grid: Vec<Point>, points: &[NamedPoint]) -> Result<Vec<NamedPoint>> {
    let mut all: Vec<NamedPoint> = grid.into_iter().map(|point| NamedPoint { name: None, point }).collect();
    for NamedPoint { name, point } in points {
        let refused = |why: String| Err(Error::request(format!("--point \"{}\": {why}", label(point))));
        if all.iter().any(|known| known.point == *point) {
            return refused("this row is there already".to_owned());
        }
        if let Some(other) = all.iter().find(|known| name.is_some() && known.name == *name) {
            let name = name.as_deref().unwrap_or_default();
            return refused(format!("the name {name} is that of {}", label(&other.point)));
        }
        all.push(NamedPoint { name: name.clone(), point: point.clone() });
    }
    Ok(all)
}

/// `key=value key=value`, for tables; `defaults` without axes.
pub fn label(point: &Point) -> String {
    if point.is_empty() {
        return DEFAULTS.to_owned();
    }
    point.iter().map(|(key, value)| format!("{key}={value}")).collect::<Vec<_>>().join(" ")
}

/// Points that share a baseline, by their places in the grid.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Part {
    /// None: the first point that is possible.
    pub baseline: Option<usize>,
    /// In the order of the grid, the baseline among them.
    pub points: Vec<usize>,
}

/// The parts of `grid` that `text`, `KEY=VALUE KEY=VALUE` or a point's name, makes of it: where it names several points, because
/// it leaves axes out, each is the baseline of the points that have its values of those axes. One part without a text.
///
/// Errors: no point is named (exit code 2).
pub fn parts(grid: &[NamedPoint], text: Option<&str>) -> Result<Vec<Part>> {
    let all = || (0..grid.len()).collect();
    let Some(text) = text else { return Ok(vec![Part { baseline: None, points: all() }]) };
    let (named, keys) = baselines(grid, text)?;
    if let [one] = named[..] {
        return Ok(vec![Part { baseline: Some(one), points: all() }]);
    }
    let others = |index: usize| grid[index].point.iter().filter(|(key, _)| !keys.contains(key)).collect::<Vec<_>>();
    let part = |baseline: usize| {
        let points = (0..grid.len()).filter(|index| others(*index) == others(baseline)).collect();
        Part { baseline: Some(baseline), points }
    };
    Ok(named.into_iter().map(part).collect())
}

/// The points that `text` names, and the keys that it has.
///
/// Errors: it names none (exit code 2).
fn baselines(grid: &[NamedPoint], text: &str) -> Result<(Vec<usize>, Vec<String>)> {
    const FORM: &str = "it must be KEY=VALUE KEY=VALUE, or the name of a point";
    let wrong = |why: &str| {
        let first = grid.first().map(|first| label(&first.point)).unwrap_or_default();
        Error::request(format!("--baseline {text:?}: {why}")).note(format!("for example --baseline \"{first}\""))
    };
    // A value may hold spaces, as names of cameras do: what a table shows is always understood.
    let is_named = |known: &NamedPoint| known.name.as_deref() == Some(text) || label(&known.point) == text;
    if let Some(index) = grid.iter().position(is_named) {
        return Ok((vec![index], Vec::new()));
    }
    let mut named = Vec::new();
    for word in text.split_whitespace() {
        let (key, value) = word.split_once('=').ok_or_else(|| wrong(FORM))?;
        named.push((key.trim_start_matches("--").to_owned(), value.to_owned()));
    }
    if named.is_empty() && grid.iter().any(|known| !known.point.is_empty()) {
        return Err(wrong(FORM));
    }
    let found: Vec<usize> =
        (0..grid.len()).filter(|index| named.iter().all(|pair| grid[*index].point.contains(pair))).collect();
    match found[..] {
        [] => Err(wrong("the sweep has no such combination")),
        _ => Ok((found, named.into_iter().map(|(key, _)| key).collect())),
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
    fn a_baseline_names_one_point_of_the_grid_or_one_of_each_part() {
        let axes = axes(&["split=none,one-pass".to_owned(), "kernel=5,7".to_owned()]).unwrap();
        let grid = with_points(super::grid(&axes), &[]).unwrap();
        let part = |baseline: usize, points: &[usize]| Part { baseline: Some(baseline), points: points.to_vec() };
        for (text, expected) in [
            ("kernel=7 split=none", vec![part(1, &[0, 1, 2, 3])]),
            ("--split=one-pass  --kernel=5", vec![part(2, &[0, 1, 2, 3])]),
            ("split=one-pass", vec![part(2, &[0, 2]), part(3, &[1, 3])]),
            ("kernel=5", vec![part(0, &[0, 1]), part(2, &[2, 3])]),
        ] {
            assert_eq!(parts(&grid, Some(text)).unwrap(), expected, "{text}");
        }
        for (text, why) in [("kernel=9", "no such"), ("pattern=2x2", "no such"), ("kernel", "KEY"), ("", "KEY")] {
            let error = parts(&grid, Some(text)).unwrap_err();
            assert!(error.exit_code() == 2 && error.message().contains(why), "{error}");
        }
        assert_eq!(parts(&with_points(super::grid(&[]), &[]).unwrap(), Some("")).unwrap(), [part(0, &[0])]);
        assert_eq!(parts(&grid, None).unwrap(), [Part { baseline: None, points: vec![0, 1, 2, 3] }]);
    }

    #[test]
    fn a_point_may_have_a_name_that_names_a_baseline() {
        let read = |text: &str| point(text).unwrap();
        let pairs = vec![("kernel".to_owned(), "7".to_owned()), ("camera".to_owned(), "a:b".to_owned())];
        assert_eq!(read("kernel=7 --camera=a:b"), NamedPoint { name: None, point: pairs.clone() });
        let named = NamedPoint { name: Some("as-in_2.1".to_owned()), point: pairs };
        assert_eq!(read("as-in_2.1: kernel=7 camera=a:b"), named);
        assert_eq!(read(" as-in_2.1 :kernel=7 camera=a:b"), named);

        let axes = axes(&["split=none,one-pass".to_owned()]).unwrap();
        let all = with_points(grid(&axes), std::slice::from_ref(&named)).unwrap();
        for text in ["as-in_2.1", "kernel=7", "kernel=7 camera=a:b"] {
            let expected = Part { baseline: Some(2), points: vec![0, 1, 2] };
            assert_eq!(parts(&all, Some(text)).unwrap(), [expected], "{text}");
        }
        let error = parts(&all, Some("as-in_2.2")).unwrap_err();
        assert!(error.message().contains("the name of a point"), "{error}");
    }

    #[test]
    fn a_name_that_is_none_is_refused() {
        let long = "x".repeat(65);
        for name in ["", "a b", "a,b", "a|b", "a/b", "a\nb", "defaults", &long] {
            let error = point(&format!("{name}: kernel=7")).unwrap_err();
            assert!(error.exit_code() == 2 && error.message().contains("name"), "{name:?}: {error}");
        }
        assert!(point("a:").unwrap_err().message().contains("it sets nothing"));
        let [one, other] = ["a: kernel=7", "a: kernel=9"].map(|text| point(text).unwrap());
        let error = with_points(grid(&[]), &[one, other]).unwrap_err();
        assert!(error.message().contains("the name a is that of kernel=7"), "{error}");
    }
}
