// One direction of a separable Gaussian that stops at discontinuities. Segovia 2006, section 4.5.
// Pass: src/passes/filter/gauss.rs.
#version 460

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;
layout(constant_id = 2) const uint TEXELS = 1;

#include "passes/filter/walk.glsl"

struct GaussParams {
    WalkParams walk;
    uint width_px;
    uint height_px;
    uint row_pitch;
    // 1: along x, 0: along y.
    uint horizontal;
};

layout(push_constant) uniform Push { GaussParams params; };
layout(std430, set = 0, binding = 0) readonly buffer Source { uvec2 source[]; };
layout(std430, set = 0, binding = 1) readonly buffer Flags { uint flags[]; };
layout(std430, set = 0, binding = 2) writeonly buffer Target { uvec2 target[]; };

void main() {
    bool horizontal = params.horizontal != 0u;
    uvec2 first = gl_GlobalInvocationID.xy * (horizontal ? uvec2(TEXELS, 1u) : uvec2(1u, TEXELS));
    if (first.x >= params.width_px || first.y >= params.height_px) {
        return;
    }
    uint at = horizontal ? first.x : first.y;
    uint length = horizontal ? params.width_px : params.height_px;
    uint step = horizontal ? 1u : params.row_pitch;
    uint origin = horizontal ? first.y * params.row_pitch : first.x;
    for (uint i = 0u; i < WINDOW; i++) {
        int place = window_place(at, i);
        uint texel = origin + uint(clamp(place, 0, int(length) - 1)) * step;
        set_window(params.walk, i, place, length, source[texel], flags[texel]);
    }
    for (uint i = 0u; i < TEXELS; i++) {
        if (at + i < length) {
            target[origin + (at + i) * step] = walked(params.walk, i);
        }
    }
}
