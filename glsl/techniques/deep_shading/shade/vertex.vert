// Conservative rasterisation without a geometry shader: every corner of a triangle's hull makes the hull for itself.
// Pass: src/techniques/deep_shading/shade/vertex.rs.
// variants: MARKS=off|on
#version 460
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/scaled.glsl"
#include "techniques/deep_shading/shade/hull.glsl"

// 1: it lies as far back as it may (depth.glsl), for a depth test.
layout(constant_id = 110) const uint HAS_ZMAX = 0;

layout(location = 0) flat out uint out_primitive;
#ifdef MARKS_ON
layout(std430, set = 0, binding = 44) readonly buffer Marks { uint marks[]; };
#include "techniques/deep_shading/lists/marks.glsl"
#endif

void main() {
    uint vertex = uint(gl_VertexIndex) % HULL_VERTICES;
    uint triangle = uint(gl_VertexIndex) / HULL_VERTICES;
    out_primitive = params.primitive_offset + triangle;
#ifdef MARKS_ON
    if (!is_marked(out_primitive)) {
        // Outside the view: some devices draw what has no area.
        gl_Position = vec4(-2.0, -2.0, 0.5, 1.0);
        return;
    }
#endif
    vec4 corners[3];
    for (uint corner = 0u; corner < 3u; corner++) {
        corners[corner] = scaled(canonical_corner(3u * triangle + corner), out_primitive);
    }
    Hull hull = hull_of(corners[0], corners[1], corners[2]);
    if (hull.count == 0u) {
        gl_Position = vec4(0.0, 0.0, 0.5, 1.0);
        return;
    }
    Depths depths = Depths(vec2(0.0), 0.5);
    if (HAS_ZMAX != 0u) {
        depths = hull_depths(corners[0], corners[1], corners[2], hull);
    }
    vec2 at = fan_corner(hull, vertex);
    vec2 extent = vec2(deep.shading_width_px, deep.shading_height_px);
    gl_Position = vec4(at * 2.0 / extent - 1.0, depth_at(depths, at), 1.0);
}
