// Discontinuity buffer (DB): does a pixel differ from its three positive neighbours? Segovia 2006, section 4.5.
// Bit 0: from +x, bit 1: from +y, bit 2: from +xy. The paper's flag is whether any bit is set.
// Pass: src/techniques/interleaved_deferred/discontinuity.rs.
// variants: POSITION=half|unorm16|depth|float
#version 460
#include "passes/gbuffer_read.glsl"

struct DiscontinuityParams {
    // Flagged where 1 - dot(n0, n1) is greater.
    float normal_threshold;
    // Flagged where a neighbour lies farther off the pixel's tangent plane, in metres.
    float position_threshold;
    uint row_pitch;
};

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;

layout(push_constant) uniform Push { DiscontinuityParams params; };
layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 1) writeonly buffer Flags { uint flags[]; };

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= frame.width_px || pixel.y >= frame.height_px) {
        return;
    }
    uvec2 last = uvec2(frame.width_px, frame.height_px) - 1u;
    uvec2 normal_bits = normal_words(pixel);
    bool surface = has_surface(normal_bits);
    vec3 normal_ws = unpack_normal(normal_bits);
    vec3 position_ws = unpack_position(frame, position_words(pixel), pixel);
    uint bits = 0u;
    for (uint step = 1u; step < 4u; step++) {
        uvec2 other = min(pixel + uvec2(step & 1u, step >> 1), last);
        uvec2 other_normal = normal_words(other);
        bool other_surface = has_surface(other_normal);
        bool differs = surface != other_surface;
        if (surface && other_surface) {
            vec3 away = unpack_position(frame, position_words(other), other) - position_ws;
            differs = 1.0 - dot(normal_ws, unpack_normal(other_normal)) > params.normal_threshold
                || abs(dot(normal_ws, away)) > params.position_threshold;
        }
        bits |= differs ? 1u << (step - 1u) : 0u;
    }
    flags[pixel.y * params.row_pitch + pixel.x] = bits;
}
