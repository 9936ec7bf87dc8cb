//! What could not be placed, and what would have had to be smaller: the pool's numbers played again.

use super::pool::{Ask, Pool, Rules};
use std::collections::BTreeMap;

/// A named need.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MemoryDemand {
    pub name: String,
    pub ask: Ask,
    /// Given back before the next one is made: a staging buffer.
    pub is_transient: bool,
}

/// What could not be placed, with everything that was held at that moment.
#[derive(Clone, Debug)]
pub struct Refusal {
    pub rules: Rules,
    /// In the order in which they were made.
    pub held: Vec<(String, Ask)>,
    pub name: String,
    pub ask: Ask,
}

impl Refusal {
    /// Whether it would have been placed, had the resources of these names been `wanted` so. Where not all of them were
    /// held yet, the others must find room after it.
    pub fn fits_with(&self, wanted: &[MemoryDemand]) -> bool {
        let mut to_come: BTreeMap<&str, &MemoryDemand> = wanted.iter().map(|one| (one.name.as_str(), one)).collect();
        let mut pool = Pool::new(self.rules.clone());
        let mut is_placed = |ask: &Ask, is_transient: bool| match pool.place(ask) {
            Ok(place) if is_transient => {
                pool.give_back(place.block, place.offset, ask.bytes);
                true
            }
            Ok(_) => true,
            Err(_) => false,
        };
        let is_held = |one: &MemoryDemand| self.held.iter().any(|(name, _)| *name == one.name);
        let none_to_come =
            !to_come.contains_key(self.name.as_str()) && wanted.iter().all(|one| one.is_transient || is_held(one));
        let mut known = self.held.iter().map(|(name, ask)| (name, ask)).chain([(&self.name, &self.ask)]);
        let fits = known.all(|(name, ask)| match to_come.remove(name.as_str()) {
            Some(one) => is_placed(&one.ask, one.is_transient),
            None => is_placed(ask, false),
        });
        if !fits || none_to_come {
            return fits;
        }
        let rest = |is_transient| {
            let later = wanted.iter().filter(move |one| one.is_transient == is_transient);
            later.filter(|one| to_come.contains_key(one.name.as_str()))
        };
        rest(false).chain(rest(true)).all(|one| is_placed(&one.ask, one.is_transient))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::memory::{Strategy, Tiling};

    const MIB: u64 = 1 << 20;

    fn ask(bytes: u64) -> Ask {
        Ask { bytes, alignment: 256, type_index: 0, mapped: false, tiling: Tiling::Linear, alone: false }
    }

    fn wanted(name: &str, bytes: u64, is_transient: bool) -> MemoryDemand {
        MemoryDemand { name: name.to_owned(), ask: ask(bytes), is_transient }
    }

    #[test]
    fn a_refusal_knows_what_would_have_fit() {
        let name = |text: &str| text.to_owned();
        let held = vec![(name("geometry"), ask(10 * MIB)), (name("texture.0"), ask(40 * MIB))];
        let rules = Rules::of_one_heap(Strategy::Dedicated, 64 * MIB);
        let refusal = Refusal { rules, held, name: name("picture"), ask: ask(20 * MIB) };
        let smaller = |mib: u64| [wanted("texture.0", mib * MIB, false), wanted("upload.0", mib * MIB, true)];
        assert!(!refusal.fits_with(&smaller(35)));
        // Everything wanted is held: staging is over.
        assert!(refusal.fits_with(&smaller(34)));
        // Textures still to come count, and then the greatest staging buffer.
        let more = |mib: u64, staging: u64| {
            let mut all = smaller(10).to_vec();
            all.extend([wanted("texture.1", mib * MIB, false), wanted("upload.1", staging * MIB, true)]);
            refusal.fits_with(&all)
        };
        assert!(more(14, 10) && !more(25, 1) && !more(14, 11));
    }
}
