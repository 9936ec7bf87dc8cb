// A ray through the tree. The including shader declares `bvh_nodes[]` and `bvh_triangles[]` (bvh.glsl has their types).
// Twin: src/bvh.rs, `Bvh::occluded`.
#ifndef BVH_WALK_GLSL
#define BVH_WALK_GLSL

#include "loops.glsl"

// Deep enough for any tree that src/bvh.rs accepts.
const int BVH_STACK = 64;

float box_entry(BvhNodeBlock node, vec3 origin, vec3 inverse, float limit) {
    vec3 near = (node.min_count.xyz - origin) * inverse;
    vec3 far = (node.max_first.xyz - origin) * inverse;
    vec3 low = min(near, far);
    vec3 high = max(near, far);
    float entry = max(max(low.x, low.y), max(low.z, 0.0));
    float leave = min(min(high.x, high.y), min(high.z, limit));
    return entry <= leave ? entry : -1.0;
}

// `met`: distance in lengths of the direction, weights of the second and the third corner.
bool triangle_hit(BvhTriangleBlock triangle, vec3 origin, vec3 direction, float limit, out vec3 met) {
    met = vec3(0.0);
    vec3 p = cross(direction, triangle.edge2.xyz);
    float determinant = dot(triangle.edge1.xyz, p);
    if (determinant == 0.0) {
        return false;
    }
    float inverse = 1.0 / determinant;
    vec3 offset = origin - triangle.corner.xyz;
    float u = dot(offset, p) * inverse;
    vec3 q = cross(offset, triangle.edge1.xyz);
    float v = dot(direction, q) * inverse;
    float t = dot(triangle.edge2.xyz, q) * inverse;
    met = vec3(t, u, v);
    return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 && t < limit;
}

// Whether anything lies between a surface point and a light `distance` away in the unit direction.
bool occluded(vec3 position_ws, vec3 normal_ws, vec3 direction_ws, float distance) {
    vec3 origin = position_ws + normal_ws * RAY_OFFSET;
    float limit = distance - 2.0 * RAY_OFFSET;
    vec3 inverse = 1.0 / mix(direction_ws, vec3(1e-20), equal(direction_ws, vec3(0.0)));
    vec3 met;
    uint stack[BVH_STACK];
    int depth = 0;
    stack[depth++] = 0u;
    while (depth > 0) {
        BvhNodeBlock node = bvh_nodes[stack[--depth]];
        if (box_entry(node, origin, inverse, limit) < 0.0) {
            continue;
        }
        uint count = floatBitsToUint(node.min_count.w);
        uint first = floatBitsToUint(node.max_first.w);
        if (count == 0u) {
            if (depth + 2 <= BVH_STACK) {
                stack[depth++] = first;
                stack[depth++] = first + 1u;
            }
            continue;
        }
        uint triangle = first;
        for (; triangle < first + count; triangle++) {
            if (triangle_hit(bvh_triangles[triangle], origin, direction_ws, limit, met)) {
                return true;
            }
        }
        expect_done(triangle == first + count);
    }
    expect_done(depth == 0);
    return false;
}

#endif
