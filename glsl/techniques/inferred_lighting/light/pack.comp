// Sums of lights that were drawn to the L-buffer's two words, once. Pass: src/techniques/inferred_lighting/light/pack.rs.
// variants: TARGETS=one|two
#version 460
#include "frame.glsl"
#include "techniques/inferred_lighting/l_buffer.glsl"

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(set = 0, binding = 1) uniform sampler2D sums;
#ifdef TARGETS_TWO
layout(set = 0, binding = 2) uniform sampler2D more_sums;
#endif
layout(set = 0, binding = 5, rg32ui) writeonly uniform uimage2D l_buffer;

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x < frame.width_px && pixel.y < frame.height_px) {
        vec4 sum = texelFetch(sums, ivec2(pixel), 0);
        Lighting lighting = Lighting(sum.rgb, vec3(sum.a, 0.0, 0.0));
#ifdef TARGETS_TWO
        lighting.highlight.yz = texelFetch(more_sums, ivec2(pixel), 0).rg;
#endif
        imageStore(l_buffer, ivec2(pixel), uvec4(pack_lighting(lighting), 0u, 0u));
    }
}
