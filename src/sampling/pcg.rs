//! PCG32 (O'Neill 2014, variant XSH-RR): small, seeded, and the same on every machine, so that a seed names one result.

/// A stream of random numbers.
#[derive(Clone, Debug)]
pub struct Pcg32 {
    state: u64,
    /// Odd; which of the 2^63 sequences this is.
    increment: u64,
}

impl Pcg32 {
    const MULTIPLIER: u64 = 6_364_136_223_846_793_005;

    /// The sequence `stream` from the place that `seed` names. Streams of one seed are independent.
    pub fn new(seed: u64, stream: u64) -> Self {
        let mut random = Self { state: 0, increment: (stream << 1) | 1 };
        random.next_u32();
        random.state = random.state.wrapping_add(seed);
        random.next_u32();
        random
    }

    /// The next number of the stream, uniform in all 32 bits.
    pub fn next_u32(&mut self) -> u32 {
        let old = self.state;
        self.state = old.wrapping_mul(Self::MULTIPLIER).wrapping_add(self.increment);
        let xorshifted = (((old >> 18) ^ old) >> 27) as u32;
        xorshifted.rotate_right((old >> 59) as u32)
    }

    /// 0..count, evenly within count / 2^32. `count` is at least 1.
    pub fn below(&mut self, count: u32) -> u32 {
        assert!(count > 0, "nothing lies below 0");
        ((u64::from(self.next_u32()) * u64::from(count)) >> 32) as u32
    }

    /// Brings `items` into a random order (Fisher and Yates).
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for last in (1..items.len()).rev() {
            items.swap(last, self.below(last as u32 + 1) as usize);
        }
    }

    /// 0 to 1 without 1, in steps of 2^-24.
    pub fn unit(&mut self) -> f32 {
        (self.next_u32() >> 8) as f32 / 16_777_216.0
    }

    /// `low` to `high`.
    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        low + (high - low) * self.unit()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_published_sequence_comes_out() {
        // The first numbers of the reference program for seed 42 and sequence 54.
        let mut random = Pcg32::new(42, 54);
        let first: Vec<u32> = (0..6).map(|_| random.next_u32()).collect();
        assert_eq!(first, [0xa15c_02b7, 0x7b47_f409, 0xba1d_3330, 0x83d2_f293, 0xbfa4_784b, 0xcbed_606e]);
    }

    #[test]
    fn numbers_stay_in_their_range() {
        let mut random = Pcg32::new(1, 0);
        for _ in 0..1000 {
            assert!(random.below(7) < 7);
            assert!((0.0..1.0).contains(&random.unit()));
            assert!((-2.0..=3.0).contains(&random.between(-2.0, 3.0)));
        }
    }
}
