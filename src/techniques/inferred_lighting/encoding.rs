//! The geometry pass's texels back to numbers, on the host: the twin of encoding.glsl. Kircher 2009, equations 1 to 3.

use glam::{Vec2, Vec3};

/// Steps of linear depth: encoding.glsl's DEPTH_STEPS.
const DEPTH_STEPS: f32 = 65534.0;
/// Linear depth of a texel without surface.
const NO_SURFACE: u32 = 0xffff;

/// The unit normal in view space, of two 16-bit snorms.
pub fn view_normal(word: u32) -> Vec3 {
    let snorm = |bits: u32| (f32::from(bits as u16 as i16) / 32767.0).max(-1.0);
    let mapped = Vec2::new(snorm(word), snorm(word >> 16));
    let z = (1.0 - mapped.length_squared()).max(0.0).sqrt();
    (2.0 * z * mapped).extend(2.0 * z * z - 1.0)
}

/// Metres from the eye's plane; None where no surface is. `range`: depth of the first step, and of all of them.
pub fn depth_m(word: u32, range: [f32; 2]) -> Option<f32> {
    let steps = word & 0xffff;
    (steps != NO_SURFACE).then(|| range[0] + steps as f32 * (range[1] / DEPTH_STEPS))
}

/// The object's id times 256, plus the normal group's.
pub fn id(word: u32) -> u32 {
    word >> 16
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Equation 1.
    fn pack(normal: Vec3) -> u32 {
        let mapped = (normal + Vec3::Z).normalize();
        let snorm = |value: f32| u32::from((value * 32767.0).round() as i16 as u16);
        snorm(mapped.x) | snorm(mapped.y) << 16
    }

    proptest! {
        #[test]
        fn normals_come_back(x in -1f32..1.0, y in -1f32..1.0, z in -0.99f32..1.0) {
            let normal = Vec3::new(x, y, z).normalize_or(Vec3::Z);
            // Near the direction away from the eye the map is singular: a step there is many degrees.
            prop_assume!(normal.z > -0.99);
            let found = view_normal(pack(normal));
            prop_assert!((found.length() - 1.0).abs() < 1e-5);
            prop_assert!(found.distance(normal) < 1e-3, "{found} for {normal}");
        }
    }

    #[test]
    fn depth_runs_from_the_first_step_to_the_last() {
        assert_eq!(depth_m(0xabcd_0000, [2.0, 6.0]), Some(2.0));
        assert_eq!(depth_m(65534, [2.0, 6.0]), Some(8.0));
        assert_eq!(depth_m(0xffff, [2.0, 6.0]), None);
        assert_eq!(id(0x1234_0000), 0x1234);
    }
}
