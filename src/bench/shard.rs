//! Parts of a sweep for several machines: which rows are whose is decided by what a row is of, so that all machines agree without
//! asking each other.

use super::row::BenchRow;
use crate::error::{Error, Result};
use serde_json::json;
use std::fmt;
use std::str::FromStr;

/// One part of `count`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// From 1 on.
    index: u64,
    count: u64,
}

impl FromStr for Shard {
    type Err = Error;

    /// `I/N`.
    fn from_str(text: &str) -> Result<Self> {
        let refused = || {
            Error::request(format!("--shard {text}: it must be I/N, I from 1 to N"))
                .note("for example --shard 1/3, 2/3 and 3/3")
        };
        let (index, count) = text.split_once('/').ok_or_else(refused)?;
        let [index, count] = [index, count].map(|number| number.parse::<u64>().map_err(|_| refused()));
        let (index, count) = (index?, count?);
        if (1..=count).contains(&index) { Ok(Self { index, count }) } else { Err(refused()) }
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.index, self.count)
    }
}

impl Shard {
    /// Whether the row is one of its own. Device and commit do not count: each machine has its own.
    pub fn has(&self, row: &BenchRow) -> bool {
        let of = json!([row.bench, row.technique, row.variant, row.scene.hash, row.asked()]).to_string();
        let hash = blake3::hash(of.as_bytes());
        let first = u64::from_le_bytes(hash.as_bytes()[..8].try_into().expect("eight bytes"));
        first % self.count == self.index - 1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_row_is_one_shards_and_all_shards_have_some() {
        let rows: Vec<BenchRow> = (0..300)
            .map(|index| BenchRow {
                variant: format!("vpls={index}"),
                bench: "frame".to_owned(),
                ..BenchRow::default()
            })
            .collect();
        for count in [1, 2, 3, 7] {
            let shards: Vec<Shard> = (1..=count).map(|index| format!("{index}/{count}").parse().unwrap()).collect();
            let sizes: Vec<usize> =
                shards.iter().map(|shard| rows.iter().filter(|row| shard.has(row)).count()).collect();
            assert_eq!(sizes.iter().sum::<usize>(), rows.len(), "{count}: {sizes:?}");
            assert!(sizes.iter().all(|size| *size > 200 / count), "{count}: {sizes:?}");
            assert!(rows.iter().all(|row| shards.iter().filter(|shard| shard.has(row)).count() == 1));
        }
        // Another machine's row of the same measurement is the same shard's.
        let elsewhere = |row: &BenchRow| BenchRow { commit: "another".to_owned(), ..row.clone() };
        let shard: Shard = "2/3".parse().unwrap();
        assert!(rows.iter().all(|row| shard.has(row) == shard.has(&elsewhere(row))));
    }

    #[test]
    fn what_is_no_part_is_refused() {
        for text in ["", "1", "0/3", "4/3", "a/3", "1/0", "1/3/4", "-1/3"] {
            let error = text.parse::<Shard>().unwrap_err();
            assert!(error.exit_code() == 2 && error.message().contains("I/N"), "{error}");
        }
    }
}
