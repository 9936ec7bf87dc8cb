// Block translation, the second pass of two: whole sub-blocks to their sub-buffers. Segovia 2006, section 3.3.
// Pass: src/techniques/interleaved_deferred/split/translate.rs.
// variants: POSITION=half|unorm16|depth|float STORAGE=buffer|image COPY=pull|push COLOR=off|on
#version 460
#include "passes/gbuffer.glsl"
#define READS_SURFACE
#define WRITES_SURFACE
#include "techniques/interleaved_deferred/sub_buffers.glsl"

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;

layout(push_constant) uniform Push { MappingParams mapping; };

#ifdef COPY_PULL
// x: runs along a row of a sub-buffer, y: its rows, z: sub-buffers.
void main() {
    uvec3 first = gl_GlobalInvocationID * uvec3(RUN, 1u, 1u);
    if (!is_in_sub_buffer(mapping, first)) {
        return;
    }
    SurfaceTexel run[RUN];
    for (uint step = 0u; step < RUN; step++) {
        uvec2 at = block_texel_of_texel(mapping, first + uvec3(step, 0u, 0u));
        run[step] = load_surface(place_of_block_texel(mapping, at));
    }
    store_surfaces(place_of_texel(mapping, first), run);
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
        SurfaceTexel moved = load_surface(place_of_block_texel(mapping, at));
        store_surface(place_of_texel(mapping, texel_of_block_texel(mapping, at)), moved);
    }
}
#endif
