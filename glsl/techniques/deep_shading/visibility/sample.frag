// What a sample sees: the id of the triangle and its shading point, packed (a SPID), and perhaps the depth there.
// Pass: src/techniques/deep_shading/visibility/sample.rs. Appendix A, pass 1.
// variants: ALPHA=opaque|tested VERTEX=plain|extended DEPTH=none|shading
#version 460
#include "frame.glsl"
#include "techniques/deep_shading/scene_buffers.glsl"

layout(location = 0) in vec4 in_canonical;
layout(location = 1) flat in uint in_primitive;
layout(location = 2) in vec3 in_weights;
layout(location = 6) flat in uint in_tuple;

// 1: tuples are drawn together and reach beyond the frame.
layout(constant_id = 96) const uint HAS_PADDING = 0;

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
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

void main() {
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
    vec4 canonical = in_canonical;
    if (any(lessThan(in_weights, vec3(0.0)))) {
        uint corner = 3u * (in_primitive - params.primitive_offset);
        canonical = canonical_at(corner, inside_weights(in_weights));
    }
    out_spid = uvec2(in_primitive, shading_pixel(deep, canonical));
#ifdef DEPTH_SHADING
    out_shading_depth = shading_depth(canonical);
#endif
}
