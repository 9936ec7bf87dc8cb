// Irradiance and its discontinuity flags into one image, for the filter that lets the sampler blend: rgb and flags as
// half floats through an integer view, the same bits on every driver. Pass: src/passes/filter/gauss_pack.rs.
//
// The fourth half is 1 where a walk along x stops, plus 4 where one along y does: the mean of two texels still shows
// which of the flags any of them has.
#version 460
#include "passes/gbuffer.glsl"

struct GaussPackParams {
    uint width_px;
    uint height_px;
    uint row_pitch;
    // Bits of the flags that end a walk along x, and along y.
    uint stop_bits_x;
    uint stop_bits_y;
};

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;

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
    uint bits = flags[texel];
    float stops = (bits & params.stop_bits_x) != 0u ? 1.0 : 0.0;
    stops += (bits & params.stop_bits_y) != 0u ? 4.0 : 0.0;
    uint last = packHalf2x16(vec2(stops, 0.0));
    imageStore(target, ivec2(pixel), uvec4(words.x, (words.y & 0xffffu) | (last << 16), 0u, 0u));
}
