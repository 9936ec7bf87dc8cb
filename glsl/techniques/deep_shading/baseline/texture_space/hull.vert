// All texels that look-ups on a triangle read, at its level of its draw's texture: four around each of its places. Nothing of what
// no sample can see. Pass: src/techniques/deep_shading/baseline/texture_space/hull.rs.
#version 460
#include "frame.glsl"
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/visibility/seen.glsl"
#include "techniques/deep_shading/visibility/triangle.glsl"
#include "techniques/deep_shading/visibility/bound.glsl"
#include "techniques/deep_shading/hull.glsl"
#include "techniques/deep_shading/baseline/texture_space/atlas.glsl"
#include "techniques/deep_shading/baseline/texture_space/sparse.glsl"

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };

// Index of the triangle in the index buffer.
layout(location = 0) flat out uint out_triangle;
layout(location = 1) flat out uint out_level;
// Claims and shading draw the same texels: what one of them leaves out would show what was there before.
invariant gl_Position;

void main() {
    uint vertex = uint(gl_VertexIndex) % HULL_VERTICES;
    uint triangle = uint(gl_VertexIndex) / HULL_VERTICES;
    out_triangle = triangle;
    out_level = 0u;
    gl_Position = vec4(0.0, 0.0, 0.5, 1.0);
    Seen seen[6];
    see_triangle(triangle, seen);
    if (!may_be_seen(seen, vec2(frame.width_px, frame.height_px))) {
        return;
    }
    uint level = level_of(triangle, canonical_corners(triangle));
    out_level = level;
    vec2 at[3] = charted_at(triangle, level).corners;
    float side = float(level_side(level));
    // A look-up reads middles that are less than a texel away on either axis.
    Hull hull = hull_around(
        vec4(at[0], 0.0, 1.0), vec4(at[1], 0.0, 1.0), vec4(at[2], 0.0, 1.0), 1.0 + snap_px(), vec2(side));
    // Levels lie over each other in the corner: nothing is attached.
    gl_Position = vec4(fan_corner(hull, vertex) * 2.0 / float(level_side(0u)) - 1.0, 0.5, 1.0);
}
