// Irradiance and its discontinuity flags into one image, for the filter that lets the sampler blend: rgb and flag as
// half floats through an integer view, the same bits on every driver. Pass: src/passes/filter/gauss_pack.rs.
#version 460
#include "passes/gbuffer.glsl"

struct GaussPackParams {
    uint width_px;
    uint height_px;
    uint row_pitch;
};

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;

// 1 as a half float.
const uint HALF_ONE = 0x3c00u;

layout(push_constant) uniform Push { GaussPackParams params; };
layout(std430, set = 0, binding = 0) readonly buffer Source { uvec2 source[]; };
layout(std430, set = 0, binding = 1) readonly buffer Flags { uint flags[]; };
layout(set = 0, binding = 2, rg32ui) writeonly uniform uimage2D target;

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.width_px || pixel.y >= params.height_px) {
        return;
    }
    uint texel = pixel.y * params.row_pitch + pixel.x;
    uvec2 words = source[texel];
    uint flag = flags[texel] != 0u ? HALF_ONE : 0u;
    imageStore(target, ivec2(pixel), uvec4(words.x, (words.y & 0xffffu) | (flag << 16), 0u, 0u));
}
