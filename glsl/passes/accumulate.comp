// The mean of the pictures of all runs so far (--supersample, --accumulate). Pass: src/passes/accumulate.rs.
#version 460
#include "frame.glsl"

layout(local_size_x = 64, local_size_y = 1) in;

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 1) buffer Sums { vec4 sums[]; };
layout(set = 0, binding = 2, rgba32f) readonly uniform image2D run;
layout(set = 0, binding = 3, rgba32f) writeonly uniform image2D color;

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= frame.width_px || pixel.y >= frame.height_px) {
        return;
    }
    uint index = pixel.y * frame.width_px + pixel.x;
    vec4 sum = imageLoad(run, ivec2(pixel));
    if (frame.sample_index > 0u) {
        sum += sums[index];
    }
    sums[index] = sum;
    imageStore(color, ivec2(pixel), sum / float(frame.sample_index + 1u));
}
