// What deferred shading and the composite share: the surface at a pixel, and its direct light.
//
// The including shader has the axes POSITION, EMISSIVE and CULL.
#ifndef PASSES_COMPOSITE_GLSL
#define PASSES_COMPOSITE_GLSL

#include "passes/gbuffer_read.glsl"
#include "bvh.glsl"
#include "shading/light.glsl"

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;
// Pixels that a thread shades; a divisor of TILE_PX.
layout(constant_id = 4) const uint TEXELS = 1;
// BRDF_ and SHADOW_ values.
layout(constant_id = 2) const uint BRDF_KIND = 2;
layout(constant_id = 3) const uint DIRECT_SHADOW = 0;

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 1) readonly buffer Lights { LightBlock lights[]; };
layout(std430, set = 0, binding = 2) readonly buffer BvhNodes { BvhNodeBlock bvh_nodes[]; };
layout(std430, set = 0, binding = 3) readonly buffer BvhTriangles { BvhTriangleBlock bvh_triangles[]; };
#ifdef CULL_TILED
layout(std430, set = 0, binding = 4) readonly buffer LightMasks { uint light_masks[]; };
#endif
layout(set = 0, binding = 5, rgba32f) writeonly uniform image2D color;
layout(set = 0, binding = 42) uniform usampler2D gbuffer_color;
#ifdef EMISSIVE_ON
layout(set = 0, binding = 43) uniform usampler2D gbuffer_emissive;
#endif

#include "bvh_walk.glsl"

// What few materials say (shading/extras.glsl).
uint extras_at(uvec2 pixel) {
#ifdef EMISSIVE_ON
    return last16(texelFetch(gbuffer_emissive, ivec2(pixel), 0).rg);
#else
    return 0u;
#endif
}

vec3 emitted_at(uvec2 pixel) {
#ifdef EMISSIVE_ON
    return unpack_halves(texelFetch(gbuffer_emissive, ivec2(pixel), 0).rg);
#else
    return vec3(0.0);
#endif
}

// A thread shades TEXELS pixels of a column inside one tile, so that they have one light list. Their radiance is that of all punctual
// lights.
#include "shading/lit_points.glsl"

// Part of the ambient light that arrives; read where SURFACE_EXTRAS is 1 only.
float point_openness[TEXELS];

// The i-th pixel of a thread; it may lie under the frame.
uvec2 pixel_of_point(uint i) {
    return uvec2(gl_GlobalInvocationID.x, gl_GlobalInvocationID.y * TEXELS + i);
}

bool is_in_frame(uvec2 pixel) {
    return pixel.x < frame.width_px && pixel.y < frame.height_px;
}

// Reads what the i-th pixel shows; the position only where lights need it.
void set_point(uint i, bool needs_position) {
    uvec2 last = uvec2(frame.width_px, frame.height_px) - 1u;
    uvec2 pixel = min(pixel_of_point(i), last);
    uvec2 normal_bits = normal_words(pixel);
    vec2 roughness_metallic = unpack_roughness_metallic(normal_bits);
    vec3 base_color = unpack_halves(texelFetch(gbuffer_color, ivec2(pixel), 0).rg);
    point_is_shaded[i] = is_in_frame(pixel_of_point(i)) && has_surface(normal_bits);
    point_surface[i] = Surface(base_color, roughness_metallic.y, roughness_metallic.x, DEFAULT_DIELECTRIC_F0);
    if (SURFACE_EXTRAS != 0u) {
        uint extras = extras_at(pixel);
        point_surface[i].dielectric_f0 = f0_of_extras(extras);
        point_openness[i] = openness_of_extras(extras);
    }
    point_normal_ws[i] = unpack_normal(normal_bits);
    if (needs_position) {
        point_position_ws[i] = unpack_position(frame, position_words(pixel), pixel);
        point_eye_ws[i] = to_eye(frame, point_position_ws[i]);
    }
}

// Radiance towards the eye from light that comes from everywhere.
vec3 ambient_of(uint i) {
    precise vec3 reflected = ambient_reflectance(BRDF_KIND, point_surface[i]) * frame.ambient.rgb;
    if (SURFACE_EXTRAS != 0u) {
        reflected *= point_openness[i];
    }
    return reflected;
}

#include "shading/each_light.glsl"

// All punctual lights, in the order of the list.
void shade_points() {
    for (uint i = 0u; i < TEXELS; i++) {
        point_radiance[i] = vec3(0.0);
    }
    uvec2 last = uvec2(frame.width_px, frame.height_px) - 1u;
    add_each_light(frame, min(pixel_of_point(0u), last));
    for (uint i = 0u; i < TEXELS; i++) {
        point_radiance[i] = nan_if_cut(point_radiance[i]);
    }
}

#endif
