//! Packed intermediate results back to numbers, on the host: the twin of glsl/passes/gbuffer.glsl's unpacking.

use half::f16;

/// Two 32-bit words a texel.
pub fn words(bytes: &[u8]) -> impl Iterator<Item = [u32; 2]> {
    bytes.chunks_exact(8).map(|texel| {
        let word = |at: usize| u32::from_le_bytes([texel[at], texel[at + 1], texel[at + 2], texel[at + 3]]);
        [word(0), word(4)]
    })
}

/// xyz of 16-bit snorm, made unit length; 0 where no surface is.
pub fn normal([xy, z]: [u32; 2]) -> [f32; 3] {
    let snorm = |bits: u32| (f32::from(bits as u16 as i16) / 32767.0).max(-1.0);
    let v = glam::Vec3::new(snorm(xy), snorm(xy >> 16), snorm(z));
    v.normalize_or_zero().to_array()
}

/// Three half floats.
pub fn halves([xy, z]: [u32; 2]) -> [f32; 3] {
    [xy, xy >> 16, z].map(|bits| f16::from_bits(bits as u16).to_f32())
}

/// The fourth 16 bits.
pub fn last16([_, z]: [u32; 2]) -> u32 {
    z >> 16
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halves_and_normals_come_back() {
        let pack = |a: f32, b: f32| u32::from(f16::from_f32(a).to_bits()) | u32::from(f16::from_f32(b).to_bits()) << 16;
        assert_eq!(halves([pack(1.5, -2.0), pack(0.25, 9.0)]), [1.5, -2.0, 0.25]);
        assert_eq!(last16([0x1234_5678, 0xfedc_4321]), 0xfedc);
        assert_eq!(normal([0, 0xff00_7fff]), [0.0, 0.0, 1.0]);
        assert_eq!(normal([0x8001, 0]), [-1.0, 0.0, 0.0]);
        assert_eq!(normal([0, 0xab_0000]), [0.0; 3]);
        assert_eq!(words(&[1, 0, 0, 0, 2, 0, 0, 0, 9]).collect::<Vec<_>>(), [[1, 2]]);
    }
}
