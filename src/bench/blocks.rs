//! The best block of each pattern, and whether a sweep can distinguish it from its neighbours.

use super::faster;
use super::row::asked;
use super::sweep::Axis;
use serde_json::{Value, json};
use std::cmp::Ordering;

/// The key of the swept blocks (Segovia 2006, section 3.3: p x q).
const KEY: &str = "block";

/// For each combination of the other axes that reads it: the block with the least time ratio, and its neighbours in
/// the order of the sweep. Empty where no block was swept.
///
/// A block is the best if it is proven to be faster than its neighbours, by the interval of the ratio of times that
/// were taken in the same rounds; without three of those the answer is null.
pub fn best(axes: &[Axis], rows: &[Value]) -> Vec<Value> {
    if axes.iter().all(|axis| axis.key != KEY) {
        return Vec::new();
    }
    let others = |row: &Value| -> Vec<String> {
        let of = |axis: &Axis| format!("{}={}", axis.key, asked(row)[&axis.key].as_str().unwrap_or_default());
        axes.iter().filter(|axis| axis.key != KEY).map(of).collect()
    };
    let reads = |row: &&Value| !row["unread_axes"].as_array().is_some_and(|keys| keys.contains(&json!(KEY)));
    let mut sweeps: Vec<(Vec<String>, Vec<&Value>)> = Vec::new();
    for row in rows.iter().filter(reads).filter(|row| row["ratio"]["mean"].is_f64()) {
        let of = others(row);
        match sweeps.iter_mut().find(|(known, _)| *known == of) {
            Some((_, sweep)) => sweep.push(row),
            None => sweeps.push((of, vec![row])),
        }
    }
    sweeps.iter().filter_map(|(of, sweep)| best_of(&of.join(" "), sweep)).collect()
}

fn mean(row: &Value) -> f64 {
    row["ratio"]["mean"].as_f64().unwrap_or(f64::INFINITY)
}

fn best_of(of: &str, sweep: &[&Value]) -> Option<Value> {
    let best = (0..sweep.len()).min_by(|a, b| mean(sweep[*a]).total_cmp(&mean(sweep[*b])))?;
    let neighbours: Vec<Value> = [best.checked_sub(1), Some(best + 1)]
        .into_iter()
        .flatten()
        .filter_map(|index| sweep.get(index))
        .map(|row| {
            let paired = faster::paired(sweep[best], row);
            let is_faster = paired.as_ref().and_then(faster::told).map(|told| told == Ordering::Less);
            json!({
                "block": asked(row)[KEY],
                "ratio": row["ratio"],
                "paired": paired.map(|ratio| ratio.json()),
                "differs": is_faster,
            })
        })
        .collect();
    let verdicts: Option<Vec<bool>> = neighbours.iter().map(|neighbour| neighbour["differs"].as_bool()).collect();
    let differs = verdicts.filter(|verdicts| !verdicts.is_empty()).map(|verdicts| verdicts.iter().all(|one| *one));
    let row = sweep[best];
    Some(json!({
        "of": of,
        "block": asked(row)[KEY],
        "ratio": row["ratio"],
        "differs_from_neighbours": differs,
        "neighbours": neighbours,
    }))
}

/// `best`'s entry as a sentence.
pub fn sentence(best: &Value) -> String {
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let names = |wanted: Value| -> String {
        let neighbours = best["neighbours"].as_array().into_iter().flatten();
        let names: Vec<String> =
            neighbours.filter(|one| one["differs"] == wanted).map(|one| text(&one["block"])).collect();
        names.join(" and ")
    };
    let of = if best["of"] == "" { String::new() } else { format!("{}: ", text(&best["of"])) };
    let (block, ratio) = (text(&best["block"]), mean(best));
    let least = format!("{of}no best block: {block} has the least ratio, {ratio:.3}");
    match best["differs_from_neighbours"].as_bool() {
        Some(true) => {
            let neighbours = names(json!(true));
            format!("{of}best block {block}, ratio {ratio:.3}; by the interval faster than {neighbours} beside it")
        }
        Some(false) => format!("{least}, but the interval does not separate it from {}", names(json!(false))),
        None if best["neighbours"].as_array().is_none_or(Vec::is_empty) => format!("{least}, and no neighbour"),
        None => format!("{least}, but fewer than three rounds measured it and {}", names(Value::Null)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::sweep::axes;

    /// Rows of one group: three rounds of `ms`, more or less by `reach` of it.
    fn row(pattern: &str, block: &str, ms: f64, reach: f64) -> Value {
        let samples = [ms * (1.0 - reach), ms, ms * (1.0 + reach)];
        json!({
            "asked": { "pattern": pattern, "block": block },
            // As it was used: rounded up to whole patterns.
            "settings": { "pattern": pattern, "block": "as used" },
            "group": pattern,
            "stage_ms": { "samples": samples },
            "ratio": { "mean": ms, "interval_95": [ms - reach, ms + reach] },
        })
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
            json!({ "asked": { "pattern": "4x4", "block": "16" }, "skipped": "impossible" }),
            row("4x4", "32", 0.71, -0.05),
        ];
        let found = best(&axes, &rows);
        assert_eq!(found.len(), 2);
        assert_eq!((&found[0]["of"], &found[0]["block"]), (&json!("pattern=2x2"), &json!("16")));
        assert_eq!(found[0]["differs_from_neighbours"], true);
        assert!((found[0]["neighbours"][0]["paired"]["mean"].as_f64().unwrap() - 0.8).abs() < 1e-9);
        assert!(sentence(&found[0]).contains("best block 16, ratio 0.800; by the interval faster than 8 and 32"));
        // The neighbour that could not be is passed over.
        assert_eq!((&found[1]["block"], &found[1]["neighbours"][0]["block"]), (&json!("8"), &json!("32")));
        assert_eq!(found[1]["differs_from_neighbours"], false);
        assert!(sentence(&found[1]).contains("no best block: 8 has the least ratio, 0.700, but the interval does not"));
        assert!(best(&axes[..1], &rows).is_empty());
    }

    #[test]
    fn what_was_not_measured_in_the_same_rounds_is_not_told_apart() {
        let axes = axes(&["block=8,16".to_owned()]).unwrap();
        let rows = [row("2x2", "8", 0.5, 0.0), row("4x4", "16", 1.5, 0.0)];
        let found = best(&axes, &rows);
        assert_eq!(found[0]["differs_from_neighbours"], Value::Null);
        assert!(sentence(&found[0]).ends_with("fewer than three rounds measured it and 16"), "{}", sentence(&found[0]));
        // Rows of earlier versions know no groups, and hold their settings as they were typed.
        let old = ["8", "16"].map(|block| json!({ "settings": { "block": block }, "ratio": { "mean": 1.5 } }));
        assert_eq!(best(&axes, &old)[0]["block"], "8");
        assert_eq!(
            sentence(&best(&axes, &old[..1])[0]),
            "no best block: 8 has the least ratio, 1.500, and no neighbour"
        );
    }

    #[test]
    fn a_method_that_reads_no_block_has_no_best_one() {
        let axes = axes(&["split=one-pass,two-pass".to_owned(), "block=8".to_owned()]).unwrap();
        let of = |split: &str, unread: &[&str]| json!({ "asked": { "split": split, "block": "8" }, "unread_axes": unread, "ratio": { "mean": 1.0 } });
        let found = best(&axes, &[of("one-pass", &["block"]), of("two-pass", &[])]);
        assert_eq!(found.len(), 1);
        assert_eq!(found[0]["of"], "split=two-pass");
    }
}
