// Block gathering, the second pass of two: each block's n x m sub-blocks back to its pixels. Segovia 2006, section 3.4.
// Pass: src/techniques/interleaved_deferred/gather/blocks.rs.
// variants: STORAGE=buffer|image COPY=pull|push
#version 460
#define READS_IRRADIANCE
#include "techniques/interleaved_deferred/sub_buffers.glsl"
#include "techniques/interleaved_deferred/gather/frame_order.glsl"

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;

layout(push_constant) uniform Push { MappingParams mapping; };

#ifdef COPY_PULL
// x: pairs of pixels along a row, y: rows of the frame.
void main() {
    uvec2 first = gl_GlobalInvocationID.xy * uvec2(2u, 1u);
    if (!is_in_frame(mapping, first)) {
        return;
    }
    uvec2 second = uvec2(min(first.x + 1u, mapping.width_px - 1u), first.y);
    uvec2 words = load_irradiance(place_of_block_texel(mapping, block_texel_of_pixel(mapping, first)));
    uvec2 second_words = load_irradiance(place_of_block_texel(mapping, block_texel_of_pixel(mapping, second)));
    store_pixels(mapping, first, words, second_words);
}
#else
// x: runs along a row of the block layout, y: its rows.
void main() {
    uvec2 first = gl_GlobalInvocationID.xy * uvec2(RUN, 1u);
    if (!is_in_padded(mapping, first)) {
        return;
    }
    for (uint step = 0u; step < RUN; step++) {
        uvec2 at = first + uvec2(step, 0u);
        store_pixel(mapping, pixel_of_block_texel(mapping, at), load_irradiance(place_of_block_texel(mapping, at)));
    }
}
#endif
