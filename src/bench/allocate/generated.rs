//! Traces that nobody has recorded: what a renderer asks for frame by frame, what is drawn at random, and for each strategy
//! one that it is bad at. The same parameters make the same trace on every machine.

use crate::caps::Caps;
use crate::choice::{Choice, choices};
use crate::error::{Error, Result};
use crate::memory::Tiling;
use crate::memory::kinds::{Kinds, Use};
use crate::memory::pool::Ask;
use crate::memory::trace::{Event, Trace};
use crate::sampling::pcg::Pcg32;

const KIB: u64 = 1 << 10;
/// `count` at most: traces are bounded as those of files are.
const MOST_COUNT: u64 = 10_000;

choices! {
    /// Traces by name.
    pub enum Generated {
        /// A scene is loaded, then frames have targets of their own, some of which the next frame reads.
        "frames" => Frames,
        /// Sizes and alignments of all orders, taken and given in any order.
        "random" => Random,
        /// One resource of each group stays: memory blocks never become empty (bad for linear ranges).
        "pinned" => Pinned,
        /// More small resources at once than a device makes memory blocks (bad for dedicated ones).
        "tiny" => Tiny,
        /// A little more than powers of two (bad for halves of halves).
        "above-powers" => AbovePowers,
        /// Holes of two sizes of one class, of which only the larger ones are wanted again (bad for classes of sizes).
        "near-misses" => NearMisses,
    }
}

impl Generated {
    /// In words, for help.
    pub fn summary(self) -> &'static str {
        match self {
            Self::Frames => "a scene, then frames with targets of their own",
            Self::Random => "all sizes in any order",
            Self::Pinned => "one of each group stays, bad for linear",
            Self::Tiny => "many small ones at once, bad for dedicated",
            Self::AbovePowers => "a little more than powers of two, bad for buddy",
            Self::NearMisses => "holes of two sizes of one class, bad for tlsf",
        }
    }

    /// Frames, operations, groups or resources, as `count` says; such that a trace has some thousand events.
    fn default_count(self) -> u64 {
        match self {
            Self::Frames => 120,
            Self::Random => 4000,
            Self::Pinned => 100,
            Self::Tiny => 5000,
            Self::AbovePowers => 1000,
            Self::NearMisses => 600,
        }
    }

    fn stream(self) -> u64 {
        Self::ALL.iter().position(|one| *one == self).expect("it is one of them") as u64
    }
}

/// The trace that `text` names: `NAME` or `NAME:count=N,seed=N`, its memory types chosen among those of `caps`.
///
/// Errors: no such name or parameter, or a number out of range (exit code 2).
pub fn generated(text: &str, caps: &Caps) -> Result<Trace> {
    let (name, arguments) = text.split_once(':').map_or((text, None), |(name, rest)| (name, Some(rest)));
    let refused = |why: String| Error::request(format!("{text}: {why}"));
    let kind = Generated::from_word(name).ok_or_else(|| {
        refused("there is no such trace".to_owned())
            .note(format!("there are {}; a file's name ends in .jsonl", Generated::WORDS.join(", ")))
    })?;
    let (mut count, mut seed) = (kind.default_count(), 1);
    for argument in arguments.into_iter().flat_map(|arguments| arguments.split(',')) {
        let number = |key: &str| argument.strip_prefix(key).and_then(|number| number.parse().ok());
        match (number("count="), number("seed=")) {
            (Some(number), _) if (1..=MOST_COUNT).contains(&number) => count = number,
            (_, Some(number)) => seed = number,
            _ => return Err(refused(format!("{argument}: it must be count=1 to {MOST_COUNT}, or seed=N"))),
        }
    }
    let mut made = Made::new(caps, Pcg32::new(seed, kind.stream()))?;
    match kind {
        Generated::Frames => made.frames(count),
        Generated::Random => made.random(count),
        Generated::Pinned => made.pinned(count),
        Generated::Tiny => made.tiny(count),
        Generated::AbovePowers => made.above_powers(count),
        Generated::NearMisses => made.near_misses(count),
    }
    Trace::new(text, made.events, 1)
}

/// A trace that grows.
struct Made {
    events: Vec<Event>,
    next: u64,
    random: Pcg32,
    device_type: u32,
    upload_type: u32,
}

impl Made {
    fn new(caps: &Caps, random: Pcg32) -> Result<Self> {
        let kinds = Kinds::new(caps);
        let of = |usage| Ok(kinds.choose(usage, u32::MAX)?.type_index);
        let (device_type, upload_type) = (of(Use::Device)?, of(Use::Upload)?);
        Ok(Self { events: Vec::new(), next: 0, random, device_type, upload_type })
    }

    fn take(&mut self, name: &str, ask: Ask) -> u64 {
        self.next += 1;
        self.events.push(Event::Take { id: self.next, name: name.to_owned(), ask });
        self.next
    }

    fn give(&mut self, id: u64) {
        self.events.push(Event::Give { id });
    }

    fn buffer(&mut self, name: &str, bytes: u64) -> u64 {
        let (alignment, type_index) = (256, self.device_type);
        self.take(name, Ask { bytes, alignment, type_index, mapped: false, tiling: Tiling::Linear, alone: false })
    }

    fn image(&mut self, name: &str, bytes: u64) -> u64 {
        let (alignment, type_index) = (4096, self.device_type);
        self.take(name, Ask { bytes, alignment, type_index, mapped: false, tiling: Tiling::Optimal, alone: false })
    }

    /// A resource that the host fills by a copy.
    fn filled(&mut self, name: &str, bytes: u64, is_image: bool) -> u64 {
        let id = if is_image { self.image(name, bytes) } else { self.buffer(name, bytes) };
        let (alignment, type_index) = (64, self.upload_type);
        let copy = Ask { bytes, alignment, type_index, mapped: true, tiling: Tiling::Linear, alone: false };
        let copy = self.take(&format!("upload.{name}"), copy);
        self.give(copy);
        id
    }

    /// Bytes whose logarithm is even between two powers of two, a multiple of 4.
    fn size(&mut self, least_power: u32, most_power: u32) -> u64 {
        let power = self.random.between(least_power as f32, most_power as f32);
        (f64::from(power).exp2() as u64).next_multiple_of(4)
    }

    fn frames(&mut self, count: u64) {
        for index in 0..40 {
            // RGBA8 with its levels: a third more.
            let side = 128u64 << self.random.below(5);
            self.filled(&format!("scene.texture.{index}"), (4 * side * side * 4 / 3).next_multiple_of(4096), true);
            let bytes = self.size(10, 21);
            self.filled(&format!("scene.mesh.{index}"), bytes, false);
        }
        let mut history: Vec<u64> = Vec::new();
        for frame in 0..count {
            // The window changes its size now and then, and the targets with it.
            let pixels = 640 * 360 * (1 + frame / 30 % 4);
            let mut targets = Vec::new();
            for (name, bytes_per_pixel) in
                [("frame.albedo", 4), ("frame.normal", 8), ("frame.depth", 4), ("frame.light", 8), ("frame.color", 16)]
            {
                targets.push(self.image(name, (pixels * bytes_per_pixel).next_multiple_of(4096)));
            }
            let lights = 64 * u64::from(1 + self.random.below(4096));
            targets.push(self.buffer("frame.lights", lights));
            targets.push(self.buffer("frame.tiles", pixels / 4));
            history.drain(..).for_each(|id| self.give(id));
            // Color and normal are the next frame's history.
            for (index, id) in targets.into_iter().enumerate() {
                if [1, 4].contains(&index) { history.push(id) } else { self.give(id) }
            }
        }
    }

    fn random(&mut self, count: u64) {
        let mut live: Vec<u64> = Vec::new();
        for index in 0..count {
            if !live.is_empty() && self.random.below(100) < 45 {
                let which = self.random.below(live.len() as u32) as usize;
                let id = live.swap_remove(which);
                self.give(id);
                continue;
            }
            let bytes = self.size(8, 22);
            let alignment = 16 << self.random.below(13);
            let tiling = if self.random.below(2) == 0 { Tiling::Linear } else { Tiling::Optimal };
            let ask = Ask { bytes, alignment, type_index: self.device_type, mapped: false, tiling, alone: false };
            live.push(self.take(&format!("random.{index}"), ask));
        }
    }

    fn pinned(&mut self, count: u64) {
        for group in 0..count {
            let ids: Vec<u64> = (0..32)
                .map(|_| {
                    let bytes = self.size(12, 17);
                    self.buffer(&format!("group.{group}"), bytes)
                })
                .collect();
            let stays = self.random.below(32) as usize;
            for (index, id) in ids.into_iter().enumerate() {
                if index != stays {
                    self.give(id);
                }
            }
        }
    }

    fn tiny(&mut self, count: u64) {
        for _ in 0..count {
            let bytes = self.size(6, 10);
            self.buffer("tiny", bytes);
        }
    }

    fn above_powers(&mut self, count: u64) {
        for _ in 0..count {
            let power = 12 + self.random.below(9);
            self.buffer("above", (1 << power) + 256);
        }
    }

    /// 64 KiB and a little below 66 KiB are one class of two-level segregated fit, whose list has the smaller ones first. What
    /// stays between holes is too large for what is left at the ends of memory blocks, where it would keep nothing apart.
    fn near_misses(&mut self, count: u64) {
        let (small, large) = (64 * KIB, 66 * KIB - 256);
        let (mut smalls, mut larges) = (Vec::new(), Vec::new());
        for _ in 0..count {
            smalls.push(self.buffer("small", small));
            self.buffer("between", small);
            larges.push(self.buffer("large", large));
            self.buffer("between", small);
        }
        larges.into_iter().chain(smalls).for_each(|id| self.give(id));
        for _ in 0..count {
            self.buffer("large again", large);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::caps::known;
    use std::collections::BTreeMap;

    #[test]
    fn every_name_makes_a_trace_and_the_same_one_again() {
        let caps = known::caps("nvidia-rtx-2070").unwrap();
        for name in Generated::WORDS {
            let [first, again, other] =
                ["", ":seed=1", ":seed=2"].map(|more| generated(&format!("{name}{more}"), &caps).unwrap());
            assert_eq!(first.events(), again.events());
            // Nothing of the last one is drawn.
            assert_eq!(first.events() != other.events(), *name != "near-misses", "{name}");
            assert!((1000..20_000).contains(&first.events().len()), "{name}: {}", first.events().len());
            let few = generated(&format!("{name}:count=3,seed=7"), &caps).unwrap();
            assert!(few.events().len() < first.events().len());
            // The most is no more than a trace may have.
            generated(&format!("{name}:count={MOST_COUNT}"), &caps).unwrap();
        }
    }

    #[test]
    fn uploads_lie_where_the_host_writes() {
        let caps = known::caps("nvidia-rtx-2070").unwrap();
        let trace = generated("frames:count=1", &caps).unwrap();
        let mut types: BTreeMap<bool, u32> = BTreeMap::new();
        for event in trace.events() {
            if let Event::Take { ask, .. } = event {
                assert_eq!(*types.entry(ask.mapped).or_insert(ask.type_index), ask.type_index);
            }
        }
        assert_eq!(types, BTreeMap::from([(false, 1), (true, 2)]));
    }

    #[test]
    fn what_names_no_trace_is_refused() {
        let caps = known::caps("least-1.3").unwrap();
        for (text, words) in [
            ("frame", "frame: there is no such trace"),
            ("frames:count=0", "count=0: it must be count=1 to 10000"),
            ("frames:count=10001", "count=10001"),
            ("frames:seed=-1", "seed=-1"),
            ("frames:size=3", "size=3"),
            ("frames:", ": it must be"),
        ] {
            let error = generated(text, &caps).unwrap_err();
            assert!(error.exit_code() == 2 && error.to_string().contains(words), "{error} does not say {words}");
        }
    }
}
