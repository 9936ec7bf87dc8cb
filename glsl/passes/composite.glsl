// What deferred shading and the composite share: the surface at a pixel, and its direct light.
//
// The including shader has the axes POSITION, EMISSIVE and CULL.
#ifndef PASSES_COMPOSITE_GLSL
#define PASSES_COMPOSITE_GLSL

#include "passes/gbuffer_read.glsl"
#include "bvh.glsl"
#include "shading/light.glsl"

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;
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
#include "shading/shade_lights.glsl"
#include "lights/cull.glsl"

vec3 emitted_at(uvec2 pixel) {
#ifdef EMISSIVE_ON
    return unpack_halves(texelFetch(gbuffer_emissive, ivec2(pixel), 0).rg);
#else
    return vec3(0.0);
#endif
}

// Radiance towards the eye from all punctual lights, summed in the order of the list.
vec3 direct_light(uvec2 pixel, Surface surface, vec3 position_ws, vec3 normal_ws) {
    vec3 eye_ws = to_eye(frame, position_ws);
    precise vec3 sum = vec3(0.0);
#ifdef CULL_TILED
    uint word_count = (frame.light_count + 31u) / 32u;
    uint base = tile_of(pixel, frame.width_px) * word_count;
    for (uint word = 0u; word < word_count; word++) {
        uint bits = light_masks[base + word];
        while (bits != 0u) {
            uint light = word * 32u + uint(findLSB(bits));
            bits &= bits - 1u;
            sum += shade_light(lights[light], surface, position_ws, normal_ws, eye_ws);
        }
    }
#else
    for (uint light = 0u; light < frame.light_count; light++) {
        sum += shade_light(lights[light], surface, position_ws, normal_ws, eye_ws);
    }
#endif
    return sum;
}

#endif
