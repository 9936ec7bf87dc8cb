// Block splitting, the first pass of two: each block of the G-buffer into its n x m sub-blocks. Segovia 2006, section 3.3.
// Pass: src/techniques/interleaved_deferred/split/blocks.rs.
// variants: POSITION=half|unorm16|depth|float STORAGE=buffer|image COPY=pull|push COLOR=off|on
#version 460
#include "passes/gbuffer.glsl"
#define WRITES_SURFACE
#include "techniques/interleaved_deferred/sub_buffers.glsl"
#include "techniques/interleaved_deferred/split/surface_of_frame.glsl"

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;

layout(push_constant) uniform Push { MappingParams mapping; };

// x: runs along a row of the padded frame, written or read; y: its rows.
void main() {
    uvec2 first = gl_GlobalInvocationID.xy * uvec2(RUN, 1u);
    if (!is_in_padded(mapping, first)) {
        return;
    }
#ifdef COPY_PULL
    SurfaceTexel run[RUN];
    for (uint step = 0u; step < RUN; step++) {
        uvec2 pixel = pixel_of_block_texel(mapping, first + uvec2(step, 0u));
        run[step] = surface_of_frame(mapping, pixel);
    }
    store_surfaces(place_of_block_texel(mapping, first), run);
#else
    for (uint step = 0u; step < RUN; step++) {
        uvec2 pixel = first + uvec2(step, 0u);
        uvec2 at = block_texel_of_pixel(mapping, pixel);
        store_surface(place_of_block_texel(mapping, at), surface_of_frame(mapping, pixel));
    }
#endif
}
