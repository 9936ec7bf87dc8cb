// A homogeneous medium in a box, and what it stops. Twin: src/shading/medium.rs.
#ifndef SHADING_MEDIUM_BOX_GLSL
#define SHADING_MEDIUM_BOX_GLSL

#include "shading/box.glsl"

struct MediumBlock {
    // The box that it fills; all 0 where there is no medium.
    vec4 min_ws;
    vec4 max_ws;
    // Light that a metre scatters, and all that it stops.
    float scattering;
    float extinction;
    // Mean cosine of the angle by which light is turned, -1 to 1.
    float asymmetry;
    uint _unused;
};

// Where the medium's box begins and ends on a ray between two places of it, in metres.
vec2 in_medium(MediumBlock medium, vec3 origin, vec3 direction, float from, float to) {
    return in_box(medium.min_ws.xyz, medium.max_ws.xyz, origin, direction, from, to);
}

// Part of the light that passes a stretch of a ray.
float passed_by(MediumBlock medium, vec2 ends) {
    return exp(-medium.extinction * (ends.y - ends.x));
}

// Part of the light that passes from a place for `distance` metres; all of it where there is no medium.
float passed_towards(MediumBlock medium, vec3 from_ws, vec3 direction_ws, float distance) {
    if (medium.extinction > 0.0) {
        return passed_by(medium, in_medium(medium, from_ws, direction_ws, 0.0, distance));
    }
    return 1.0;
}

#endif
