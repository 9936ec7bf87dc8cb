// One direction of a separable Gaussian that stops at discontinuities. Segovia 2006, section 4.5 (SG11).
// Pass: src/passes/filter/gauss.rs.
#version 460
#include "passes/gbuffer.glsl"

struct GaussParams {
    // Weights of the taps 1 to 4 and 5 to 8 beside the middle, whose weight is 1.
    vec4 weights_near;
    vec4 weights_far;
    uint width_px;
    uint height_px;
    uint row_pitch;
    // 1: along x, 0: along y.
    uint horizontal;
    // Bits of the flags that end a walk in this direction.
    uint stop_bits;
    uint _unused[3];
};

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;
// Texels that a thread filters, one after the other along the walk, so that it reads once what they share.
layout(constant_id = 2) const uint TEXELS = 1;
// Taps on either side of the middle.
layout(constant_id = 3) const uint RADIUS = 2;

layout(push_constant) uniform Push { GaussParams params; };
layout(std430, set = 0, binding = 0) readonly buffer Source { uvec2 source[]; };
layout(std430, set = 0, binding = 1) readonly buffer Flags { uint flags[]; };
layout(std430, set = 0, binding = 2) writeonly buffer Target { uvec2 target[]; };

const uint WINDOW = TEXELS + 2u * RADIUS;

float weight_of(uint tap) {
    return tap <= 4u ? params.weights_near[tap - 1u] : params.weights_far[tap - 5u];
}

void main() {
    bool horizontal = params.horizontal != 0u;
    uvec2 first = gl_GlobalInvocationID.xy * (horizontal ? uvec2(TEXELS, 1u) : uvec2(1u, TEXELS));
    if (first.x >= params.width_px || first.y >= params.height_px) {
        return;
    }
    int at = int(horizontal ? first.x : first.y);
    int length = int(horizontal ? params.width_px : params.height_px);
    uint step = horizontal ? 1u : params.row_pitch;
    uint origin = horizontal ? first.y * params.row_pitch : first.x;
    vec3 values[WINDOW];
    // Whether a walk may go on from a texel to the one after it, and back: not where a flag says that the two differ, and
    // not over the frame's edge.
    bool open_after[WINDOW];
    for (uint i = 0u; i < WINDOW; i++) {
        int place = at + int(i) - int(RADIUS);
        uint texel = origin + uint(clamp(place, 0, length - 1)) * step;
        values[i] = unpack_halves(source[texel]);
        open_after[i] = place >= 0 && place + 1 < length && (flags[texel] & params.stop_bits) == 0u;
    }
    for (uint i = 0u; i < TEXELS; i++) {
        uint middle = i + RADIUS;
        precise vec3 sum = values[middle];
        precise float weights = 1.0;
        bool open = true;
        for (uint tap = 1u; tap <= RADIUS; tap++) {
            open = open && open_after[middle + tap - 1u];
            // A weight of 0 adds exactly nothing: irradiance is finite.
            float weight = open ? weight_of(tap) : 0.0;
            sum += values[middle + tap] * weight;
            weights += weight;
        }
        open = true;
        for (uint tap = 1u; tap <= RADIUS; tap++) {
            open = open && open_after[middle - tap];
            float weight = open ? weight_of(tap) : 0.0;
            sum += values[middle - tap] * weight;
            weights += weight;
        }
        if (at + int(i) < length) {
            target[origin + uint(at + int(i)) * step] = pack_halves(sum / weights, 0u);
        }
    }
}
