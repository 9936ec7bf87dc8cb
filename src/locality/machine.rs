//! Machines as far as memory goes: warps, cores, caches, how images lie; those that are known, as data with their sources, and drawn ones.

use super::cache::Shape;
use super::layout::Layout;
use crate::choice::Choice;
use crate::error::{Error, Result};
use crate::sampling::pcg::Pcg32;
use crate::units::Bytes;
use serde::{Deserialize, Serialize};

/// A machine.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Machine {
    pub name: String,
    /// Where its numbers are from.
    pub source: String,
    /// Fields whose numbers nobody published: they are assumed.
    pub assumed: Vec<String>,
    /// Invocations of a warp, across and down where a workgroup is made of such rectangles.
    pub warp: [u32; 2],
    /// Cores, each with a first cache.
    pub cores: u32,
    /// Warps that a core has at once.
    pub resident_warps: u32,
    /// The cache of a core: writes go through it.
    pub first: Shape,
    /// The cache of all of them: writes stay in it until their line makes room.
    pub second: Shape,
    /// How images lie in memory, a word of `Layout`.
    pub layout: String,
    /// Bytes a second between the caches, in parts of those from memory.
    pub second_speed: f64,
}

/// Bounds of what a file may ask for: every core has a cache of its own in the host's memory.
const MOST_COUNT: u32 = 1024;
const MOST_BYTES: u64 = 64 << 20;

/// Those that are known; docs/locality.md has them as a table.
const KNOWN: [&str; 4] = [
    include_str!("../../assets/machines/volta-v100.json"),
    include_str!("../../assets/machines/maxwell-gtx980.json"),
    include_str!("../../assets/machines/rdna2-navi22.json"),
    include_str!("../../assets/machines/assumed-2004.json"),
];

impl Machine {
    /// All that are known.
    pub fn all() -> Vec<Self> {
        KNOWN.iter().map(|text| serde_json::from_str(text).expect("a test reads them")).collect()
    }

    /// Errors: none has this name (exit code 2).
    pub fn known(name: &str) -> Result<Self> {
        let all = Self::all();
        let names = all.iter().map(|machine| machine.name.clone()).collect::<Vec<_>>().join(", ");
        all.into_iter()
            .find(|machine| machine.name == name)
            .ok_or_else(|| Error::request(format!("there is no machine {name}")).note(format!("there are {names}")))
    }

    /// Errors: its numbers contradict each other (exit code 2).
    pub fn check(&self) -> Result<()> {
        let wrong = |why: String| Err(Error::request(format!("machine {}: {why}", self.name)));
        for (name, shape) in [("first", &self.first), ("second", &self.second)] {
            if let Some(why) = shape.fault() {
                return wrong(format!("{name}: {why}"));
            }
        }
        let [ours, theirs] = [self.first.sector_bytes, self.second.sector_bytes];
        if ours % theirs != 0 && theirs % ours != 0 {
            return wrong(format!("sectors of {ours} and {theirs} bytes do not fit each other"));
        }
        let counts = [self.warp[0], self.warp[1], self.cores, self.resident_warps];
        if counts.iter().any(|count| !(1..=MOST_COUNT).contains(count)) {
            return wrong(format!("sides of a warp, cores and warps are 1 to {MOST_COUNT}"));
        }
        if [self.first, self.second].iter().any(|shape| shape.bytes > MOST_BYTES) {
            return wrong(format!("a cache has at most {}", Bytes(MOST_BYTES)));
        }
        match self.second_speed.is_finite() && self.second_speed > 0.0 && Layout::from_word(&self.layout).is_some() {
            true => Ok(()),
            false => wrong(format!("second_speed is above 0, and layout one of {}", Layout::WORDS.join(", "))),
        }
    }

    pub fn layout(&self) -> Layout {
        Layout::from_word(&self.layout).expect("`check` has read it")
    }

    /// A machine of no maker, with sizes such as those of the last twenty years; `number`: which of them.
    pub fn drawn(seed: u64, number: u64) -> Self {
        let mut pcg = Pcg32::new(seed, number);
        let mut one_of = |choices: &[u64]| choices[pcg.below(choices.len() as u32) as usize];
        let line_bytes = one_of(&[32, 64, 128]);
        let sector_bytes = one_of(&[32, 64, 128]).min(line_bytes);
        let lanes = one_of(&[16, 32, 64]) as u32;
        let down = one_of(&[1, 2, 4]) as u32;
        let cores = one_of(&[1, 4, 16]) as u32;
        let first = Shape {
            bytes: 1024 * one_of(&[1, 2, 4, 8, 16, 32, 64]),
            line_bytes,
            sector_bytes,
            ways: one_of(&[2, 4, 8]),
        };
        let second = Shape {
            bytes: 1024 * one_of(&[16, 64, 256, 1024, 4096]),
            line_bytes: line_bytes.max(64),
            sector_bytes: sector_bytes.min(64),
            ways: one_of(&[4, 8, 16]),
        };
        let layout = Layout::WORDS[one_of(&[0, 1, 2]) as usize].to_owned();
        let resident_warps = one_of(&[2, 8, 32]) as u32;
        let second_speed = one_of(&[2, 3, 4, 6]) as f64;
        Self {
            name: format!("drawn-{number}"),
            source: format!("drawn from seed {seed}"),
            assumed: Vec::new(),
            warp: [lanes / down, down],
            cores,
            resident_warps,
            first,
            second,
            layout,
            second_speed,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_known_machines_can_be_and_say_where_they_are_from() {
        for machine in Machine::all() {
            machine.check().unwrap();
            assert!(machine.source.len() > 20, "{}", machine.name);
            let fields = serde_json::to_value(&machine).unwrap();
            assert!(
                machine.assumed.iter().all(|field| field.split('.').try_fold(&fields, |at, key| at.get(key)).is_some()),
                "{}",
                machine.name
            );
        }
        let error = Machine::known("voodoo").unwrap_err();
        assert!(error.exit_code() == 2 && error.to_string().contains("volta-v100"), "{error}");
    }

    #[test]
    fn drawn_machines_can_be_and_differ() {
        let mut shapes = std::collections::HashSet::new();
        for number in 0..500 {
            let machine = Machine::drawn(1, number);
            machine.check().unwrap();
            shapes.insert(format!("{:?} {:?} {:?}", machine.first, machine.second, machine.warp));
        }
        assert!(shapes.len() > 480, "{}", shapes.len());
        assert_eq!(Machine::drawn(1, 7), Machine::drawn(1, 7));
    }

    #[test]
    fn machines_that_cannot_be_are_refused() {
        let with = |change: fn(&mut Machine)| {
            let mut machine = Machine::known("volta-v100").unwrap();
            change(&mut machine);
            machine.check().unwrap_err().message().to_owned()
        };
        assert!(with(|machine| machine.first.ways = 0).contains("first: a size is 0"));
        assert!(with(|machine| machine.cores = 0).contains("cores and warps are 1 to 1024"));
        assert!(with(|machine| machine.warp = [u32::MAX, 1]).contains("1 to 1024"));
        assert!(with(|machine| machine.second.bytes <<= 20).contains("at most 64.0 MiB"));
        assert!(with(|machine| machine.layout = "round".to_owned()).contains("layout"));
        assert!(with(|machine| machine.second_speed = f64::NAN).contains("second_speed"));
        assert!(
            with(|machine| machine.second = Shape { bytes: 48 * 16, line_bytes: 48, sector_bytes: 48, ways: 4 })
                .contains("do not fit")
        );
    }
}
