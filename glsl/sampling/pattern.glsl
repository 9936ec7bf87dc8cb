// Interleaved patterns: which of the n * m sample sets shades a pixel. Keller and Heidrich 2001, section 2; twin:
// src/sampling/pattern/grid.rs.
#ifndef SAMPLING_PATTERN_GLSL
#define SAMPLING_PATTERN_GLSL

// 0..n*m, row-major inside the pattern.
uint subset_of(uvec2 pattern, uvec2 pixel) {
    return pixel.y % pattern.y * pattern.x + pixel.x % pattern.x;
}

#endif
