// Surface points that a thread shades together, so that it reads each light once for all of them: software drivers read a buffer
// lane by lane, which costs more than the arithmetic of a point.
//
// The including shader declares the constant TEXELS, how many, includes loops.glsl and has what shade_lights.glsl needs.
#ifndef SHADING_LIT_POINTS_GLSL
#define SHADING_LIT_POINTS_GLSL

#include "shading/shade_lights.glsl"

// There is a surface that light changes.
bool point_is_shaded[TEXELS];
Surface point_surface[TEXELS];
vec3 point_position_ws[TEXELS];
vec3 point_normal_ws[TEXELS];
vec3 point_eye_ws[TEXELS];
// Towards the eye: what the shader begins with, and then that of each light in turn.
vec3 point_radiance[TEXELS];

void add_light(LightBlock light) {
    uint i = 0u;
    for (; i < TEXELS; i++) {
        if (point_is_shaded[i]) {
            precise vec3 sum = point_radiance[i]
                + shade_light(light, point_surface[i], point_position_ws[i], point_normal_ws[i], point_eye_ws[i]);
            point_radiance[i] = sum;
        }
    }
    expect_done(i == TEXELS);
}

#endif
