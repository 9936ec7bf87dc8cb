// Triangles while a shutter is open: between their places when it opens and when it closes, along straight lines.
//
// The including shader declares bvh_triangles[] and bvh_closing[] (BvhTriangleBlock).
#ifndef BVH_MOVING_GLSL
#define BVH_MOVING_GLSL

#include "bvh.glsl"

// 1: triangles move.
layout(constant_id = 66) const uint MOVES = 0;

// Moment of this path: 0 when the shutter opens, 1 when it closes.
float shutter_part = 0.0;

BvhTriangleBlock triangle_at(uint index) {
    BvhTriangleBlock triangle = bvh_triangles[index];
    if (MOVES != 0u) {
        BvhTriangleBlock closing = bvh_closing[index];
        triangle.corner.xyz = mix(triangle.corner.xyz, closing.corner.xyz, shutter_part);
        triangle.edge1.xyz = mix(triangle.edge1.xyz, closing.edge1.xyz, shutter_part);
        triangle.edge2.xyz = mix(triangle.edge2.xyz, closing.edge2.xyz, shutter_part);
    }
    return triangle;
}

#endif
