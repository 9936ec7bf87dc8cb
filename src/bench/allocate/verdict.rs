//! Whether this program's allocator is worse than another on a trace, in peak or in time, with the figures.

use super::contender::OURS;
use super::rows::AllocateRow;
use crate::bench::stats::{Ratio, paired_ratio};
use crate::bench::table::ratio;
use crate::units::Bytes;
use serde::{Deserialize, Serialize};

/// One of ours beside one of theirs; its fields are the keys of the JSON document, in their order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Verdict {
    pub trace: String,
    /// Which one of ours: of `default`, `least peak` and `least time` all that it is.
    pub of: String,
    pub ours: String,
    pub theirs: String,
    pub our_peak_bytes: u64,
    pub their_peak_bytes: u64,
    #[serde(rename = "peak_worse")]
    pub is_peak_worse: bool,
    /// Our time in parts of theirs.
    pub ratio: Ratio,
    /// The whole interval of `ratio` lies above 1.
    #[serde(rename = "time_worse")]
    pub is_time_worse: bool,
}

/// A row with its figures.
struct Figures<'a> {
    row: &'a AllocateRow,
    peak_bytes: u64,
    samples: &'a [f64],
    median_ns: f64,
}

fn figures(row: &AllocateRow) -> Option<Figures<'_>> {
    let ns = row.ns_per_operation.as_ref()?;
    Some(Figures { row, peak_bytes: row.measures?.peak_bytes, samples: &ns.samples, median_ns: ns.median })
}

/// What the rows of one trace say, the first of which is the default: that one, the one with the least peak and the fastest one
/// of ours, each beside each of theirs.
pub fn verdicts(rows: &[AllocateRow]) -> Vec<Verdict> {
    let (ours, theirs): (Vec<_>, Vec<_>) = rows.iter().filter_map(figures).partition(|one| one.row.allocator == OURS);
    let smallest = ours
        .iter()
        .min_by(|one, other| one.peak_bytes.cmp(&other.peak_bytes).then(one.median_ns.total_cmp(&other.median_ns)));
    let fastest = ours.iter().min_by(|one, other| one.median_ns.total_cmp(&other.median_ns));
    let default = ours.first().filter(|one| std::ptr::eq(one.row, &rows[0]));
    let mut chosen: Vec<(String, &Figures<'_>)> = Vec::new();
    for (of, ours) in [("default", default), ("least peak", smallest), ("least time", fastest)] {
        let Some(ours) = ours else { continue };
        match chosen.iter_mut().find(|(_, known)| std::ptr::eq(known.row, ours.row)) {
            Some((known, _)) => *known = format!("{known}, {of}"),
            None => chosen.push((of.to_owned(), ours)),
        }
    }
    let mut all = Vec::new();
    for (of, ours) in chosen {
        all.extend(theirs.iter().map(|theirs| {
            let ratio = paired_ratio(ours.samples, theirs.samples);
            Verdict {
                trace: ours.row.trace.clone(),
                of: of.clone(),
                ours: ours.row.variant.clone(),
                theirs: format!("{} {}", theirs.row.allocator, theirs.row.variant),
                our_peak_bytes: ours.peak_bytes,
                their_peak_bytes: theirs.peak_bytes,
                is_peak_worse: ours.peak_bytes > theirs.peak_bytes,
                is_time_worse: ratio.interval.is_some_and(|[low, _]| low > 1.0),
                ratio,
            }
        }));
    }
    all
}

/// A line for each.
pub fn text(verdicts: &[Verdict]) -> String {
    let word = |is_worse| if is_worse { "worse" } else { "no worse" };
    let line = |one: &Verdict| {
        let [ours, theirs] = [one.our_peak_bytes, one.their_peak_bytes].map(Bytes);
        format!(
            "{} ({}) against {}: peak {ours} to {theirs}, {}; time ratio {}, {}\n",
            one.of,
            one.ours,
            one.theirs,
            word(one.is_peak_worse),
            ratio(&one.ratio),
            word(one.is_time_worse)
        )
    };
    verdicts.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::allocate::play::Measures;
    use crate::report::spread::Spread;

    fn row(allocator: &str, variant: &str, peak_bytes: u64, ns: &[f64]) -> AllocateRow {
        let [bench, commit, place, trace, allocator, variant] =
            ["allocate", "", "numbers", "t", allocator, variant].map(str::to_owned);
        let measures = Some(Measures { peak_bytes, ..Measures::default() });
        let ns_per_operation = Spread::of(ns);
        let (schema, repeat, refused, ratio) = (1, ns.len(), None, None);
        AllocateRow {
            schema,
            bench,
            commit,
            place,
            trace,
            allocator,
            variant,
            repeat,
            refused,
            ns_per_operation,
            ratio,
            measures,
        }
    }

    #[test]
    fn the_default_and_the_best_are_held_against_each_rival() {
        let rows = [
            row(OURS, "linear", 300, &[10.0, 10.2, 10.1]),
            row(OURS, "tlsf", 100, &[20.0, 20.2, 20.1]),
            row("other", "", 200, &[15.0, 15.1, 15.2]),
        ];
        let all = verdicts(&rows);
        let found: Vec<_> =
            all.iter().map(|one| (one.of.as_str(), one.ours.as_str(), one.is_peak_worse, one.is_time_worse)).collect();
        assert_eq!(found, [("default, least time", "linear", true, false), ("least peak", "tlsf", false, true)]);
        assert!(
            text(&all)
                .contains("default, least time (linear) against other : peak 300 B to 200 B, worse; time ratio 0.66"),
            "{}",
            text(&all)
        );
        // Noise is no verdict.
        let noisy = verdicts(&[row(OURS, "linear", 1, &[10.0, 30.0, 10.0]), row("other", "", 1, &[9.0, 9.1, 9.2])]);
        assert!(noisy.iter().all(|one| !one.is_time_worse && !one.is_peak_worse));
        // A default that is refused is none.
        let refused = AllocateRow { measures: None, ns_per_operation: None, ..rows[0].clone() };
        let rest = verdicts(&[refused, rows[1].clone(), rows[2].clone()]);
        assert_eq!(rest.iter().map(|one| one.of.as_str()).collect::<Vec<_>>(), ["least peak, least time"]);
    }
}
