//! A set-associative cache of lines that are filled by sectors; the least recently used line of a set makes room.

use serde::{Deserialize, Serialize};

/// Its shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shape {
    pub bytes: u64,
    pub line_bytes: u64,
    /// What is fetched at once: a line or a part of it.
    pub sector_bytes: u64,
    /// Lines of a set.
    pub ways: u64,
}

impl Shape {
    /// Why it cannot be; None where it can.
    pub fn fault(&self) -> Option<String> {
        let Self { bytes, line_bytes, sector_bytes, ways } = *self;
        if [bytes, line_bytes, sector_bytes, ways].contains(&0) {
            return Some("a size is 0".to_owned());
        }
        if line_bytes % sector_bytes != 0 || line_bytes / sector_bytes > 32 {
            return Some(format!("a line of {line_bytes} bytes is not made of up to 32 sectors of {sector_bytes}"));
        }
        let Some(set) = ways.checked_mul(line_bytes).filter(|set| *set <= bytes) else {
            return Some(format!("a set of {ways} lines of {line_bytes} is more than {bytes} bytes"));
        };
        (bytes % set != 0).then(|| format!("{bytes} bytes are not made of sets of {ways} lines of {line_bytes}"))
    }

    fn set_count(&self) -> u64 {
        self.bytes / (self.line_bytes * self.ways)
    }
}

#[derive(Clone, Copy, Default)]
struct Line {
    tag: u64,
    /// A bit a sector: those that are here, and those that memory does not have yet.
    held: u32,
    dirty: u32,
    /// When it was used last; 0: it is free.
    used: u64,
}

/// What became of an access to a sector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Outcome {
    pub is_hit: bool,
    /// Sectors that had to be written back to make room.
    pub written_back: u32,
}

pub struct Cache {
    shape: Shape,
    lines: Vec<Line>,
    now: u64,
}

impl Cache {
    pub fn new(shape: Shape) -> Self {
        Self { shape, lines: vec![Line::default(); (shape.set_count() * shape.ways) as usize], now: 0 }
    }

    /// Reads the sector that holds `address`: what is not there is fetched.
    pub fn read(&mut self, address: u64) -> Outcome {
        self.access(address, false)
    }

    /// Writes to the sector that holds `address`, and keeps it: nothing is fetched for it.
    pub fn write_back(&mut self, address: u64) -> Outcome {
        self.access(address, true)
    }

    fn access(&mut self, address: u64, is_write: bool) -> Outcome {
        self.now += 1;
        let number = address / self.shape.line_bytes;
        let sector = 1 << (address % self.shape.line_bytes / self.shape.sector_bytes);
        let (set, tag) = (number % self.shape.set_count(), number / self.shape.set_count());
        let first = (set * self.shape.ways) as usize;
        let lines = &mut self.lines[first..first + self.shape.ways as usize];
        let known = lines.iter().position(|line| line.used > 0 && line.tag == tag);
        let mut written_back = 0;
        let place = known.unwrap_or_else(|| {
            let oldest = (0..lines.len()).min_by_key(|place| lines[*place].used).expect("a set has lines");
            written_back = lines[oldest].dirty.count_ones();
            lines[oldest] = Line { tag, ..Line::default() };
            oldest
        });
        let line = &mut lines[place];
        line.used = self.now;
        let is_hit = line.held & sector != 0;
        line.held |= sector;
        if is_write {
            line.dirty |= sector;
        }
        Outcome { is_hit, written_back }
    }

    /// Sectors that memory does not have yet, which are written when all ends.
    pub fn dirty_sectors(&self) -> u64 {
        self.lines.iter().map(|line| u64::from(line.dirty.count_ones())).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two sets of two lines of 64 bytes in two sectors.
    const SMALL: Shape = Shape { bytes: 256, line_bytes: 64, sector_bytes: 32, ways: 2 };

    #[test]
    fn the_least_recently_used_line_makes_room() {
        let mut cache = Cache::new(SMALL);
        let hits = |cache: &mut Cache, addresses: &[u64]| -> Vec<bool> {
            addresses.iter().map(|address| cache.read(*address).is_hit).collect()
        };
        // Lines 0, 2 and 4 are of the first set; 0 was used after 2, so that 4 takes the place of 2.
        assert_eq!(hits(&mut cache, &[0, 128, 0, 256, 0, 128]), [false, false, true, false, true, false]);
        // Line 1 is of the other set.
        assert_eq!(hits(&mut cache, &[64, 64 + 31, 64 + 32, 64 + 63]), [false, true, false, true]);
    }

    #[test]
    fn what_was_written_goes_back_when_its_line_makes_room() {
        let mut cache = Cache::new(SMALL);
        cache.write_back(0);
        cache.write_back(32);
        cache.write_back(0);
        assert_eq!(cache.dirty_sectors(), 2);
        assert!(cache.read(32).is_hit, "what was written is there");
        cache.read(128);
        assert_eq!(cache.read(256), Outcome { is_hit: false, written_back: 2 });
        assert_eq!(cache.dirty_sectors(), 0);
    }

    #[test]
    fn shapes_that_cannot_be_are_named() {
        let with = |change: fn(&mut Shape)| {
            let mut shape = SMALL;
            change(&mut shape);
            shape.fault()
        };
        assert_eq!(SMALL.fault(), None);
        assert!(with(|shape| shape.ways = 0).unwrap().contains("0"));
        assert!(with(|shape| shape.sector_bytes = 24).unwrap().contains("sectors of 24"));
        assert!(with(|shape| shape.sector_bytes = 1).unwrap().contains("up to 32 sectors"));
        assert!(with(|shape| shape.ways = 3).unwrap().contains("sets of 3 lines"));
    }
}
