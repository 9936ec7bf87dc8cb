// Buffer gathering (BG): sub-buffers back to the frame, irradiance only. Segovia 2006, section 3.4 and 4.4.
// Pass: src/techniques/interleaved_deferred/gather.rs.
#version 460
#include "techniques/interleaved_deferred/mapping.glsl"

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;

layout(push_constant) uniform Push { MappingParams mapping; };
layout(std430, set = 0, binding = 0) readonly buffer Source { uvec2 source[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Irradiance { uvec4 irradiance[]; };

// x: pairs of pixels along a row.
void main() {
    uvec2 first = uvec2(gl_GlobalInvocationID.x * 2u, gl_GlobalInvocationID.y);
    if (first.x >= mapping.width_px || first.y >= mapping.height_px) {
        return;
    }
    // The pair's second pixel may lie in the padding of the row: it is written, and never read.
    uvec2 second = uvec2(min(first.x + 1u, mapping.width_px - 1u), first.y);
    uvec4 pair = uvec4(source[texel_of(mapping, first)], source[texel_of(mapping, second)]);
    irradiance[(first.y * row_pitch(mapping) + first.x) / 2u] = pair;
}
