// Which texel of the frame goes where: Segovia 2006, sections 1, 3.2 and 3.3.
// Twin: src/techniques/interleaved_deferred/mapping.rs.
//
// Three orders of the same texels, all of them n * sub_width_px by m * sub_height_px: each mapping is one to one.
//   pixel        the frame, padded to whole patterns and, where a split has blocks, to whole blocks
//   block texel  each block of p x q split by itself into n x m sub-blocks (figure 2c)
//   texel        the sub-buffers: x and y inside one, z its number, which is the number of its light subset
// A width is even, so that a thread can carry two texels of a row.
#ifndef INTERLEAVED_DEFERRED_MAPPING_GLSL
#define INTERLEAVED_DEFERRED_MAPPING_GLSL

#include "sampling/pattern.glsl"

struct MappingParams {
    // The pattern, n x m.
    uint pattern_x;
    uint pattern_y;
    // A block, p x q: a multiple of the pattern; the pattern itself where a split has no blocks.
    uint block_x;
    uint block_y;
    // A sub-buffer with its padding: whole sub-blocks.
    uint sub_width_px;
    uint sub_height_px;
    // The frame.
    uint width_px;
    uint height_px;
};

uvec2 pattern_of(MappingParams mapping) {
    return uvec2(mapping.pattern_x, mapping.pattern_y);
}

uvec2 block_of(MappingParams mapping) {
    return uvec2(mapping.block_x, mapping.block_y);
}

// The part of one sub-buffer that comes from one block.
uvec2 sub_block_of(MappingParams mapping) {
    return block_of(mapping) / pattern_of(mapping);
}

// The frame with its padding: the extent of all three orders.
uvec2 padded_of(MappingParams mapping) {
    return uvec2(mapping.sub_width_px, mapping.sub_height_px) * pattern_of(mapping);
}

bool is_in_frame(MappingParams mapping, uvec2 pixel) {
    return pixel.x < mapping.width_px && pixel.y < mapping.height_px;
}

bool is_in_sub_buffer(MappingParams mapping, uvec3 texel) {
    uint subset_count = mapping.pattern_x * mapping.pattern_y;
    return texel.x < mapping.sub_width_px && texel.y < mapping.sub_height_px && texel.z < subset_count;
}

bool is_in_padded(MappingParams mapping, uvec2 at) {
    return all(lessThan(at, padded_of(mapping)));
}

// Number of the light subset, and of the sub-buffer, of a pixel: row-major inside the pattern.
uint subset_of(MappingParams mapping, uvec2 pixel) {
    return subset_of(pattern_of(mapping), pixel);
}

// Where a sub-buffer stands in the pattern, and among the sub-buffers tiled side by side.
uvec2 place_in_pattern(MappingParams mapping, uint subset) {
    return uvec2(subset % mapping.pattern_x, subset / mapping.pattern_x);
}

// The pixel that is shaded for all of a cell of the pattern (--split subsample): its middle, or the frame's last pixel on the
// way there.
uvec2 middle_of_cell(MappingParams mapping, uvec2 cell) {
    uvec2 last = uvec2(mapping.width_px, mapping.height_px) - 1u;
    return min(cell * pattern_of(mapping) + pattern_of(mapping) / 2u, last);
}

// Split in one pass: pixel (x, y) goes to (x / n, y / m) of sub-buffer (x mod n, y mod m).
uvec3 texel_of_pixel(MappingParams mapping, uvec2 pixel) {
    return uvec3(pixel / pattern_of(mapping), subset_of(mapping, pixel));
}

// Inverse of texel_of_pixel; a texel of the padding gives a pixel outside the frame.
uvec2 pixel_of_texel(MappingParams mapping, uvec3 texel) {
    return texel.xy * pattern_of(mapping) + place_in_pattern(mapping, texel.z);
}

// Block splitting: the block stays where it is, and inside it each pixel goes to its sub-block.
uvec2 block_texel_of_pixel(MappingParams mapping, uvec2 pixel) {
    uvec2 inside = pixel % block_of(mapping);
    uvec2 sub_block = inside % pattern_of(mapping);
    return pixel - inside + sub_block * sub_block_of(mapping) + inside / pattern_of(mapping);
}

// Inverse of block_texel_of_pixel.
uvec2 pixel_of_block_texel(MappingParams mapping, uvec2 at) {
    uvec2 inside = at % block_of(mapping);
    uvec2 sub_block = inside / sub_block_of(mapping);
    return at - inside + inside % sub_block_of(mapping) * pattern_of(mapping) + sub_block;
}

// Block translation: a whole sub-block goes to its place in its sub-buffer.
uvec3 texel_of_block_texel(MappingParams mapping, uvec2 at) {
    uvec2 inside = at % block_of(mapping);
    uvec2 sub_block = inside / sub_block_of(mapping);
    uvec2 moved = at / block_of(mapping) * sub_block_of(mapping) + inside % sub_block_of(mapping);
    return uvec3(moved, sub_block.y * mapping.pattern_x + sub_block.x);
}

// Inverse of texel_of_block_texel.
uvec2 block_texel_of_texel(MappingParams mapping, uvec3 texel) {
    uvec2 block = texel.xy / sub_block_of(mapping);
    uvec2 inside = texel.xy % sub_block_of(mapping);
    return block * block_of(mapping) + place_in_pattern(mapping, texel.z) * sub_block_of(mapping) + inside;
}

// Where a texel lies when sub-buffers lie one after the other, row by row: in buffers.
uint linear_of(MappingParams mapping, uvec3 texel) {
    return (texel.z * mapping.sub_height_px + texel.y) * mapping.sub_width_px + texel.x;
}

// Where a texel lies when sub-buffers are tiled in one image (figure 3b).
uvec2 tiled_of(MappingParams mapping, uvec3 texel) {
    return place_in_pattern(mapping, texel.z) * uvec2(mapping.sub_width_px, mapping.sub_height_px) + texel.xy;
}

// Words between the rows of a buffer in frame order: even, so that a thread can carry two texels.
uint row_pitch(MappingParams mapping) {
    return (mapping.width_px + 1u) & ~1u;
}

#endif
