// One-pass split: G-buffer to n x m sub-buffers. Segovia 2006, section 3.2. With STORAGE=layers it is `--split layered`.
// Pass: src/techniques/interleaved_deferred/split/one_pass.rs.
// variants: POSITION=half|unorm16|depth|float STORAGE=buffer|image|layers COPY=pull|push COLOR=off|on
#version 460
#include "passes/gbuffer.glsl"
#define WRITES_SURFACE
#include "techniques/interleaved_deferred/sub_buffers.glsl"
#include "techniques/interleaved_deferred/split/surface_of_frame.glsl"

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;

layout(push_constant) uniform Push { MappingParams mapping; };

#ifdef COPY_PULL
// x: runs along a row of a sub-buffer, y: sub-buffers, z: rows. Workgroups that follow each other take the same rows of the
// frame for one sub-buffer after the other, while its texels are still in the cache.
void main() {
    uvec3 first = gl_GlobalInvocationID.xzy * uvec3(RUN, 1u, 1u);
    if (!is_in_sub_buffer(mapping, first)) {
        return;
    }
    SurfaceTexel run[RUN];
    for (uint step = 0u; step < RUN; step++) {
        uvec2 pixel = pixel_of_texel(mapping, first + uvec3(step, 0u, 0u));
        run[step] = surface_of_frame(mapping, pixel);
    }
    store_surfaces(place_of_texel(mapping, first), run);
}
#else
// x: runs along a row of the padded frame, y: its rows.
void main() {
    uvec2 first = gl_GlobalInvocationID.xy * uvec2(RUN, 1u);
    if (!is_in_padded(mapping, first)) {
        return;
    }
    for (uint step = 0u; step < RUN; step++) {
        uvec2 pixel = first + uvec2(step, 0u);
        store_surface(place_of_texel(mapping, texel_of_pixel(mapping, pixel)), surface_of_frame(mapping, pixel));
    }
}
#endif
