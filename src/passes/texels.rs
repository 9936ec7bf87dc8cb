//! How many pixels a thread shades, compares or filters one after the other (`--texels`): each reading of what they share
//! then serves all of them. The same bits for every count.
//!
//! Why there is a bound: lavapipe before Mesa 25 ends all loops of an invocation together after 65,535 iterations,
//! without an error (`Identity::loop_end`), so that 1,663 lights on 16 pixels a thread lost light. A thread gets as
//! many pixels as its iterations suffice for. Where one pixel is too many, the shader reports it itself
//! (glsl/loops.glsl).

use crate::caps::{Caps, Identity};
use crate::settings::Values;

/// What `--texels` and the driver allow.
#[derive(Clone, Copy, Debug)]
pub struct Texels {
    most: u32,
    max_loop_iterations: Option<u32>,
}

/// On the reference driver. Lavapipe reads a buffer lane by lane: 497 lights on every pixel of 1024x768 take
/// 1625 ms with 1 texel a thread, 475 with 4, 299 with 8, 204 with 16, 156 with 32 (Mesa 22.3.6, 2 cores).
const MANY_REGISTERS_TEXELS: u32 = 32;
/// Newer lavapipes keep 32 points no longer in registers: 480 lights on 512x384 take 36 ms with 16 and 181 with 32 (Mesa
/// 25.0.7).
const SOFTWARE_TEXELS: u32 = 16;
/// Nothing is known of GPUs, where more threads hide more latency.
const GPU_TEXELS: u32 = 1;

/// Texels that a thread filters or compares at most: with 16, a filter of 5 taps is slower again (16.1 ms, with 8 10.6).
pub const FILTER_TEXELS: u32 = 8;
/// Pixels of a column that a thread shades with punctual lights at most: those of a tile. 188 lights, kaos, 1024x768, with
/// tiled culling: 718 ms with 1, 320 with 4, 254 with 8, 222 with 16.
const COLUMN_TEXELS: u32 = 16;
/// The same without lights, where only the frame's numbers are shared: 13.2 ms with 1, 11.5 with 4, 13.5 with 16.
const UNLIT_TEXELS: u32 = 4;

/// Pixels that share a list in which a light casts shadow rays at most: 188 lights, kaos, 640x360, 4x4, `--direct interleaved`,
/// take 32.8 ms with 8 and 43.0 with 32, whose first frame takes 6.1 s to compile where 8 take 1.9.
const WALKED_TEXELS: u32 = 8;

/// Iterations of a shadow ray's walk: eight lanes walk until the last is done. On kaos (28,230
/// triangles, 188 lights) 8 pixels a thread were cut short and 4 were not: it takes between 43 and 87 a light there.
const WALK_ITERATIONS: u64 = 160;
/// Iterations of a walk that no lane needs: lavapipe runs a loop's body once, masked.
const IDLE_ITERATIONS: u64 = 3;

/// What the punctual lights of a thread's list ask of each of its pixels.
#[derive(Clone, Copy, Debug, Default)]
pub struct LightLoad {
    pub light_count: u64,
    /// Number of those that cast shadow rays.
    pub casting_count: u64,
}

impl Texels {
    pub fn new(values: &Values, caps: &Caps) -> Self {
        let asked = values.unless_auto("texels", Values::integer);
        let most = asked.map_or_else(|| auto(&caps.identity), |count| count as u32);
        Self { most, max_loop_iterations: caps.identity.loop_end().map(|end| end.iterations) }
    }

    /// Pixels that have one list of lights.
    pub fn of_list(self, load: LightLoad) -> u32 {
        // Where each light asks for a walk, readings are not what takes the time: 307 ms with 1, 384 with 2, 331 with 8.
        if load.casting_count > 0 && load.casting_count == load.light_count {
            return 1;
        }
        let (walks, most) = match load.casting_count {
            0 => (1, self.most),
            _ => (IDLE_ITERATIONS, self.most.min(WALKED_TEXELS)),
        };
        let Some(iterations) = self.max_loop_iterations else { return most };
        let iterations_a_texel = load.light_count * walks + load.casting_count * WALK_ITERATIONS;
        let enough =
            (u64::from(iterations) / iterations_a_texel.max(1)).checked_ilog2().map_or(1, |power| 1 << power.min(5));
        most.min(enough)
    }

    /// Pixels of a column of a tile, lit by all lights.
    pub fn of_column(self, load: LightLoad) -> u32 {
        self.of_list(load).min(if load.light_count > 0 { COLUMN_TEXELS } else { UNLIT_TEXELS })
    }

    /// Texels that a thread filters or compares.
    pub fn of_filter(self) -> u32 {
        self.most.min(FILTER_TEXELS)
    }
}

fn auto(identity: &Identity) -> u32 {
    match identity.is_software() {
        true if identity.has_many_registers() => MANY_REGISTERS_TEXELS,
        true => SOFTWARE_TEXELS,
        false => GPU_TEXELS,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn iterations_are_enough_for_the_pixels(light_count in 0u64..5000, casting in 0u64..5000, most in 0u32..6) {
            let load = LightLoad { light_count, casting_count: casting.min(light_count) };
            let texels = Texels { most: 1 << most, max_loop_iterations: Some(65_535) };
            let count = texels.of_list(load);
            prop_assert!(count.is_power_of_two() && count <= 1 << most);
            let iterations = u64::from(count) * (light_count + load.casting_count * WALK_ITERATIONS);
            prop_assert!(count == 1 || iterations <= 65_535);
            let unbounded = Texels { max_loop_iterations: None, ..texels };
            prop_assert!(unbounded.of_list(load) >= count);
        }
    }
}
