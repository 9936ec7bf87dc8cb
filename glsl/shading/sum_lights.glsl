// Punctual lights in turn on a surface that is known already: by forward shading from its material, by deferred from what was
// stored of it.
//
// The including shader declares: `frame`, `lights[]`, what bvh_walk.glsl and shade_lights.glsl need, and, with the axis
// LISTS=object, `light_lists[]` (src/lights/object_lists.rs).
#ifndef SHADING_SUM_LIGHTS_GLSL
#define SHADING_SUM_LIGHTS_GLSL

#include "shading/shade_lights.glsl"

// `radiance` towards the eye, and that of the lights after it in their order. `first`, `count`: the stretch of the list, or of
// the lights where there is none.
vec3 sum_lights(vec3 radiance, Surface surface, vec3 position_ws, vec3 normal_ws, uint first, uint count) {
    vec3 eye_ws = to_eye(frame, position_ws);
    precise vec3 sum = radiance;
    uint index = 0u;
    for (; index < count; index++) {
#ifdef LISTS_OBJECT
        LightBlock light = lights[light_lists[first + index]];
#else
        LightBlock light = lights[first + index];
#endif
        sum += shade_light(light, surface, position_ws, normal_ws, eye_ws);
    }
    expect_done(index == count);
    return sum;
}

#endif
