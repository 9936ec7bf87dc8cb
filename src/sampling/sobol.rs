//! Two numbers at a time of the Sobol sequence, Owen-scrambled by a hash: the twin of glsl/sampling/sobol.glsl, to the bit.
//!
//! sobol.comp is the shader by which a test holds the two against each other.
//!
//! Burley 2020, Practical Hash-based Owen Scrambling: of a sequence that needs many dimensions the first two are used again
//! and again, shuffled and scrambled by another seed each time. Any 2^k points from the start on are a (0, k, 2)-net.

/// All bits of `value`, well mixed (the finalizer of MurmurHash3).
pub fn mixed(value: u32) -> u32 {
    let value = (value ^ (value >> 16)).wrapping_mul(0x85eb_ca6b);
    let value = (value ^ (value >> 13)).wrapping_mul(0xc2b2_ae35);
    value ^ (value >> 16)
}

/// Each bit turned by the bits below it and `seed` (Laine and Karras 2011, constants of Burley 2020).
fn scrambled_upwards(value: u32, seed: u32) -> u32 {
    let value = value.wrapping_add(seed);
    [0x6c50_b47c_u32, 0xb82f_1e52, 0xc7af_e638, 0x8d22_f6e6]
        .into_iter()
        .fold(value, |value, factor| value ^ value.wrapping_mul(factor))
}

/// The second dimension of an index whose bits the first dimension reverses: both before their last reversal.
fn second(index: u32) -> u32 {
    let sum = |bits: u32, (shift, mask): (u32, u32)| bits ^ ((bits >> shift) & mask);
    [(1, 0x5555_5555), (2, 0x3333_3333), (4, 0x0f0f_0f0f), (8, 0x00ff_00ff), (16, 0x0000_ffff)]
        .into_iter()
        .fold(index, sum)
}

/// 0 to 1 without 1, in steps of 2^-24.
fn unit_of(bits: u32) -> f32 {
    (bits >> 8) as f32 / 16_777_216.0
}

/// Point `index` of the first two dimensions, shuffled and scrambled by `seed`; each 0 to 1 without 1.
pub fn pair(index: u32, seed: u32) -> [f32; 2] {
    let index = scrambled_upwards(index.reverse_bits(), mixed(seed)).reverse_bits();
    let x = scrambled_upwards(index, mixed(seed ^ 0x68bc_21eb)).reverse_bits();
    let y = scrambled_upwards(second(index), mixed(seed ^ 0x02e5_be93)).reverse_bits();
    [unit_of(x), unit_of(y)]
}

/// The seed of a pixel's numbers for one purpose: `pair` counts the pairs that its sample has taken.
pub fn pair_seed(pixel_seed: u32, pair: u32) -> u32 {
    mixed(pixel_seed ^ mixed(pair + 1))
}

pub fn pixel_seed(pixel_px: [u32; 2], seed: u32) -> u32 {
    mixed(pixel_px[0] ^ mixed(pixel_px[1] ^ mixed(seed)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn without_scrambling_it_is_sobol_s_sequence() {
        let points: Vec<[f32; 2]> =
            (0..8u32).map(|index| [index, second(index)].map(|bits| unit_of(bits.reverse_bits()))).collect();
        let published = [
            [0.0, 0.0],
            [0.5, 0.5],
            [0.25, 0.75],
            [0.75, 0.25],
            [0.125, 0.625],
            [0.625, 0.125],
            [0.375, 0.375],
            [0.875, 0.875],
        ];
        assert_eq!(points, published);
    }

    proptest! {
        /// Every box of 2^-a by 2^-b holds exactly one of 2^(a + b) points that begin at a multiple of their number.
        #[test]
        fn aligned_stretches_are_nets(seed in any::<u32>(), power in 0u32..10, stretch in 0u32..64) {
            let count = 1u32 << power;
            let points: Vec<[f32; 2]> = (0..count).map(|index| pair(stretch * count + index, seed)).collect();
            for a in 0..=power {
                let boxes = [1u32 << a, 1 << (power - a)];
                let mut hits = vec![0; count as usize];
                for point in &points {
                    let at = [0, 1].map(|axis| (point[axis] * boxes[axis] as f32) as u32);
                    hits[(at[1] * boxes[0] + at[0]) as usize] += 1;
                }
                prop_assert!(hits.iter().all(|count| *count == 1), "{boxes:?}: {hits:?}");
            }
        }
    }

    /// x^2 y^2 over the square, whose integral is 1/9: nets are far closer than independent numbers would be.
    #[test]
    fn integrals_come_out_as_nets_promise() {
        for seed in 0..20 {
            let count = 1024;
            let sum: f64 = (0..count).map(|index| pair(index, seed).map(f64::from)).map(|[x, y]| (x * y).powi(2)).sum();
            let error = (sum / f64::from(count) - 1.0 / 9.0).abs();
            // Independent numbers have a standard error of 0.0052.
            assert!(error < 0.001, "seed {seed}: {error}");
        }
    }

    #[test]
    fn pixels_and_purposes_have_their_own_numbers() {
        let seeds: std::collections::BTreeSet<u32> = (0..64)
            .flat_map(|pixel| (0..8).map(move |index| pair_seed(pixel_seed([pixel % 8, pixel / 8], 1), index)))
            .collect();
        assert_eq!(seeds.len(), 64 * 8);
    }
}
