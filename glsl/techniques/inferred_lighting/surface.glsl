// What the geometry pass left, as the light pass reads it, and what one light adds to the L-buffer there. Compute and
// fragment shaders run the same code: the sums have the same bits. Kircher 2009, section 2.2.
//
// The including shader has the axis EXTRAS and declares `frame`, of the light buffer's extent, and what bvh.glsl needs.
#ifndef INFERRED_LIGHTING_SURFACE_GLSL
#define INFERRED_LIGHTING_SURFACE_GLSL

#include "techniques/inferred_lighting/encoding.glsl"
#include "passes/depth.glsl"
#include "shading/light.glsl"
#include "shading/brdf.glsl"
#include "techniques/inferred_lighting/l_buffer.glsl"

layout(set = 0, binding = 40) uniform sampler2D geometry_depth;
layout(set = 0, binding = 41) uniform usampler2D geometry_normal;
#ifdef EXTRAS_ON
layout(set = 0, binding = 42) uniform usampler2D geometry_extras;
#endif

// BRDF_ and SHADOW_ values.
layout(constant_id = 2) const uint BRDF_KIND = 2;
layout(constant_id = 3) const uint DIRECT_SHADOW = 0;
// Roughness of every surface where the geometry pass writes no specular power.
layout(constant_id = 5) const float ROUGHNESS = 0.5;

// Depth is reversed: nothing is farther than 0.
bool has_surface_at(uvec2 pixel) {
    return texelFetch(geometry_depth, ivec2(pixel), 0).r > 0.0;
}

vec3 position_at(uvec2 pixel) {
    return position_from_depth(frame, pixel, texelFetch(geometry_depth, ivec2(pixel), 0).r);
}

struct LitSurface {
    vec3 position_ws;
    vec3 normal_ws;
    vec3 eye_ws;
    float roughness;
    vec3 f0;
    float f90;
};

LitSurface surface_at(uvec2 pixel) {
    LitSurface surface;
    surface.position_ws = position_at(pixel);
    uint normal_word = texelFetch(geometry_normal, ivec2(pixel), 0).r;
    surface.normal_ws = world_from_view(frame, unpack_view_normal(normal_word));
    surface.eye_ws = to_eye(frame, surface.position_ws);
#ifdef EXTRAS_ON
    uint extras = texelFetch(geometry_extras, ivec2(pixel), 0).r;
    uint f0_code = f0_code_of_extras(extras);
    surface.roughness = roughness_of_extras(extras);
    surface.f0 = unpack_f0(f0_code);
    surface.f90 = f0_code == 0u ? 0.0 : 1.0;
#else
    // Highlights that need to know it are refused.
    surface.roughness = ROUGHNESS;
    surface.f0 = vec3(0.0);
    surface.f90 = 1.0;
#endif
    return surface;
}

#endif
