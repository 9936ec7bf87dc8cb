// Conservative rasterisation in software: a triangle's hull in its place (section 4.4, a).
// Pass: src/techniques/deep_shading/shade/geometry.rs.
// variants: MARKS=off|on
#version 460
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/shade/hull.glsl"

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
    for (uint place = 0u; place < hull.count; place++) {
        out_primitive = in_primitive[0];
        gl_Position = vec4(hull.corners[strip_corner(place, hull.count)] * 2.0 / extent - 1.0, 0.5, 1.0);
        EmitVertex();
    }
    EndPrimitive();
}
