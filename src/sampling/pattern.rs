//! Interleaved patterns: which sample set shades a pixel. Keller and Heidrich 2001, section 2; twin of pattern.glsl.

/// Which of the n * m sample sets shades a pixel.
///
/// `pattern_px` = [n, m], each at least 1. Returns 0..n*m, row-major inside the pattern.
pub fn subset_of(pattern_px: [u32; 2], pixel_px: [u32; 2]) -> u32 {
    pixel_px[1] % pattern_px[1] * pattern_px[0] + pixel_px[0] % pattern_px[0]
}
