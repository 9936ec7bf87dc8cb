// The light pass in one dispatch: each thread sums the lights of its tile's list up. The compute form of Kircher 2009, section
// 2.2. Pass: src/techniques/inferred_lighting/light/tiled.rs.
// variants: EXTRAS=off|on CULL=tiled|none
#version 460
#include "frame.glsl"
#include "bvh.glsl"
#include "loops.glsl"

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;
// Pixels that a thread lights; a divisor of TILE_PX.
layout(constant_id = 4) const uint TEXELS = 1;

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };

#include "techniques/inferred_lighting/surface.glsl"

layout(std430, set = 0, binding = 1) readonly buffer Lights { LightBlock lights[]; };
layout(std430, set = 0, binding = 2) readonly buffer BvhNodes { BvhNodeBlock bvh_nodes[]; };
layout(std430, set = 0, binding = 3) readonly buffer BvhTriangles { BvhTriangleBlock bvh_triangles[]; };
#ifdef CULL_TILED
layout(std430, set = 0, binding = 4) readonly buffer LightMasks { uint light_masks[]; };
#endif
layout(set = 0, binding = 5, rg32ui) writeonly uniform uimage2D l_buffer;

#include "bvh_walk.glsl"
#include "techniques/inferred_lighting/lighting.glsl"

// Pixels of a column inside one tile: one light list, which is read once.
LitSurface point_surface[TEXELS];
bool point_has_surface[TEXELS];
Lighting point_lighting[TEXELS];

void add_light(LightBlock light) {
    uint i = 0u;
    for (; i < TEXELS; i++) {
        if (point_has_surface[i]) {
            Lighting more = lighting_by(light, point_surface[i]);
            precise vec3 irradiance = point_lighting[i].irradiance + more.irradiance;
            precise vec3 highlight = point_lighting[i].highlight + more.highlight;
            point_lighting[i] = Lighting(irradiance, highlight);
        }
    }
    expect_done(i == TEXELS);
}

#include "shading/each_light.glsl"

void main() {
    uvec2 first = uvec2(gl_GlobalInvocationID.x, gl_GlobalInvocationID.y * TEXELS);
    uvec2 extent = uvec2(frame.width_px, frame.height_px);
    for (uint i = 0u; i < TEXELS; i++) {
        uvec2 pixel = min(first + uvec2(0u, i), extent - 1u);
        point_surface[i] = surface_at(pixel);
        point_has_surface[i] = has_surface_at(pixel);
        point_lighting[i] = ambient_lighting();
    }
    add_each_light(frame, min(first, extent - 1u));
    for (uint i = 0u; i < TEXELS; i++) {
        uvec2 pixel = first + uvec2(0u, i);
        if (pixel.x < extent.x && pixel.y < extent.y) {
            Lighting lighting = Lighting(nan_if_cut(point_lighting[i].irradiance), point_lighting[i].highlight);
            imageStore(l_buffer, ivec2(pixel), uvec4(pack_lighting(lighting), 0u, 0u));
        }
    }
}
