//! Lifetimes: from which pass to which a resource is needed, and how many bytes live in each pass.

use super::{Plan, Sharing};
use crate::gpu::AccessSet;

/// First and last pass of a transient resource, inclusive. A resource that is read back after the frame lives in the
/// pass after the last.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Lifetime {
    pub first: usize,
    pub last: usize,
}

/// The greatest sum of live bytes, and where it falls.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Peak {
    pub bytes: u64,
    pub pass: String,
}

/// Index used for the pass after the last.
const READBACK: &str = "readback";

impl Plan {
    /// Lives inside a frame; None: kept from frame to frame.
    pub fn lifetime(&self, resource: usize) -> Option<Lifetime> {
        if self.resources[resource].is_kept {
            return None;
        }
        let touching = || {
            let touches = |pass: &super::PlannedPass| pass.touches.iter().any(|touch| touch.resource == resource);
            self.passes.iter().enumerate().filter(move |(_, pass)| touches(pass)).map(|(index, _)| index)
        };
        let first = touching().next()?;
        let last = if self.resources[resource].read_back { Some(self.passes.len()) } else { touching().next_back() };
        Some(Lifetime { first, last: last? })
    }

    /// Whether the resource lives inside a frame: its bytes may be another's before and after.
    pub fn is_transient(&self, resource: usize) -> bool {
        self.lifetime(resource).is_some()
    }

    /// Name of the pass of this index; `readback` after the last.
    pub fn pass_name(&self, index: usize) -> &str {
        self.passes.get(index).map_or(READBACK, |pass| pass.name.as_str())
    }

    /// Accesses that the next owner of the bytes waits for: the last write, or all reads since.
    pub fn last_accesses(&self, resource: usize) -> AccessSet {
        let touches = self.passes.iter().flat_map(|pass| &pass.touches).filter(|touch| touch.resource == resource);
        touches.fold(AccessSet::UNTOUCHED, |known, touch| known.after(touch.access))
    }

    /// Sums of `bound_bytes` (one a resource, in order) in each pass, one at least, `kept_bytes` more in each. What shares its
    /// bytes counts while it lives; what has bytes of its own holds them in every pass.
    pub fn held_bytes(&self, bound_bytes: &[u64], kept_bytes: u64, sharing: &Sharing) -> Vec<u64> {
        self.sums(bound_bytes, kept_bytes, |resource| sharing.part(resource).is_none())
    }

    /// The same of what lives in each pass.
    pub fn live_bytes(&self, bound_bytes: &[u64], kept_bytes: u64) -> Vec<u64> {
        self.sums(bound_bytes, kept_bytes, |_| false)
    }

    fn sums(&self, bound_bytes: &[u64], kept_bytes: u64, is_always: impl Fn(usize) -> bool) -> Vec<u64> {
        let lifetimes: Vec<Option<Lifetime>> = (0..self.resources.len())
            .map(|resource| self.lifetime(resource).filter(|_| !is_always(resource)))
            .collect();
        let in_pass = |pass: usize| {
            let lives = |lifetime: &Option<Lifetime>| {
                lifetime.is_none_or(|lifetime| lifetime.first <= pass && pass <= lifetime.last)
            };
            let living = lifetimes.iter().zip(bound_bytes).filter(|(lifetime, _)| lives(lifetime));
            kept_bytes + living.map(|(_, bytes)| bytes).sum::<u64>()
        };
        (0..self.passes.len().max(1)).map(in_pass).collect()
    }

    /// The greatest of `held_bytes`.
    pub fn peak(&self, bound_bytes: &[u64], kept_bytes: u64, sharing: &Sharing) -> Peak {
        let held = self.held_bytes(bound_bytes, kept_bytes, sharing);
        // The first of equals: a later pass must need more to be called the peak.
        let (pass, bytes) = held.into_iter().enumerate().rev().max_by_key(|(_, bytes)| *bytes).expect("at least one");
        Peak { bytes, pass: self.pass_name(pass).to_owned() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::caps::{Limits, known};
    use crate::gpu::Access;
    use crate::memory::alias::Mode;
    use crate::plan::Requirements;

    fn plan() -> Plan {
        let mut plan = Plan::default();
        for (name, bytes) in [("kept", 100), ("a", 1000), ("b", 2000), ("c", 4000)] {
            plan.buffer("test", name, bytes);
        }
        let touch = |name: &str, access| (name.to_owned(), access);
        plan.pass("first", [touch("a", Access::ComputeWrite)]);
        plan.pass("second", [touch("a", Access::ComputeRead), touch("b", Access::ComputeWrite)]);
        plan.pass("third", [touch("b", Access::GraphicsRead), touch("c", Access::ComputeWrite)]);
        plan.pass("fourth", [touch("b", Access::ComputeRead), touch("c", Access::ComputeRead)]);
        plan
    }

    #[test]
    fn a_resource_lives_from_its_first_pass_to_its_last() {
        let mut plan = plan();
        let of = |plan: &Plan, index| plan.lifetime(index).map(|lifetime| (lifetime.first, lifetime.last));
        assert_eq!([of(&plan, 0), of(&plan, 1), of(&plan, 2)], [None, Some((0, 1)), Some((1, 3))]);
        plan.read_back("a");
        assert_eq!(of(&plan, 1), Some((0, 4)));
        assert_eq!(plan.pass_name(4), "readback");
        plan.keep("a");
        assert_eq!(of(&plan, 1), None);
    }

    #[test]
    fn the_peak_falls_where_most_bytes_live() {
        let plan = plan();
        let bytes: Vec<u64> = plan.resources.iter().map(|planned| planned.bytes()).collect();
        let caps = known::caps(known::DEFAULT).unwrap();
        let rules = Requirements::Rules(caps.layout.as_ref().unwrap());
        let limits = Limits { buffer_image_granularity_bytes: 1, ..caps.limits.clone() };
        let peak = |mode| plan.peak(&bytes, 10, &Sharing::new(&plan, rules, &limits, mode));
        for mode in [Mode::Greedy, Mode::Optimal] {
            assert_eq!(peak(mode), Peak { bytes: 10 + 100 + 2000 + 4000, pass: "third".to_owned() });
        }
        assert_eq!(plan.live_bytes(&bytes, 10), [1110, 3110, 6110, 6110]);
        let held = |mode| plan.held_bytes(&bytes, 10, &Sharing::new(&plan, rules, &limits, mode));
        assert_eq!(held(Mode::Off), [7110; 4]);
        // Nobody gives bytes back: every pass has all of them.
        assert_eq!(peak(Mode::Off), Peak { bytes: 10 + 100 + 1000 + 2000 + 4000, pass: "first".to_owned() });
    }

    /// Parts that lie a granularity apart may take more together than they share, and all of them more than a block.
    #[test]
    fn bytes_are_shared_where_that_saves_some() {
        let plan = plan();
        let caps = known::caps(known::DEFAULT).unwrap();
        let rules = Requirements::Rules(caps.layout.as_ref().unwrap());
        let arenas = |buffer_image_granularity_bytes, max_allocation_bytes| {
            let limits = Limits { buffer_image_granularity_bytes, max_allocation_bytes, ..caps.limits.clone() };
            Sharing::new(&plan, rules, &limits, Mode::Greedy).arenas
        };
        for (granularity_bytes, expected) in [(1, 1), (64, 1), (4096, 1), (131_072, 0)] {
            assert_eq!(arenas(granularity_bytes, u64::MAX).len(), expected, "{granularity_bytes}");
        }
        let bytes = arenas(1, u64::MAX)[0].bytes;
        assert_eq!([bytes, bytes - 1].map(|most| arenas(1, most).len()), [1, 0]);
    }

    #[test]
    fn who_takes_bytes_over_waits_for_every_reader_since_the_last_write() {
        let plan = plan();
        assert_eq!(plan.last_accesses(2), Access::GraphicsRead | Access::ComputeRead);
        assert_eq!(plan.last_accesses(1), Access::ComputeRead.into());
        assert_eq!(plan.last_accesses(0), AccessSet::UNTOUCHED);
    }
}
