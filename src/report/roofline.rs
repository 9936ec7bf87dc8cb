//! The roofline of a device: what it can do at most, by rows of `bench device`, and so the least time that a pass takes there, its bytes at
//! the rates of memory, its triangles and its fragments at those of the rasteriser (Williams, Waterman and Patterson 2009).

use super::work_row::WorkRow;
use crate::caps::Identity;
use crate::error::{Error, Result};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

/// Shares above this are impossible: what is measured here is not exact.
const IMPOSSIBLE_FROM: f64 = 1.1;

/// What takes a pass its least time.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Bound {
    /// Bytes from and to memory.
    Memory,
    /// Triangles that go into the pipeline.
    Triangles,
    /// Fragments that are shaded.
    Fragments,
}

/// The least time that a pass takes, beside the time that it took; its fields are keys of the pass.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Least {
    /// Milliseconds that it takes at least.
    pub least_ms: f64,
    /// Those in parts of the time that it took.
    pub share: f64,
    /// What takes them.
    pub bound: Bound,
    /// Whether it would have done more than the device does: what is said of its work is not so.
    #[serde(rename = "impossible")]
    pub is_impossible: bool,
}

/// What a device does at most.
#[derive(Clone, Debug, PartialEq)]
pub struct Roofline {
    device: Identity,
    /// Milliseconds a byte where bytes are read alone.
    read_ms: f64,
    /// Where they are written alone.
    write_ms: f64,
    /// For a byte that is read and one that is written, where as many are read as written.
    copy_ms: f64,
    /// None: the rows do not tell.
    triangles_per_s: Option<f64>,
    /// None: the rows do not tell.
    pixels_per_s: Option<f64>,
}

impl Bound {
    /// The word of its key.
    pub fn name(self) -> &'static str {
        match self {
            Self::Memory => "memory",
            Self::Triangles => "triangles",
            Self::Fragments => "fragments",
        }
    }
}

impl Least {
    /// What a reader must know of it; nothing where it is possible.
    pub fn remark(&self) -> &'static str {
        match (self.is_impossible, self.bound) {
            (false, _) => "",
            (true, Bound::Memory) => "impossible: not all of these bytes came from memory",
            (true, Bound::Triangles) => "impossible: not all triangles that are counted were drawn",
            (true, Bound::Fragments) => "impossible: not all fragments that are counted were shaded",
        }
    }
}

impl Roofline {
    /// The best of `rows`.
    ///
    /// Errors: there are none, they are of several devices, or lack reads, writes or copies (exit code 2).
    pub fn of(rows: &[WorkRow]) -> Result<Self> {
        let none = || Error::request("there are no rows of `bench device`");
        let device = &rows.first().ok_or_else(none)?.device;
        if let Some(other) = rows.iter().find(|row| row.device != *device) {
            let [one, other] = [device, &other.device].map(told);
            return Err(Error::request(format!("rows of {one} and of {other}: they must be of one device")));
        }
        let best = |rate: &dyn Fn(&WorkRow) -> Option<f64>| {
            let rates = rows.iter().filter_map(rate).filter(|rate| rate.is_finite() && *rate > 0.0);
            rates.reduce(f64::max)
        };
        let moved = |works: &[&str]| {
            let rate = best(&|row| works.contains(&row.work.as_str()).then_some(row.gb_per_s));
            rate.ok_or_else(|| Error::request(format!("the rows lack the work `{}`", works.join("` or `"))))
        };
        // A billion bytes a second are a million a millisecond.
        let ms = |gb_per_s: f64| 1e-6 / gb_per_s;
        let copied = moved(&["shader copy", "copy command"])?;
        // What copies read, and what they write, can also be read and written alone.
        let read_ms = ms(moved(&["read"])?.max(0.5 * copied));
        let write_ms = ms(moved(&["write", "clear"])?.max(0.5 * copied));
        Ok(Self {
            device: device.clone(),
            read_ms,
            write_ms,
            // A pass can read first and then write.
            copy_ms: (2.0 * ms(copied)).min(read_ms + write_ms),
            triangles_per_s: best(&|row| row.triangles_per_s),
            pixels_per_s: best(&|row| row.pixels_per_s),
        })
    }

    /// The same of a file that `bench device --json` printed.
    ///
    /// Errors: as `WorkRow::read` and `of` (exit code 2).
    pub fn read(path: &Path) -> Result<Self> {
        Self::of(&WorkRow::read(path)?).map_err(|error| {
            error.within(path.display()).note("`quincunx bench device --json` prints the rows of a device")
        })
    }

    /// Errors: `device`, which is what `what` says, is another one (exit code 2).
    pub fn require(&self, device: &Identity, what: &str) -> Result<()> {
        if self.device == *device {
            return Ok(());
        }
        let [theirs, ours] = [device, &self.device].map(told);
        Err(Error::request(format!("{what} is {theirs}, and the rows of `bench device` are of {ours}")))
    }

    /// Milliseconds that a pass takes at least which reads so many bytes and writes so many, as far as what was measured is the device's best.
    ///
    /// What is measured are t(1, 0), t(0, 1) and t(1, 1), the least times of a byte that is read, one that is written, and both. Of any
    /// memory three things hold: twice the bytes take twice the time, more bytes take no less, and two loads together take no longer than
    /// one after the other. So with R >= W
    ///
    /// ```text
    /// t(R, W) >= t(R, 0) = R t(1, 0)
    /// t(R, W) >= t(R, R) - t(0, R - W) = R t(1, 1) - (R - W) t(0, 1)
    /// ```
    ///
    /// the second because the pass and R - W bytes of writes are together a copy of R bytes. Likewise with W > R. Where reads and writes
    /// take turns, and t(1, 1) is t(1, 0) + t(0, 1), that comes to the sum of both times; where they pass each other, to the greater.
    fn memory_ms(&self, read_bytes: u64, written_bytes: u64) -> f64 {
        let [read, written] = [read_bytes, written_bytes].map(|bytes| bytes as f64);
        let (alone, copy_less_rest) = if read >= written {
            (read * self.read_ms, read * self.copy_ms - (read - written) * self.write_ms)
        } else {
            (written * self.write_ms, written * self.copy_ms - (written - read) * self.read_ms)
        };
        alone.max(copy_less_rest)
    }

    /// The least time of a pass that took `ms` milliseconds, more than 0; None where nothing is known of its work. `bytes`: those that it reads
    /// and writes; what is not known of them takes no time. `statistics`: what the device counted in it.
    pub fn least(&self, bytes: [Option<u64>; 2], statistics: Option<&BTreeMap<String, u64>>, ms: f64) -> Option<Least> {
        let counted = |name: &str, per_s: Option<f64>| Some(1e3 * *statistics?.get(name)? as f64 / per_s?);
        let triangles = counted("input_assembly_primitives", self.triangles_per_s);
        let fragments = counted("fragment_shader_invocations", self.pixels_per_s);
        let [read_bytes, written_bytes] = bytes.map(Option::unwrap_or_default);
        let memory = bytes.iter().any(Option::is_some).then(|| self.memory_ms(read_bytes, written_bytes));
        let times = [(Bound::Memory, memory), (Bound::Triangles, triangles), (Bound::Fragments, fragments)];
        let known = times.into_iter().filter_map(|(bound, ms)| Some((bound, ms?)));
        // The first of equal ones.
        let (bound, least_ms) = known.reduce(|one, other| if other.1 > one.1 { other } else { one })?;
        let share = least_ms / ms;
        Some(Least { least_ms, share, bound, is_impossible: share > IMPOSSIBLE_FROM })
    }
}

/// A device and its driver's version.
fn told(device: &Identity) -> String {
    format!("{} ({})", device.name, device.driver_text())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::work_row::{BENCH, SCHEMA};

    fn row(work: &str, gb_per_s: f64) -> WorkRow {
        let device = Identity {
            name: "a device".to_owned(),
            device_type: "discrete-gpu".to_owned(),
            driver: "a driver".to_owned(),
            driver_info: "1.0".to_owned(),
            api: "1.3.0".to_owned(),
        };
        WorkRow {
            schema: SCHEMA,
            bench: BENCH.to_owned(),
            device,
            commit: "unknown".to_owned(),
            work: work.to_owned(),
            buffer_bytes: 1 << 20,
            repeat: 1,
            ms: Default::default(),
            bytes_read: 0,
            bytes_written: 0,
            gb_per_s,
            ns_per_word: None,
            triangles_per_s: None,
            pixels_per_s: None,
        }
    }

    /// Rates of reads, writes and copies, 10^9 bytes a second; those of copies both ways together.
    fn rows([read, write, copy]: [f64; 3]) -> Vec<WorkRow> {
        vec![row("read", read), row("write", write), row("copy command", copy)]
    }

    #[test]
    fn the_least_time_of_bytes_is_that_of_hand_counts() {
        let mb = 1_000_000;
        // Megabytes that are read and written, and milliseconds.
        type Case = (u64, u64, f64);
        let cases: &[([f64; 3], &[Case])] = &[
            // One after the other: 200 MB in 2 ms and 100 MB in 2 ms are copies of 66.7 GB/s.
            (
                [100.0, 50.0, 200.0 / 3.0],
                &[(100, 0, 1.0), (0, 100, 2.0), (100, 100, 3.0), (200, 100, 4.0), (100, 200, 5.0)],
            ),
            // Copies that take longer than reading and writing in turn are no limit of a pass.
            ([100.0, 50.0, 20.0], &[(100, 100, 3.0), (200, 100, 4.0)]),
            // Beside each other.
            ([100.0, 100.0, 200.0], &[(100, 100, 1.0), (200, 100, 2.0), (50, 100, 1.0), (300, 0, 3.0)]),
            // Half of it in turn: a copy of 100 MB takes 1.25 ms, and of 120 MB 1.5, 0.2 of which 20 MB of writes would take.
            ([100.0, 100.0, 160.0], &[(100, 100, 1.25), (120, 100, 1.3), (100, 120, 1.3), (200, 100, 2.0)]),
            // What a copy reads can be read alone as fast.
            ([40.0, 100.0, 100.0], &[(100, 0, 2.0), (100, 100, 2.0), (0, 100, 1.0)]),
            ([100.0; 3], &[(0, 0, 0.0)]),
        ];
        for (rates, cases) in cases {
            let roofline = Roofline::of(&rows(*rates)).unwrap();
            for (read, written, ms) in *cases {
                let found = roofline.memory_ms(read * mb, written * mb);
                assert!((found - ms).abs() < 1e-9, "{rates:?}, {read} MB and {written} MB: {found}, not {ms}");
            }
        }
    }

    #[test]
    fn the_greatest_of_the_least_times_is_the_bound() {
        let mut rows = rows([100.0; 3]);
        rows.push(WorkRow { triangles_per_s: Some(1e9), ..row("triangles", 1.0) });
        rows.push(WorkRow { triangles_per_s: Some(2e9), ..row("triangles turned away", 1.0) });
        rows.push(WorkRow { pixels_per_s: Some(1e10), ..row("fill", 1.0) });
        let roofline = Roofline::of(&rows).unwrap();
        let counts = |triangles: u64, fragments: u64| {
            let counts = [("input_assembly_primitives", triangles), ("fragment_shader_invocations", fragments)];
            BTreeMap::from(counts.map(|(name, count)| (name.to_owned(), count)))
        };
        let bytes = [Some(100_000_000), Some(0)];
        let least = |statistics: Option<&BTreeMap<String, u64>>| roofline.least(bytes, statistics, 4.0).unwrap();
        let memory = Least { least_ms: 1.0, share: 0.25, bound: Bound::Memory, is_impossible: false };
        assert_eq!([least(None), least(Some(&counts(1_000_000, 1_000_000)))], [memory; 2]);
        let triangles = least(Some(&counts(4_000_000, 1_000_000)));
        assert_eq!((triangles.least_ms, triangles.bound, triangles.is_impossible), (2.0, Bound::Triangles, false));
        let fragments = least(Some(&counts(4_000_000, 45_000_000)));
        assert_eq!((fragments.least_ms, fragments.bound, fragments.is_impossible), (4.5, Bound::Fragments, true));
        assert!(fragments.remark().starts_with("impossible: ") && triangles.remark().is_empty());
        // What is not known takes no time.
        assert_eq!(roofline.least([None; 2], Some(&counts(4_000_000, 1_000_000)), 4.0), Some(triangles));
        assert_eq!(roofline.least([bytes[0], None], None, 4.0), Some(memory));
        assert_eq!(roofline.least([None; 2], None, 4.0), None);
        // Rows of before triangles were measured.
        let roofline = Roofline::of(&rows[..3]).unwrap();
        assert_eq!(roofline.least(bytes, Some(&counts(1 << 40, 1 << 40)), 4.0), Some(memory));
        assert_eq!(serde_json::to_value(Bound::Fragments).unwrap(), Bound::Fragments.name());
    }

    #[test]
    fn rows_that_tell_nothing_are_refused() {
        let whole = rows([100.0; 3]);
        let refused = |rows: &[WorkRow], word: &str| {
            let error = Roofline::of(rows).unwrap_err();
            assert!(error.exit_code() == 2 && error.message().contains(word), "{error}");
        };
        refused(&[], "no rows");
        refused(&whole[1..], "`read`");
        refused(&[whole[0].clone(), whole[2].clone()], "`write` or `clear`");
        refused(&whole[..2], "`shader copy` or `copy command`");
        refused(&rows([0.0, 100.0, 100.0]), "`read`");
        let mut mixed = whole.clone();
        mixed[1].device.driver_info = "2.0".to_owned();
        refused(&mixed, "a device (1.0) and of a device (2.0)");
        let error = Roofline::of(&whole).unwrap().require(&mixed[1].device, "this device").unwrap_err();
        assert!(error.exit_code() == 2 && error.message().contains("this device is a device (2.0)"), "{error}");
    }

    #[test]
    fn a_line_that_is_no_row_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rows.jsonl");
        let text = |rows: &[WorkRow]| rows.iter().map(|row| row.line() + "\n").collect::<String>();
        let whole = rows([100.0; 3]);
        std::fs::write(&path, text(&whole)).unwrap();
        assert_eq!(WorkRow::read(&path).unwrap(), whole);
        let of_rays = WorkRow { bench: "rays".to_owned(), ..whole[0].clone() };
        for (line, word) in [("{}\n", "schema"), (&text(&[of_rays]), "`bench rays`"), ("read\n", "expected")] {
            std::fs::write(&path, text(&whole) + "\n" + line).unwrap();
            let error = Roofline::read(&path).unwrap_err();
            let said = error.to_string();
            assert!(error.exit_code() == 2 && said.contains("rows.jsonl:5: ") && said.contains(word), "{said}");
        }
    }
}
