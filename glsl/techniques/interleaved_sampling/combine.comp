// The samples of a member into the sums of the pixels that they lie in. Keller and Heidrich 2001, section 3.1.
// Pass: src/techniques/interleaved_sampling/combine.rs.
#version 460
#include "frame.glsl"

// A basis: so many of it lie along so many pixels.
struct CombineParams {
    uint period_x_px;
    uint period_y_px;
    uint bases_x;
    uint bases_y;
    // Texels of a member's picture.
    uint layer_width;
    uint layer_height;
    // Where in the table the first members of pixels begin.
    uint firsts_at;
};

layout(local_size_x = 64, local_size_y = 1) in;

layout(push_constant) uniform Push { CombineParams params; };
layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 1) readonly buffer Members { uint members[]; };
// xyz: sum of the samples so far; w: their number.
layout(std430, set = 0, binding = 2) buffer Sums { vec4 sums[]; };
layout(set = 0, binding = 3, rgba32f) readonly uniform image2D drawn;

void main() {
    uvec2 texel = gl_GlobalInvocationID.xy;
    if (texel.x >= params.layer_width || texel.y >= params.layer_height) {
        return;
    }
    uint member = frame.sample_index;
    uint first = member * (params.bases_x + params.bases_y);
    uvec2 pixel = uvec2(
        texel.x / params.bases_x * params.period_x_px + members[first + texel.x % params.bases_x],
        texel.y / params.bases_y * params.period_y_px + members[first + params.bases_x + texel.y % params.bases_y]);
    if (pixel.x >= frame.width_px || pixel.y >= frame.height_px) {
        return;
    }
    vec4 sum = vec4(imageLoad(drawn, ivec2(texel)).rgb, 1.0);
    uint index = pixel.y * frame.width_px + pixel.x;
    uint of_period = pixel.y % params.period_y_px * params.period_x_px + pixel.x % params.period_x_px;
    if (members[params.firsts_at + of_period] != member) {
        sum += sums[index];
    }
    sums[index] = sum;
}
