// The sequence as it is, a pixel's pairs one after the other: what tests/sampling/sobol.rs holds against src/sampling/sobol.rs.
#version 460
#include "sampling/sobol.glsl"

layout(local_size_x = 64) in;

struct SobolParams {
    uint seed;
    // Where the sequence begins, and how many points each pixel and pair has.
    uint first;
    uint count;
    uint pair_count;
};

layout(push_constant) uniform Push { SobolParams params; };
layout(std430, set = 0, binding = 0) writeonly buffer Points { vec2 points[]; };

// As many pixels, in rows of eight, as points[] has room for.
void main() {
    uint at = gl_GlobalInvocationID.x;
    if (at >= uint(points.length())) {
        return;
    }
    uint index = at % params.count;
    uint pair = at / params.count % params.pair_count;
    uint pixel = at / (params.count * params.pair_count);
    uint seed = pair_seed(pixel_seed(uvec2(pixel % 8u, pixel / 8u), params.seed), pair);
    points[at] = sobol_pair(params.first + index, seed);
}
