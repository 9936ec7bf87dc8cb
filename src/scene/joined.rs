//! Sets that grow together (union-find): which of many things hang together, told pair by pair.

/// Sets of numbers that are joined one by one; the least represents its set. 4 bytes a number.
pub struct Joined(Vec<u32>);

impl Joined {
    /// `count` sets of one number each, 0 to `count - 1`.
    pub fn new(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    /// The least of the set that holds `member`.
    pub fn first(&mut self, mut member: u32) -> u32 {
        let above = &mut self.0;
        while above[member as usize] != member {
            // Every second one is lifted by a step: later ways are half as long.
            above[member as usize] = above[above[member as usize] as usize];
            member = above[member as usize];
        }
        member
    }

    pub fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.first(a), self.first(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}
