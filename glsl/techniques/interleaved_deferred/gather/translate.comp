// Block translation back, the first pass of two: sub-blocks of each sub-buffer to their blocks. Segovia 2006, section 3.4.
// Pass: src/techniques/interleaved_deferred/gather/translate.rs.
// variants: STORAGE=buffer|image COPY=pull|push
#version 460
#define READS_IRRADIANCE
#define WRITES_IRRADIANCE
#include "techniques/interleaved_deferred/sub_buffers.glsl"

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;

layout(push_constant) uniform Push { MappingParams mapping; };

#ifdef COPY_PULL
// x: runs along a row of the block layout, y: its rows.
void main() {
    uvec2 first = gl_GlobalInvocationID.xy * uvec2(RUN, 1u);
    if (!is_in_padded(mapping, first)) {
        return;
    }
    uvec2 run[RUN];
    for (uint step = 0u; step < RUN; step++) {
        uvec3 texel = texel_of_block_texel(mapping, first + uvec2(step, 0u));
        run[step] = load_irradiance(place_of_texel(mapping, texel));
    }
    store_irradiances(place_of_block_texel(mapping, first), run);
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
        uvec2 words = load_irradiance(place_of_texel(mapping, texel));
        store_irradiance(place_of_block_texel(mapping, block_texel_of_texel(mapping, texel)), words);
    }
}
#endif
