//! Numbers as intermediate results pack them, on the host: the twin of glsl/passes/gbuffer.glsl's packing. `decode` takes
//! them back.

use super::decode;
use crate::gpu::shader::halves::HALF_MAX;
use crate::gpu::shader::structs::FrameBlock;
use crate::settings::PositionStorage;
use glam::Vec3;
use half::f16;

/// Three half floats, and the fourth 16 bits 0. What is brighter than a half is held at the greatest.
pub fn halves(value: Vec3) -> [u32; 2] {
    let [x, y, z] =
        value.min(Vec3::splat(HALF_MAX)).to_array().map(|channel| u32::from(f16::from_f32(channel).to_bits()));
    [x | y << 16, z]
}

/// 16-bit snorm of a unit vector, and the fourth 16 bits 0.
pub fn normal(normal: Vec3) -> [u32; 2] {
    let snorm = |side: f32| u32::from((side.clamp(-1.0, 1.0) * 32767.0).round_ties_even() as i16 as u16);
    let [x, y, z] = normal.to_array().map(snorm);
    [x | y << 16, z]
}

impl PositionStorage {
    /// A position as a G-buffer of the picture gives it back. What the depth buffer holds is off by the rounding of floats
    /// alone.
    pub fn stored(self, frame: &FrameBlock, position_ws: Vec3) -> Vec3 {
        let three = |[x, y, z, _]: [f32; 4]| Vec3::new(x, y, z);
        match self {
            Self::Half => {
                let held = position_ws.clamp(Vec3::splat(-HALF_MAX), Vec3::splat(HALF_MAX));
                Vec3::from_array(decode::halves(halves(held)))
            }
            Self::Unorm16 => {
                let (min, size) = (three(frame.box_min_ws), three(frame.box_size_ws));
                let fraction = ((position_ws - min) / size).clamp(Vec3::ZERO, Vec3::ONE);
                min + size * ((fraction * 65535.0 + 0.5).floor() / 65535.0)
            }
            Self::Depth | Self::Float => position_ws,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bytemuck::Zeroable;

    #[test]
    fn what_is_packed_comes_back() {
        assert_eq!(decode::halves(halves(Vec3::new(1.5, 1e9, 0.25))), [1.5, HALF_MAX, 0.25]);
        assert_eq!(decode::normal(normal(-Vec3::Y)), [0.0, -1.0, 0.0]);
        let turned = Vec3::new(2.0, -3.0, 6.0) / 7.0;
        assert!((Vec3::from_array(decode::normal(normal(turned))) - turned).length() < 3e-5);
        assert_eq!(decode::normal(normal(Vec3::ZERO)), [0.0; 3]);
    }

    #[test]
    fn positions_are_rounded_as_they_are_stored() {
        let frame =
            FrameBlock { box_min_ws: [-1.0, 0.0, 2.0, 0.0], box_size_ws: [2.0, 4.0, 8.0, 0.0], ..FrameBlock::zeroed() };
        let position = Vec3::new(0.123_456, 3.210_987, 9.876_543);
        let off = |storage: PositionStorage| (storage.stored(&frame, position) - position).abs();
        for exact in [PositionStorage::Float, PositionStorage::Depth] {
            assert_eq!(off(exact), Vec3::ZERO);
        }
        let unorm = off(PositionStorage::Unorm16);
        assert!(unorm.cmple(Vec3::new(2.0, 4.0, 8.0) * (0.51 / 65535.0)).all() && unorm != Vec3::ZERO, "{unorm}");
        let half = off(PositionStorage::Half);
        assert!(half.cmple(position / 2047.0).all() && half != Vec3::ZERO, "{half}");
    }
}
