// Which texel of the frame goes where: Segovia 2006, sections 1 and 3.2. Twin: src/techniques/interleaved_deferred/mapping.rs.
//
// Pixel (x, y) goes to texel (x / n, y / m) of sub-buffer (x mod n, y mod m). Sub-buffers lie one after the other in a
// buffer, row by row; their width is even, so that a thread can carry two texels.
#ifndef INTERLEAVED_DEFERRED_MAPPING_GLSL
#define INTERLEAVED_DEFERRED_MAPPING_GLSL

struct MappingParams {
    // The pattern, n x m.
    uint pattern_x;
    uint pattern_y;
    // A sub-buffer with its padding.
    uint sub_width_px;
    uint sub_height_px;
    // The frame.
    uint width_px;
    uint height_px;
};

// Number of the light subset, and of the sub-buffer, of a pixel.
uint subset_of(MappingParams mapping, uvec2 pixel) {
    return pixel.y % mapping.pattern_y * mapping.pattern_x + pixel.x % mapping.pattern_x;
}

// Texel of all sub-buffers that holds a pixel.
uint texel_of(MappingParams mapping, uvec2 pixel) {
    uvec2 inside = pixel / uvec2(mapping.pattern_x, mapping.pattern_y);
    return (subset_of(mapping, pixel) * mapping.sub_height_px + inside.y) * mapping.sub_width_px + inside.x;
}

// The inverse: the pixel that texel `inside` of sub-buffer `subset` comes from. In the padding it lies outside the frame.
uvec2 pixel_of(MappingParams mapping, uint subset, uvec2 inside) {
    uvec2 pattern = uvec2(mapping.pattern_x, mapping.pattern_y);
    return inside * pattern + uvec2(subset % mapping.pattern_x, subset / mapping.pattern_x);
}

// Words between the rows of a buffer in frame order: even, so that a thread can carry two texels.
uint row_pitch(MappingParams mapping) {
    return (mapping.width_px + 1u) & ~1u;
}

#endif
