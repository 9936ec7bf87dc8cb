//! Ids of eight bits for things of which neighbours are to have different ones (Kircher & Lawrance 2009, section 3.1):
//! a colouring, greedy, in a given order.

/// A set of ids.
#[derive(Clone, Copy, Debug, Default)]
pub struct Ids([u64; 4]);

impl Ids {
    pub fn insert(&mut self, id: u8) {
        self.0[usize::from(id >> 6)] |= 1 << (id & 63);
    }

    pub fn contains(&self, id: u8) -> bool {
        self.0[usize::from(id >> 6)] >> (id & 63) & 1 == 1
    }
}

/// The first id from `number` modulo 256 on, and from 0 again after 255, that is in none of `around`; where each of the
/// 256 is in some, the first of those that are in the fewest.
///
/// With the numbers 0, 1, 2 and so on the first 256 things all get different ids, also those that are no neighbours.
pub fn pick(number: usize, around: &[Ids]) -> u8 {
    let first = (number % 256) as u8;
    let ids = || (0..=u8::MAX).map(|step| first.wrapping_add(step));
    let uses = |id: &u8| around.iter().filter(|ids| ids.contains(*id)).count();
    ids().find(|id| uses(id) == 0).unwrap_or_else(|| ids().min_by_key(uses).expect("there are 256"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn set(ids: impl IntoIterator<Item = u8>) -> Ids {
        ids.into_iter().fold(Ids::default(), |mut set, id| {
            set.insert(id);
            set
        })
    }

    #[test]
    fn the_first_free_id_is_taken_and_the_search_goes_round() {
        assert_eq!(pick(7, &[]), 7);
        assert_eq!(pick(7, &[set([7, 9]), set([8])]), 10);
        assert_eq!(pick(511, &[set([255, 0])]), 1);
    }

    #[test]
    fn where_none_is_free_the_rarest_is_taken() {
        let all = set(0..=255);
        assert_eq!(pick(3, &[all, set((0..=255).filter(|id| *id != 77))]), 77);
        assert_eq!(pick(300, &[all]), 44);
    }
}
