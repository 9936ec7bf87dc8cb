// A sample into the sum of its pixel. Keller and Heidrich 2001, section 3.1.
#ifndef TECHNIQUES_INTERLEAVED_SAMPLING_COMBINE_GLSL
#define TECHNIQUES_INTERLEAVED_SAMPLING_COMBINE_GLSL

#include "techniques/interleaved_sampling/members.glsl"

// xyz: sum of the samples so far; w: their number.
layout(std430, set = 0, binding = 2) buffer Sums { vec4 sums[]; };

void add_sample(const in uint member, uvec2 pixel, vec3 radiance) {
    vec4 sum = vec4(radiance, 1.0);
    uint index = pixel.y * frame.width_px + pixel.x;
    uint of_period = pixel.y % params.period_y_px * params.period_x_px + pixel.x % params.period_x_px;
    if (members[params.firsts_at + of_period] != member) {
        sum += sums[index];
    }
    sums[index] = sum;
}

#endif
