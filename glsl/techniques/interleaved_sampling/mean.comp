// The mean of each pixel's samples, after the last member. Keller and Heidrich 2001, section 2.1.
// Pass: src/techniques/interleaved_sampling/mean.rs.
// variants: GAPS=none|some
#version 460
#include "frame.glsl"

struct MeanParams {
    // The last run of the picture.
    uint last_run;
};

layout(local_size_x = 64, local_size_y = 1) in;

layout(push_constant) uniform Push { MeanParams params; };
layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 1) readonly buffer Sums { vec4 sums[]; };
#ifdef GAPS_SOME
// The pixel whose samples a pixel shows: its own where it has some.
layout(std430, set = 0, binding = 2) readonly buffer PixelSources { uint sources[]; };
// No pixel of the frame has a sample.
const uint NO_SOURCE = 0xffffffffu;
#endif
layout(set = 0, binding = 3, rgba32f) writeonly uniform image2D color;

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (frame.sample_index != params.last_run || pixel.x >= frame.width_px || pixel.y >= frame.height_px) {
        return;
    }
    uint source = pixel.y * frame.width_px + pixel.x;
#ifdef GAPS_SOME
    source = sources[source];
    vec4 sum = source == NO_SOURCE ? vec4(vec3(0.0), 1.0) : sums[source];
#else
    vec4 sum = sums[source];
#endif
    imageStore(color, ivec2(pixel), vec4(sum.rgb / sum.w, 1.0));
}
