//! The best value of a setting that a sweep tries, for each combination of the others, and whether the sweep can
//! distinguish it from its neighbours.

use super::faster;
use super::row::BenchRow;
use super::stats::Ratio;
use super::sweep::Axis;
use serde::ser::{Serialize, SerializeMap, Serializer};
use std::cmp::Ordering;

/// The value with the least time ratio, of one combination of the other axes.
pub struct Best {
    /// That combination; empty where there is no other axis.
    of: String,
    key: &'static str,
    value: String,
    ratio: Option<Ratio>,
    /// Whether it is faster than all of its neighbours; None where that was not measured.
    differs_from_neighbours: Option<bool>,
    neighbours: Vec<Neighbour>,
}

/// A value beside the best one, in the order of the sweep.
struct Neighbour {
    key: &'static str,
    value: String,
    ratio: Option<Ratio>,
    /// The best one's time in parts of this one's, of the same rounds; None below three of them.
    paired: Option<Ratio>,
    /// Whether the best one is proven to be faster.
    differs: Option<bool>,
}

impl Serialize for Best {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("of", &self.of)?;
        map.serialize_entry(self.key, &self.value)?;
        map.serialize_entry("ratio", &self.ratio)?;
        map.serialize_entry("differs_from_neighbours", &self.differs_from_neighbours)?;
        map.serialize_entry("neighbours", &self.neighbours)?;
        map.end()
    }
}

impl Serialize for Neighbour {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry(self.key, &self.value)?;
        map.serialize_entry("ratio", &self.ratio)?;
        map.serialize_entry("paired", &self.paired)?;
        map.serialize_entry("differs", &self.differs)?;
        map.end()
    }
}

/// For each combination of the other axes that reads `key`: its value with the least time ratio, and its neighbours in
/// the order of the sweep. Empty where `key` was not swept.
///
/// A value is the best if it is proven to be faster than its neighbours, by the interval of the ratio of times that
/// were taken in the same rounds; without three of those the answer is None.
pub fn best(key: &'static str, axes: &[Axis], rows: &[BenchRow]) -> Vec<Best> {
    if axes.iter().all(|axis| axis.key != key) {
        return Vec::new();
    }
    let reads = |row: &&BenchRow| !row.unread_axes.iter().flatten().any(|unread| unread == key);
    let has_mean = |row: &&BenchRow| row.ratio.as_ref().is_some_and(|ratio| ratio.mean.is_finite());
    let mut sweeps: Vec<(String, Vec<&BenchRow>)> = Vec::new();
    for row in rows.iter().filter(reads).filter(has_mean) {
        let of = row.others(&[key], axes);
        match sweeps.iter_mut().find(|(known, _)| *known == of) {
            Some((_, sweep)) => sweep.push(row),
            None => sweeps.push((of, vec![row])),
        }
    }
    sweeps.iter().filter_map(|(of, sweep)| best_of(key, of.clone(), sweep)).collect()
}

fn mean(ratio: &Option<Ratio>) -> f64 {
    ratio.as_ref().map_or(f64::INFINITY, |ratio| ratio.mean)
}

fn best_of(key: &'static str, of: String, sweep: &[&BenchRow]) -> Option<Best> {
    let best = (0..sweep.len()).min_by(|a, b| mean(&sweep[*a].ratio).total_cmp(&mean(&sweep[*b].ratio)))?;
    let neighbours: Vec<Neighbour> = [best.checked_sub(1), Some(best + 1)]
        .into_iter()
        .flatten()
        .filter_map(|index| sweep.get(index))
        .map(|row| {
            let paired = faster::paired(sweep[best], row);
            let differs = paired.as_ref().and_then(faster::told).map(|told| told == Ordering::Less);
            Neighbour { key, value: row.asked_text(key), ratio: row.ratio, paired, differs }
        })
        .collect();
    let verdicts: Option<Vec<bool>> = neighbours.iter().map(|neighbour| neighbour.differs).collect();
    let differs_from_neighbours =
        verdicts.filter(|verdicts| !verdicts.is_empty()).map(|verdicts| verdicts.iter().all(|one| *one));
    let (value, ratio) = (sweep[best].asked_text(key), sweep[best].ratio);
    Some(Best { of, key, value, ratio, differs_from_neighbours, neighbours })
}

impl Best {
    /// For a person.
    pub fn sentence(&self) -> String {
        let names = |wanted: Option<bool>| {
            let names = self.neighbours.iter().filter(|one| one.differs == wanted).map(|one| one.value.as_str());
            names.collect::<Vec<_>>().join(" and ")
        };
        let of = if self.of.is_empty() { String::new() } else { format!("{}: ", self.of) };
        let (key, value, ratio) = (self.key, &self.value, mean(&self.ratio));
        let least = format!("{of}no best {key}: {value} has the least ratio, {ratio:.3}");
        match self.differs_from_neighbours {
            Some(true) => {
                let neighbours = names(Some(true));
                format!("{of}best {key} {value}, ratio {ratio:.3}; by the interval faster than {neighbours} beside it")
            }
            Some(false) => format!("{least}, but the interval does not separate it from {}", names(Some(false))),
            None if self.neighbours.is_empty() => format!("{least}, and no neighbour"),
            None => format!("{least}, but fewer than three rounds measured it and {}", names(None)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::sweep::axes;
    use crate::report::spread::Spread;
    use crate::settings::written::{SettingValue, WrittenSettings};
    use serde_json::{Value, json};

    const KEY: &str = "block";

    fn texts(pairs: &[(&str, &str)]) -> WrittenSettings {
        pairs.iter().map(|(key, text)| ((*key).to_owned(), SettingValue::Text((*text).to_owned()))).collect()
    }

    /// Rows of one group: three rounds of `ms`, more or less by `reach` of it.
    fn row(pattern: &str, block: &str, ms: f64, reach: f64) -> BenchRow {
        BenchRow {
            asked: Some(texts(&[("pattern", pattern), ("block", block)])),
            // As it was used: rounded up to whole patterns.
            settings: texts(&[("pattern", pattern), ("block", "as used")]),
            group: Some(pattern.to_owned()),
            stage_ms: Spread::of(&[ms * (1.0 - reach), ms, ms * (1.0 + reach)]),
            ratio: Some(Ratio { mean: ms, interval: Some([ms - reach, ms + reach]), pairs: 3 }),
            ..BenchRow::default()
        }
    }

    #[test]
    fn the_best_block_of_each_pattern_is_told_from_its_neighbours_by_their_own_ratio() {
        let axes = axes(&["pattern=2x2,4x4".to_owned(), "block=8,16,32".to_owned()]).unwrap();
        let rows = [
            // Their ratios to the baseline overlap; they rise and fall together.
            row("2x2", "8", 1.0, 0.3),
            row("2x2", "16", 0.8, 0.3),
            row("2x2", "32", 0.95, 0.3),
            row("4x4", "8", 0.7, 0.05),
            BenchRow { ratio: None, skipped: Some("impossible".to_owned()), ..row("4x4", "16", 1.0, 0.0) },
            row("4x4", "32", 0.71, -0.05),
        ];
        let best_of = best(KEY, &axes, &rows);
        let found: Vec<Value> = best_of.iter().map(|best| json!(best)).collect();
        assert_eq!(found.len(), 2);
        assert_eq!((&found[0]["of"], &found[0]["block"]), (&json!("pattern=2x2"), &json!("16")));
        assert_eq!(found[0]["differs_from_neighbours"], true);
        assert!((found[0]["neighbours"][0]["paired"]["mean"].as_f64().unwrap() - 0.8).abs() < 1e-9);
        assert!(best_of[0].sentence().contains("best block 16, ratio 0.800; by the interval faster than 8 and 32"));
        // The neighbour that could not be is passed over.
        assert_eq!((&found[1]["block"], &found[1]["neighbours"][0]["block"]), (&json!("8"), &json!("32")));
        assert_eq!(found[1]["differs_from_neighbours"], false);
        assert!(
            best_of[1].sentence().contains("no best block: 8 has the least ratio, 0.700, but the interval does not")
        );
        assert!(best(KEY, &axes[..1], &rows).is_empty());
    }

    #[test]
    fn what_was_not_measured_in_the_same_rounds_is_not_told_apart() {
        let axes = axes(&["block=8,16".to_owned()]).unwrap();
        let rows = [row("2x2", "8", 0.5, 0.0), row("4x4", "16", 1.5, 0.0)];
        let found = best(KEY, &axes, &rows);
        assert_eq!(found[0].differs_from_neighbours, None);
        let told = found[0].sentence();
        assert!(told.ends_with("fewer than three rounds measured it and 16"), "{told}");
        // Rows of earlier versions know no groups, and hold their settings as they were typed.
        let old = ["8", "16"].map(|block| BenchRow {
            asked: None,
            settings: texts(&[("block", block)]),
            group: None,
            ..row("2x2", block, 1.5, 0.0)
        });
        assert_eq!(best(KEY, &axes, &old)[0].value, "8");
        assert_eq!(
            best(KEY, &axes, &old[..1])[0].sentence(),
            "no best block: 8 has the least ratio, 1.500, and no neighbour"
        );
    }

    #[test]
    fn a_method_that_reads_no_block_has_no_best_one() {
        let axes = axes(&["split=one-pass,two-pass".to_owned(), "block=8".to_owned()]).unwrap();
        let of = |split: &str, unread: Option<Vec<String>>| BenchRow {
            asked: Some(texts(&[("split", split), ("block", "8")])),
            unread_axes: unread,
            ..row("2x2", "8", 1.0, 0.0)
        };
        let found = best(KEY, &axes, &[of("one-pass", Some(vec!["block".to_owned()])), of("two-pass", None)]);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].of, "split=two-pass");
    }
}
