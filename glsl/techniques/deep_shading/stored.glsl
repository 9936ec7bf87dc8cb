// Colours as buffers of one entry a sample hold them.
#ifndef DEEP_SHADING_STORED_GLSL
#define DEEP_SHADING_STORED_GLSL

#include "halves.glsl"

// Two words: red and green, blue and 1, as half floats. The 1 says that it was stored.
uvec2 stored_color(vec3 radiance) {
    radiance = held_in_halves(radiance);
    return uvec2(packHalf2x16(radiance.rg), packHalf2x16(vec2(radiance.b, 1.0)));
}

#endif
