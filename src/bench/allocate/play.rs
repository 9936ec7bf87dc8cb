//! A trace played through one allocator, and the bytes that it came to.

use crate::memory::pool::Ask;
use crate::memory::trace::{Event, Trace};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;

/// Places of a trace at which its fragmentation is looked at, at most: an allocator of others may walk all that is live.
const FRAGMENTATION_LOOKS: usize = 4096;

/// One step: slots are numbers of live allocations, used again when they are free, so that a player finds its own without a
/// search.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    Take { slot: usize, ask: Ask },
    Give { slot: usize },
}

/// A trace that is ready to be played.
#[derive(Clone, Debug)]
pub struct Script {
    steps: Vec<Step>,
    slot_count: usize,
    /// Gives everything back that is live at the end.
    rest: Vec<usize>,
}

impl Script {
    pub fn new(trace: &Trace) -> Self {
        let (mut slots, mut free, mut slot_count) = (HashMap::new(), Vec::new(), 0);
        let steps = trace.events().iter().map(|event| match event {
            Event::Take { id, ask, .. } => {
                let slot = free.pop().unwrap_or_else(|| {
                    slot_count += 1;
                    slot_count - 1
                });
                slots.insert(*id, slot);
                Step::Take { slot, ask: *ask }
            }
            Event::Give { id } => {
                let slot = slots.remove(id).expect("a trace gives what it took");
                free.push(slot);
                Step::Give { slot }
            }
        });
        let steps = steps.collect();
        let mut rest: Vec<usize> = slots.into_values().collect();
        rest.sort_unstable();
        Self { steps, slot_count, rest }
    }

    /// Slots that a player must have.
    pub fn slot_count(&self) -> usize {
        self.slot_count
    }

    /// Takes and gives of a whole replay, which are twice the takes.
    pub fn operation_count(&self) -> usize {
        self.steps.len() + self.rest.len()
    }

    /// Plays it once.
    ///
    /// Errors: the place of a take that was refused, and why; what was taken before it stays.
    pub fn play(&self, player: &mut dyn Player) -> Result<(), (usize, String)> {
        for (at, step) in self.steps.iter().enumerate() {
            match step {
                Step::Take { slot, ask } => player.take(*slot, ask).map_err(|why| (at, why))?,
                Step::Give { slot } => player.give(*slot),
            }
        }
        self.rest.iter().for_each(|slot| player.give(*slot));
        Ok(())
    }

    /// Plays it once and looks at the bytes.
    ///
    /// Errors: as `play`.
    pub fn measure(&self, player: &mut dyn Accounted) -> Result<Measures, (usize, String)> {
        let mut measures = Measures { operations: self.operation_count() as u64, ..Measures::default() };
        let mut live = vec![0; self.slot_count];
        let mut live_bytes = 0;
        let stride = self.steps.len().div_ceil(FRAGMENTATION_LOOKS);
        for (at, step) in self.steps.iter().enumerate() {
            match step {
                Step::Take { slot, ask } => {
                    player.take(*slot, ask).map_err(|why| (at, why))?;
                    live[*slot] = ask.bytes;
                    live_bytes += ask.bytes;
                }
                Step::Give { slot } => {
                    player.give(*slot);
                    live_bytes -= std::mem::take(&mut live[*slot]);
                }
            }
            measures.peak_live_bytes = measures.peak_live_bytes.max(live_bytes);
            let held = player.held_bytes();
            let is_peak = held > measures.peak_bytes;
            let is_last = at + 1 == self.steps.len();
            if !is_peak && !is_last && at % stride != 0 {
                continue;
            }
            let state = player.state(live_bytes);
            if is_peak {
                measures.peak_bytes = held;
                measures.at_peak = state.waste(live_bytes);
            }
            measures.memory_blocks = measures.memory_blocks.max(state.memory_blocks);
            measures.worst_fragmentation = measures.worst_fragmentation.max(state.fragmentation());
            if is_last {
                measures.end_fragmentation = state.fragmentation();
            }
        }
        self.rest.iter().for_each(|slot| player.give(*slot));
        Ok(measures)
    }
}

/// What takes and gives.
pub trait Player {
    /// The slot is free.
    ///
    /// Errors: why there is no room, in words.
    fn take(&mut self, slot: usize, ask: &Ask) -> Result<(), String>;

    /// The slot is taken.
    fn give(&mut self, slot: usize);
}

/// What also knows its bytes.
pub trait Accounted: Player {
    /// Sum of the memory blocks now.
    fn held_bytes(&self) -> u64;

    /// All of them now, while so much is live.
    fn state(&self, live_bytes: u64) -> State;
}

/// Memory blocks at a moment.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct State {
    pub memory_blocks: u64,
    pub bytes: u64,
    /// In no live range.
    pub free_bytes: u64,
    /// The greatest of what can be taken in one piece.
    pub largest_free_bytes: u64,
    pub padding_bytes: u64,
    pub gap_bytes: u64,
    pub lost_bytes: u64,
}

impl State {
    /// 1 - largest free range / all free bytes; 0 where nothing is free.
    fn fragmentation(&self) -> f64 {
        if self.free_bytes == 0 { 0.0 } else { 1.0 - self.largest_free_bytes as f64 / self.free_bytes as f64 }
    }

    fn waste(&self, live_bytes: u64) -> Waste {
        let Self { bytes, padding_bytes, gap_bytes, lost_bytes, .. } = *self;
        let free_bytes = bytes.saturating_sub(live_bytes + padding_bytes + gap_bytes + lost_bytes);
        Waste { live_bytes, padding_bytes, gap_bytes, lost_bytes, free_bytes }
    }
}

/// Memory blocks by what is in them: the sum is their bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Waste {
    /// What was asked for.
    pub live_bytes: u64,
    /// Ranges are longer than what was asked for.
    pub padding_bytes: u64,
    /// Left out to align ranges, where nothing else may lie.
    pub gap_bytes: u64,
    /// Came back, and are taken again only when their memory block is empty.
    pub lost_bytes: u64,
    /// Others may take them.
    pub free_bytes: u64,
}

/// Bytes of a replay.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Measures {
    /// Takes and gives of a whole replay.
    pub operations: u64,
    /// Greatest sum of what was live at once.
    pub peak_live_bytes: u64,
    /// Greatest sum of the memory blocks.
    pub peak_bytes: u64,
    /// The first moment of that.
    pub at_peak: Waste,
    /// Greatest number of memory blocks.
    pub memory_blocks: u64,
    /// After the last event of the trace, before the rest is given back.
    pub end_fragmentation: f64,
    pub worst_fragmentation: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::memory::Tiling;

    /// One endless memory block that never takes a byte again.
    #[derive(Default)]
    struct Heap {
        live: HashMap<usize, u64>,
        end: u64,
    }

    impl Player for Heap {
        fn take(&mut self, slot: usize, ask: &Ask) -> Result<(), String> {
            if ask.bytes > 1000 {
                return Err("too large".to_owned());
            }
            assert!(self.live.insert(slot, ask.bytes).is_none(), "the slot is taken");
            self.end += ask.bytes;
            Ok(())
        }

        fn give(&mut self, slot: usize) {
            self.live.remove(&slot).expect("the slot is taken");
        }
    }

    impl Accounted for Heap {
        fn held_bytes(&self) -> u64 {
            self.end
        }

        fn state(&self, live_bytes: u64) -> State {
            assert_eq!(live_bytes, self.live.values().sum::<u64>());
            let free_bytes = self.end - live_bytes;
            State { memory_blocks: 1, bytes: self.end, free_bytes, lost_bytes: free_bytes, ..State::default() }
        }
    }

    fn trace(steps: &[(u64, u64)]) -> Trace {
        let ask =
            |bytes| Ask { bytes, alignment: 1, type_index: 0, mapped: false, tiling: Tiling::Linear, alone: false };
        let event = |(id, bytes): &(u64, u64)| match bytes {
            0 => Event::Give { id: *id },
            bytes => Event::Take { id: *id, name: String::new(), ask: ask(*bytes) },
        };
        Trace::new("t", steps.iter().map(event).collect(), 1).unwrap()
    }

    #[test]
    fn bytes_are_those_of_the_moment() {
        let script = Script::new(&trace(&[(7, 100), (8, 50), (7, 0), (9, 30), (8, 0)]));
        assert_eq!((script.slot_count(), script.operation_count()), (2, 6));
        let mut heap = Heap::default();
        let found = script.measure(&mut heap).unwrap();
        let at_peak = Waste { live_bytes: 80, lost_bytes: 100, ..Waste::default() };
        let expected = Measures {
            operations: 6,
            peak_live_bytes: 150,
            peak_bytes: 180,
            at_peak,
            memory_blocks: 1,
            end_fragmentation: 1.0,
            worst_fragmentation: 1.0,
        };
        assert_eq!(found, expected);
        assert!(heap.live.is_empty(), "all of it comes back");
        script.play(&mut heap).unwrap();
        assert_eq!((heap.live.len(), heap.end), (0, 360));
    }

    #[test]
    fn what_is_refused_says_where() {
        let script = Script::new(&trace(&[(1, 10), (2, 1001)]));
        let refused = Err((1, "too large".to_owned()));
        assert_eq!(script.measure(&mut Heap::default()).map(drop), refused);
        assert_eq!(script.play(&mut Heap::default()), refused);
    }
}
