//! Transfer functions: the colour and the extinction of a value, piecewise linear between points.

use crate::error::{Error, Result};
use std::fs::File;
use std::io::Read;

/// The longest file that is read, bytes.
const MOST_BYTES: u64 = 1 << 20;

/// Value, red, green, blue, extinction.
type Point = [f32; 5];

/// A transfer function.
#[derive(Clone, Debug, PartialEq)]
pub struct Transfer {
    /// By their values, at least two; two of one value are a step.
    points: Vec<Point>,
}

/// More of everything with the value.
const RAMP: &[Point] = &[[0.0, 0.0, 0.0, 0.0, 0.0], [1.0, 1.0, 1.0, 1.0, 12.0]];

/// What glows: black, red, yellow, white.
const HEAT: &[Point] = &[
    [0.0, 0.0, 0.0, 0.0, 0.0],
    [0.15, 0.05, 0.0, 0.0, 0.0],
    [0.4, 0.7, 0.05, 0.0, 3.0],
    [0.7, 1.0, 0.55, 0.05, 9.0],
    [1.0, 1.0, 1.0, 0.85, 20.0],
];

/// `head`: skin that one sees through, what is inside next to not at all, bone. A scan whose values lie alike looks alike.
const TISSUE: &[Point] = &[
    [0.0, 0.0, 0.0, 0.0, 0.0],
    [0.12, 0.55, 0.25, 0.18, 0.0],
    [0.22, 0.80, 0.46, 0.34, 9.0],
    [0.32, 0.86, 0.54, 0.42, 6.0],
    [0.40, 0.80, 0.40, 0.34, 0.4],
    [0.50, 0.70, 0.42, 0.42, 1.6],
    [0.62, 0.80, 0.72, 0.60, 2.0],
    [0.74, 0.94, 0.90, 0.80, 40.0],
    [1.0, 1.0, 0.99, 0.95, 90.0],
];

/// Five thin shells of equal value, each of a colour.
const SHELLS: &[Point] = &[
    [0.06, 0.20, 0.30, 0.90, 0.0],
    [0.10, 0.20, 0.30, 0.90, 24.0],
    [0.14, 0.20, 0.30, 0.90, 0.0],
    [0.26, 0.15, 0.75, 0.80, 0.0],
    [0.30, 0.15, 0.75, 0.80, 24.0],
    [0.34, 0.15, 0.75, 0.80, 0.0],
    [0.46, 0.25, 0.80, 0.25, 0.0],
    [0.50, 0.25, 0.80, 0.25, 24.0],
    [0.54, 0.25, 0.80, 0.25, 0.0],
    [0.66, 0.95, 0.75, 0.15, 0.0],
    [0.70, 0.95, 0.75, 0.15, 24.0],
    [0.74, 0.95, 0.75, 0.15, 0.0],
    [0.86, 0.95, 0.25, 0.15, 0.0],
    [0.90, 0.95, 0.25, 0.15, 24.0],
    [0.94, 0.95, 0.25, 0.15, 0.0],
];

const BUILT_IN: [(&str, &[Point]); 4] = [("ramp", RAMP), ("heat", HEAT), ("tissue", TISSUE), ("shells", SHELLS)];

impl Transfer {
    /// A built-in function by its word, or the one in a file of lines `VALUE RED GREEN BLUE EXTINCTION`, values of 0 to 1
    /// ascending, `#` before what is not read.
    ///
    /// Errors: no such file, too long a one, or a line that is no point, with its number (exit code 2).
    pub fn open(spec: &str) -> Result<Self> {
        if let Some((_, points)) = BUILT_IN.iter().find(|(word, _)| *word == spec) {
            return Ok(Self { points: points.to_vec() });
        }
        let words = BUILT_IN.map(|(word, _)| word).join(", ");
        let refused = |why: &str| {
            Error::request(format!("--transfer {spec}: {why}"))
                .note(format!("{words} are built in; else it is a file of lines VALUE RED GREEN BLUE EXTINCTION"))
        };
        let file = File::open(spec).map_err(|error| refused(&error.to_string()))?;
        let mut text = String::new();
        file.take(MOST_BYTES + 1).read_to_string(&mut text).map_err(|error| refused(&error.to_string()))?;
        if text.len() as u64 > MOST_BYTES {
            return Err(refused(&format!("it is longer than {MOST_BYTES} bytes")));
        }
        Self::parse(&text).map_err(|why| refused(&why))
    }

    /// Errors: why the text is no function, in words.
    fn parse(text: &str) -> Result<Self, String> {
        let mut points: Vec<Point> = Vec::new();
        for (line, text) in (1..).zip(text.lines()) {
            let text = text.split('#').next().unwrap_or_default().trim();
            if text.is_empty() {
                continue;
            }
            let numbers: Option<Vec<f32>> = text.split_whitespace().map(|number| number.parse().ok()).collect();
            let point: Option<Point> = numbers.and_then(|numbers| numbers.try_into().ok());
            let Some(point) = point.filter(|point| point.iter().all(|number| number.is_finite() && *number >= 0.0))
            else {
                return Err(format!("line {line} is no five numbers of at least 0: {}", short(text)));
            };
            if point[0] > 1.0 || points.last().is_some_and(|before| before[0] > point[0]) {
                return Err(format!("line {line}: values go from 0 to 1 and never back, and this is {}", point[0]));
            }
            points.push(point);
        }
        match points.len() {
            0 | 1 => Err(format!("it has {} points, and a function takes two", points.len())),
            _ => Ok(Self { points }),
        }
    }

    /// Radiance that an opaque piece of this value emits, and its extinction, as optical depth over the volume's longest side.
    /// Outside of the first and the last point, as there.
    pub fn at(&self, value: f32) -> [f32; 4] {
        let above = self.points.partition_point(|point| point[0] <= value);
        let of = |point: &Point| [point[1], point[2], point[3], point[4]];
        match (self.points.get(above.wrapping_sub(1)), self.points.get(above)) {
            (Some(below), Some(above)) => {
                let part = (value - below[0]) / (above[0] - below[0]);
                let (below, above) = (of(below), of(above));
                std::array::from_fn(|channel| below[channel] * (1.0 - part) + above[channel] * part)
            }
            (Some(end), None) | (None, Some(end)) => of(end),
            (None, None) => unreachable!("a function has two points"),
        }
    }

    /// The function at `entries` values from 0 to 1, at least two.
    pub fn table(&self, entries: usize) -> Vec<[f32; 4]> {
        (0..entries).map(|index| self.at(index as f32 / (entries - 1) as f32)).collect()
    }
}

/// The start of a line, for messages.
fn short(text: &str) -> String {
    text.chars().take(60).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_points_it_is_linear_and_beyond_them_it_stays() {
        let made = Transfer::parse("# a step\n0.2 1 0 0 4\n0.6 0 1 0 8 # here\n\n0.6 0 0 1 2\n1 0 0 1 2\n").unwrap();
        assert_eq!(made.at(0.0), [1.0, 0.0, 0.0, 4.0]);
        let half = made.at(0.4);
        assert!(half.iter().zip([0.5, 0.5, 0.0, 6.0]).all(|(a, b)| (a - b).abs() < 1e-6), "{half:?}");
        assert_eq!(made.at(0.6), [0.0, 0.0, 1.0, 2.0]);
        assert_eq!(made.at(1.0), [0.0, 0.0, 1.0, 2.0]);
        let table = made.table(6);
        assert!(table.len() == 6 && table[2] == made.at(0.4) && table[5] == made.at(1.0));
    }

    #[test]
    fn built_in_ones_are_functions_and_begin_or_end_with_nothing() {
        for (word, points) in BUILT_IN {
            let made = Transfer::open(word).unwrap();
            assert!(points.windows(2).all(|pair| pair[0][0] < pair[1][0]), "{word}");
            assert!(points.iter().flatten().all(|number| *number >= 0.0), "{word}");
            assert_eq!(made.at(0.0)[3], 0.0, "{word}: what has no value is not seen");
        }
    }

    #[test]
    fn what_is_no_function_is_refused_by_its_line() {
        for (text, word) in [
            ("", "0 points"),
            ("0 1 1 1 1", "1 points"),
            ("0 1 1 1\n1 1 1 1 1", "line 1"),
            ("0 1 1 1 1\n1 1 1 1 one", "line 2"),
            ("0 1 1 1 1\n2 1 1 1 1", "line 2"),
            ("0.5 1 1 1 1\n0.4 1 1 1 1", "line 2"),
            ("0 1 -1 1 1\n1 1 1 1 1", "line 1"),
            ("0 1 nan 1 1\n1 1 1 1 1", "line 1"),
        ] {
            let error = Transfer::parse(text).unwrap_err();
            assert!(error.contains(word), "{text}: {error}");
        }
        let error = Transfer::open("/nowhere/at-all").unwrap_err();
        assert!(error.exit_code() == 2 && error.to_string().contains("ramp, heat, tissue, shells"), "{error}");
    }
}
