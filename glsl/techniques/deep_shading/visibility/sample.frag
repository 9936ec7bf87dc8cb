// What a sample sees: the id of the triangle and its shading point, packed (a SPID), and perhaps the depth there.
// Pass: src/techniques/deep_shading/visibility/sample.rs. Appendix A, pass 1.
// VERTICES: the triangle's number comes from the vertex it is drawn by, or from the device.
// variants: ALPHA=opaque|tested VERTEX=plain|extended DEPTH=none|shading VERTICES=fetched|indexed
#version 460
#include "frame.glsl"
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/place.glsl"
#include "techniques/deep_shading/scaled.glsl"
#include "techniques/deep_shading/visibility/covers.glsl"
#include "techniques/deep_shading/visibility/seen.glsl"
#include "techniques/deep_shading/visibility/triangle.glsl"

layout(location = 0) in vec4 in_canonical;
#ifdef VERTICES_FETCHED
layout(location = 1) flat in uint in_primitive;
#endif
layout(location = 6) flat in uint in_tuple;

// 1: tuples are drawn together and reach beyond the frame.
layout(constant_id = 96) const uint HAS_PADDING = 0;

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 4) readonly buffer Tuples { TupleBlock tuples[]; };
#ifdef ALPHA_TESTED
layout(location = 3) in vec2 in_uv_here;
#ifdef VERTEX_EXTENDED
layout(location = 4) in vec4 in_color_here;
layout(location = 5) in vec2 in_uv_1_here;
layout(std430, set = 0, binding = 8) readonly buffer Placements { PlacementBlock placements[]; };
#endif

#define MATERIAL_PLACE
#include "shading/material.glsl"
#include "techniques/deep_shading/alpha.glsl"
#endif

// x: the triangle's id; y: its shading pixel, 16 bits a side, or NO_SHADING_PIXEL.
layout(location = 0) out uvec2 out_spid;
#ifdef DEPTH_SHADING
layout(location = 1) out uint out_shading_depth;
#endif

// Whether a layer's pixel lies beyond the frame: one scissor for all layers cannot keep it out.
bool is_padding(uvec2 at) {
    uvec2 table = uvec2(deep.table_width_px, deep.table_height_px);
    uint cell = in_tuple / deep.sample_count;
    uvec2 pixel = at * table + uvec2(cell % table.x, cell / table.x % table.y);
    return pixel.x >= frame.width_px || pixel.y >= frame.height_px;
}

// The drawn triangle's place among all.
uint drawn_triangle() {
#ifdef VERTICES_INDEXED
    return params.first_triangle + uint(gl_PrimitiveID);
#else
    return in_primitive - params.primitive_offset;
#endif
}

// The rasteriser moves corners by up to half of the step that SUB_PIXEL_BITS says, so that fragments may lie beside their triangle.
// Where neighbours lie no more pixels of shading space apart than this, that is no more than hulls are drawn too large by.
const float STEEP_PX = 4.0;

// Whether the triangle is seen so nearly edge-on that what lies beside it can be far away in shading space.
bool is_steep() {
    vec2 rates = fwidth(in_canonical.xy / in_canonical.w);
    bool is_even = max(rates.x, rates.y) <= STEEP_PX && fwidth(in_canonical.w) <= 0.5 * abs(in_canonical.w);
    return !is_even;
}

// Where the sample sees the triangle in shading space, or, where `is_wanted`, the triangle's place beside it.
vec4 inside_canonical(uint triangle, bool is_wanted) {
    vec4 canonical = in_canonical;
    // A loop, and no branch: software drivers run a branch that no lane takes, and such triangles are few.
    for (bool is_missing = is_wanted; is_missing; is_missing = false) {
        TupleBlock tuple = tuples[frame.sample_index * deep.tuple_count + in_tuple];
        Seen seen[6];
        see_triangle(triangle, seen);
        vec2 from[3];
        vec4 canonical_corners[3];
        for (uint corner = 0u; corner < 3u; corner++) {
            from[corner] = from_sample(layer_corner(seen[corner], seen[corner + 3u], tuple), gl_FragCoord.xy);
            canonical_corners[corner] = canonical_of(seen[corner], seen[corner + 3u]);
        }
        vec3 weights = covered_weights(areas_of(from[0], from[1], from[2]));
        if (any(lessThan(weights, vec3(0.0)))) {
            canonical = canonical_between(canonical_corners, inside_weights(weights));
        }
    }
    return canonical;
}

void main() {
    bool is_wanted = is_steep();
#ifdef ALPHA_TESTED
    // A layer's pixels are a table apart.
    vec2 pixels = vec2(deep.table_width_px, deep.table_height_px);
    in_material = draws[params.draw].material;
    in_uv = in_uv_here;
    in_uv_right = dFdx(in_uv_here) / pixels.x;
    in_uv_down = dFdy(in_uv_here) / pixels.y;
#ifdef VERTEX_EXTENDED
    in_color = in_color_here;
    in_uv_1 = in_uv_1_here;
    in_uv_1_right = dFdx(in_uv_1_here) / pixels.x;
    in_uv_1_down = dFdy(in_uv_1_here) / pixels.y;
#endif
    float alpha = base_color_at(params.material).a;
    if (!is_seen(alpha, uvec2(gl_FragCoord.xy), tuple_number(deep, frame.sample_index, in_tuple))) {
        discard;
    }
#endif
    // After the derivatives: a quad at the rim has them of all its pixels.
    if (HAS_PADDING != 0u && is_padding(uvec2(gl_FragCoord.xy))) {
        discard;
    }
    uint triangle = drawn_triangle();
    vec4 canonical = inside_canonical(triangle, is_wanted);
    uint primitive = triangle + params.primitive_offset;
    out_spid = uvec2(primitive, shading_pixel(deep, scaled(canonical, primitive)));
#ifdef DEPTH_SHADING
    out_shading_depth = shading_depth(canonical);
#endif
}
