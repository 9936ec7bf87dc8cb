// Whether a sample lies in a triangle, which it is tested against because the polygon around the triangle's whole way has
// reached its pixel; and what it sees then (section 4.2). Pass: src/techniques/deep_shading/visibility/stochastic.rs.
// variants: ALPHA=opaque|tested VERTEX=plain|extended DEPTH=none|shading
#version 460
#include "frame.glsl"
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/place.glsl"
#include "techniques/deep_shading/counters.glsl"
#include "techniques/deep_shading/visibility/covers.glsl"

// As in shade.frag.
layout(constant_id = 94) const uint IS_COUNTED = 0;

layout(location = 1) flat in uint in_primitive;
layout(location = 2) flat in vec4 in_corners[3];
layout(location = 7) flat in vec4 in_canonical_corners[3];

layout(std430, set = 0, binding = 26) buffer Counters { uint counters[]; };

#include "techniques/deep_shading/visibility/hit.glsl"

#ifdef ALPHA_TESTED
layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
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

// As in sample.frag.
layout(location = 0) out uvec2 out_spid;
#ifdef DEPTH_SHADING
layout(location = 1) out uint out_shading_depth;
#endif

void main() {
    // A layer has one sample a pixel, in its middle: the tuple's shift has put it there.
    vec2 at = gl_FragCoord.xy;
    vec3 weights;
    if (!is_hit(in_corners, at, weights)) {
        discard;
    }
#ifdef ALPHA_TESTED
    place_alpha(hit_place(in_corners, at, weights), 3u * (in_primitive - params.primitive_offset));
    if (!is_seen(base_color_at(params.material).a, uvec2(at), tuple_number(deep, frame.sample_index, params.tuple))) {
        discard;
    }
#endif
    gl_FragDepth = hit_depth(in_corners, weights);
    vec4 canonical = canonical_between(in_canonical_corners, weights);
    out_spid = uvec2(in_primitive, shading_pixel(deep, canonical));
#ifdef DEPTH_SHADING
    out_shading_depth = shading_depth(canonical);
#endif
}
