// A corner of a triangle in canonical shading space, clip space of its frame. Pass:
// src/techniques/deep_shading/shade/corner.rs. Appendix A, pass 3.
// variants: MARKS=off|on WEIGHTS=off|on
#version 460
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/scaled.glsl"
#include "techniques/deep_shading/shade/depth.glsl"

// 1: the triangle is as near as its nearest corner (depth.glsl), for a depth test.
layout(constant_id = 111) const uint HAS_ONE_DEPTH = 0;

layout(location = 0) flat out uint out_primitive;
#ifdef WEIGHTS_ON
layout(location = 1) out vec3 out_weights;
#endif
#ifdef MARKS_ON
layout(std430, set = 0, binding = 44) readonly buffer Marks { uint marks[]; };
#include "techniques/deep_shading/lists/marks.glsl"
#endif

void main() {
    uint corner = uint(gl_VertexIndex);
    out_primitive = params.primitive_offset + corner / 3u;
#ifdef WEIGHTS_ON
    out_weights = vec3(equal(uvec3(0u, 1u, 2u), uvec3(corner % 3u)));
#endif
#ifdef MARKS_ON
    if (!is_marked(out_primitive)) {
        // Outside the view: some devices draw what has no area.
        gl_Position = vec4(-2.0, -2.0, 0.5, 1.0);
        return;
    }
#endif
    vec4 canonical = scaled(canonical_corner(corner), out_primitive);
    vec2 extent = vec2(deep.shading_width_px, deep.shading_height_px);
    float z = canonical.z;
    if (HAS_ONE_DEPTH != 0u) {
        uint first = corner - corner % 3u;
        z = canonical.w * nearest_depths(
            canonical_corner(first), canonical_corner(first + 1u), canonical_corner(first + 2u)).at_origin;
    }
    gl_Position = vec4(canonical.xy * 2.0 / extent - canonical.w, z, canonical.w);
}
