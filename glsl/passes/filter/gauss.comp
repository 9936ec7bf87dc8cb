// One direction of a separable Gaussian that stops at discontinuities. Segovia 2006, section 4.5 (SG11).
// Pass: src/passes/filter/gauss.rs.
#version 460
#include "passes/gbuffer.glsl"

struct GaussParams {
    uint width_px;
    uint height_px;
    uint row_pitch;
    // 1: along x, 0: along y.
    uint horizontal;
    // Taps on either side of the middle.
    uint radius;
    // Bits of the flags that end a walk in this direction.
    uint stop_bits;
    // -1 / (2 sigma^2), in 1/px^2.
    float falloff;
};

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;

layout(push_constant) uniform Push { GaussParams params; };
layout(std430, set = 0, binding = 0) readonly buffer Source { uvec2 source[]; };
layout(std430, set = 0, binding = 1) readonly buffer Flags { uint flags[]; };
layout(std430, set = 0, binding = 2) writeonly buffer Target { uvec2 target[]; };

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.width_px || pixel.y >= params.height_px) {
        return;
    }
    uint middle = pixel.y * params.row_pitch + pixel.x;
    uint step = params.horizontal != 0u ? 1u : params.row_pitch;
    uint before = params.horizontal != 0u ? pixel.x : pixel.y;
    uint after = params.horizontal != 0u ? params.width_px - 1u - pixel.x : params.height_px - 1u - pixel.y;
    vec3 sum = unpack_halves(source[middle]);
    float weights = 1.0;
    // Forward: a flagged pixel differs from the one after it, so it is still blended and ends the walk. A flagged
    // pixel itself does not walk forward at all.
    bool open = (flags[middle] & params.stop_bits) == 0u;
    for (uint tap = 1u; tap <= min(params.radius, after) && open; tap++) {
        uint texel = middle + tap * step;
        float weight = exp(float(tap * tap) * params.falloff);
        sum += unpack_halves(source[texel]) * weight;
        weights += weight;
        open = (flags[texel] & params.stop_bits) == 0u;
    }
    // Backward: a flagged pixel differs from the one after it, which is on this side: it ends the walk unblended.
    for (uint tap = 1u; tap <= min(params.radius, before); tap++) {
        uint texel = middle - tap * step;
        if ((flags[texel] & params.stop_bits) != 0u) {
            break;
        }
        float weight = exp(float(tap * tap) * params.falloff);
        sum += unpack_halves(source[texel]) * weight;
        weights += weight;
    }
    target[middle] = pack_halves(sum / weights, 0u);
}
