// What alpha is read by, at a place where a sample has hit a triangle. After scene_buffers.glsl and place.glsl; with the axes ALPHA and
// VERTEX.
#ifndef DEEP_SHADING_PLACE_ALPHA_GLSL
#define DEEP_SHADING_PLACE_ALPHA_GLSL

#ifdef ALPHA_TESTED
#ifdef VERTEX_EXTENDED
layout(std430, set = 0, binding = 8) readonly buffer Placements { PlacementBlock placements[]; };
#endif

#define MATERIAL_PLACE
#include "shading/material.glsl"
#include "techniques/deep_shading/attributes.glsl"
#include "techniques/deep_shading/alpha.glsl"

// What is interpolated for alpha, at a place on the triangle.
void place_alpha(Place place, uint corner) {
    // A layer's pixels are a table apart.
    vec3 right = place.right / float(deep.table_width_px);
    vec3 down = place.down / float(deep.table_height_px);
    uvec3 vertices = uvec3(vertex_of(corner), vertex_of(corner + 1u), vertex_of(corner + 2u));
    mat3x2 uv = mat3x2(uv_at(vertices.x), uv_at(vertices.y), uv_at(vertices.z));
    in_material = draws[params.draw].material;
    in_uv = uv * place.weights;
    in_uv_right = uv * right;
    in_uv_down = uv * down;
#ifdef VERTEX_EXTENDED
    in_color = mat3x4(color_at(vertices.x), color_at(vertices.y), color_at(vertices.z)) * place.weights;
    mat3x2 uv_1 = mat3x2(uv_1_at(vertices.x), uv_1_at(vertices.y), uv_1_at(vertices.z));
    in_uv_1 = uv_1 * place.weights;
    in_uv_1_right = uv_1 * right;
    in_uv_1_down = uv_1 * down;
#endif
}
#endif

#endif
