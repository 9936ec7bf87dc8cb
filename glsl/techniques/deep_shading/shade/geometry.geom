// Conservative rasterisation in software: a triangle's hull in its place (section 4.4, a).
// Pass: src/techniques/deep_shading/shade/geometry.rs.
// variants: MARKS=off|on
#version 460
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/shade/hull.glsl"

// 1: it lies as far back as it may (depth.glsl), for a depth test.
layout(constant_id = 110) const uint HAS_ZMAX = 0;

layout(triangles) in;
layout(triangle_strip, max_vertices = 8) out;

layout(location = 0) flat in uint in_primitive[];
layout(location = 0) flat out uint out_primitive;
#ifdef MARKS_ON
layout(std430, set = 0, binding = 44) readonly buffer Marks { uint marks[]; };
#include "techniques/deep_shading/lists/marks.glsl"
#endif

void main() {
#ifdef MARKS_ON
    if (!is_marked(in_primitive[0])) {
        return;
    }
#endif
    vec2 extent = vec2(deep.shading_width_px, deep.shading_height_px);
    vec4 corners[3];
    for (uint index = 0u; index < 3u; index++) {
        vec4 at = gl_in[index].gl_Position;
        corners[index] = vec4((at.xy + at.w) * 0.5 * extent, at.zw);
    }
    Hull hull = hull_of(corners[0], corners[1], corners[2]);
    Depths depths = Depths(vec2(0.0), 0.5);
    if (HAS_ZMAX != 0u) {
        depths = hull_depths(corners[0], corners[1], corners[2], hull);
    }
    for (uint place = 0u; place < hull.count; place++) {
        out_primitive = in_primitive[0];
        vec2 corner = hull.corners[strip_corner(place, hull.count)];
        gl_Position = vec4(corner * 2.0 / extent - 1.0, depth_at(depths, corner), 1.0);
        EmitVertex();
    }
    EndPrimitive();
}
