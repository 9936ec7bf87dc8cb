// Numbers as a sample of the picture holds them. What is blended is bounded before it is multiplied by its coverage: what it is laid
// over is too, and so the sum stays finite.
#ifndef SHADING_SAMPLE_GLSL
#define SHADING_SAMPLE_GLSL

// The samples are half floats, whose greatest is this.
layout(constant_id = 104) const uint SAMPLES_ARE_HALVES = 0;
const float MOST_SAMPLE = 65504.0;

// A comparison and no min(), which may take NaN for the greater.
vec3 as_sample(vec3 radiance) {
    if (SAMPLES_ARE_HALVES == 0u) {
        return radiance;
    }
    return mix(radiance, vec3(MOST_SAMPLE), greaterThan(radiance, vec3(MOST_SAMPLE)));
}

float as_sample(float number) {
    return as_sample(vec3(number)).x;
}

#endif
