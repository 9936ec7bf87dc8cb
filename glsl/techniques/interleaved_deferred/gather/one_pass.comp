// Buffer gathering (BG) in one pass: sub-buffers back to the frame, irradiance only. Segovia 2006, section 3.4 and 4.4.
// Pass: src/techniques/interleaved_deferred/gather/one_pass.rs.
// variants: STORAGE=buffer|image|layers COPY=pull|push
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
    uvec2 words = load_irradiance(place_of_texel(mapping, texel_of_pixel(mapping, first)));
    uvec2 second_words = load_irradiance(place_of_texel(mapping, texel_of_pixel(mapping, second)));
    store_pixels(mapping, first, words, second_words);
}
#else
// x: runs along a row of a sub-buffer, y: its rows, z: sub-buffers.
void main() {
    uvec3 first = gl_GlobalInvocationID * uvec3(RUN, 1u, 1u);
    if (!is_in_sub_buffer(mapping, first)) {
        return;
    }
    for (uint step = 0u; step < RUN; step++) {
        uvec3 texel = first + uvec3(step, 0u, 0u);
        store_pixel(mapping, pixel_of_texel(mapping, texel), load_irradiance(place_of_texel(mapping, texel)));
    }
}
#endif
