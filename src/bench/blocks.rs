//! The best block of each pattern, and whether a sweep can tell it from its neighbours.

use super::sweep::Axis;
use serde_json::{Value, json};

/// The key of the swept blocks (Segovia 2006, section 3.3: p x q).
const KEY: &str = "block";

/// For each combination of the other axes: the block with the least time ratio, and its neighbours in the order of the
/// sweep. Empty where no block was swept.
///
/// A block differs from a neighbour where the 95 % intervals of their ratios to the baseline have nothing in common;
/// with one round there are no intervals, and the answer is null.
pub fn best(axes: &[Axis], rows: &[Value]) -> Vec<Value> {
    if axes.iter().all(|axis| axis.key != KEY) {
        return Vec::new();
    }
    let others = |row: &Value| -> Vec<String> {
        let of = |axis: &Axis| format!("{}={}", axis.key, row["settings"][&axis.key].as_str().unwrap_or_default());
        axes.iter().filter(|axis| axis.key != KEY).map(of).collect()
    };
    let mut sweeps: Vec<(Vec<String>, Vec<&Value>)> = Vec::new();
    for row in rows.iter().filter(|row| row["ratio"]["mean"].is_f64()) {
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
        .map(
            |row| json!({ "block": row["settings"][KEY], "ratio": row["ratio"], "differs": differs(sweep[best], row) }),
        )
        .collect();
    let verdicts: Option<Vec<bool>> = neighbours.iter().map(|neighbour| neighbour["differs"].as_bool()).collect();
    let differs = verdicts.filter(|verdicts| !verdicts.is_empty()).map(|verdicts| verdicts.iter().all(|one| *one));
    let row = sweep[best];
    Some(json!({
        "of": of,
        "block": row["settings"][KEY],
        "ratio": row["ratio"],
        "differs_from_neighbours": differs,
        "neighbours": neighbours,
    }))
}

fn differs(a: &Value, b: &Value) -> Option<bool> {
    let side = |row: &Value, index: usize| row["ratio"]["interval_95"][index].as_f64();
    Some(side(a, 1)? < side(b, 0)? || side(b, 1)? < side(a, 0)?)
}

/// `best`'s entry as a sentence.
pub fn sentence(best: &Value) -> String {
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let names = |wanted: Value| -> Vec<String> {
        let neighbours = best["neighbours"].as_array().into_iter().flatten();
        neighbours.filter(|one| one["differs"] == wanted).map(|one| text(&one["block"])).collect()
    };
    let verdict = match best["differs_from_neighbours"].as_bool() {
        Some(true) => {
            format!("differs from its neighbours {} by more than the interval", names(json!(true)).join(" and "))
        }
        Some(false) => format!("not told from {} by the interval", names(json!(false)).join(" and ")),
        None if best["neighbours"].as_array().is_none_or(Vec::is_empty) => "it has no neighbour".to_owned(),
        None => "one round has no interval to tell it from its neighbours".to_owned(),
    };
    let of = if best["of"] == "" { String::new() } else { format!("{}: ", text(&best["of"])) };
    format!("{of}best block {}, ratio {:.3}; {verdict}", text(&best["block"]), mean(best))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::sweep::axes;

    fn row(pattern: &str, block: &str, mean: f64, reach: f64) -> Value {
        json!({
            "settings": { "pattern": pattern, "block": block },
            "ratio": { "mean": mean, "interval_95": [mean - reach, mean + reach] },
        })
    }

    #[test]
    fn the_best_block_of_each_pattern_knows_its_neighbours() {
        let axes = axes(&["pattern=2x2,4x4".to_owned(), "block=8,16,32".to_owned()]).unwrap();
        let rows = [
            row("2x2", "8", 1.0, 0.0),
            row("2x2", "16", 0.8, 0.05),
            row("2x2", "32", 0.95, 0.05),
            row("4x4", "8", 0.7, 0.05),
            json!({ "settings": { "pattern": "4x4", "block": "16" }, "skipped": "impossible" }),
            row("4x4", "32", 0.75, 0.05),
        ];
        let found = best(&axes, &rows);
        assert_eq!(found.len(), 2);
        assert_eq!((&found[0]["of"], &found[0]["block"]), (&json!("pattern=2x2"), &json!("16")));
        assert_eq!(found[0]["differs_from_neighbours"], true);
        assert!(sentence(&found[0]).contains("neighbours 8 and 32"), "{}", sentence(&found[0]));
        // The neighbour that could not be is passed over.
        assert_eq!((&found[1]["block"], &found[1]["neighbours"][0]["block"]), (&json!("8"), &json!("32")));
        assert_eq!(found[1]["differs_from_neighbours"], false);
        assert!(best(&axes[..1], &rows).is_empty());
    }

    #[test]
    fn one_round_tells_nothing_apart() {
        let axes = axes(&["block=8,16".to_owned()]).unwrap();
        let rows = ["8", "16"].map(|block| json!({ "settings": { "block": block }, "ratio": { "mean": 1.5 } }));
        let found = best(&axes, &rows);
        assert_eq!(found[0]["differs_from_neighbours"], Value::Null);
        assert!(sentence(&found[0]).contains("one round"));
    }
}
