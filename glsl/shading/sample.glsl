// Numbers as a sample of the picture holds them. What is blended is bounded before it is multiplied by its coverage: what it is laid
// over is too, and so the sum stays finite.
#ifndef SHADING_SAMPLE_GLSL
#define SHADING_SAMPLE_GLSL

#include "halves.glsl"

layout(constant_id = 78) const uint SAMPLES_ARE_HALVES = 0;

vec3 as_sample(vec3 radiance) {
    return SAMPLES_ARE_HALVES != 0u ? held_in_halves(radiance) : radiance;
}

float as_sample(float number) {
    return as_sample(vec3(number)).x;
}

#endif
