// Counters that fragments add to which write nothing else, in shaders with the axis COUNT. A constant would not do: lavapipe ends a
// scene at every draw whose fragments declare a buffer that they might write, whatever is left of it.
#ifndef DEEP_SHADING_COUNTING_GLSL
#define DEEP_SHADING_COUNTING_GLSL

#include "techniques/deep_shading/counters.glsl"

#ifdef COUNT_ON
layout(std430, set = 0, binding = 26) buffer Counters { uint counters[]; };
#endif

void count(uint counter) {
#ifdef COUNT_ON
    atomicAdd(counters[counter], 1u);
#endif
}

#endif
