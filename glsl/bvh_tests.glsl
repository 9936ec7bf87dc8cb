// Where a ray enters a box, and whether it meets a triangle: what every walk of the tree asks. Twin: src/bvh/mod.rs.
#ifndef BVH_TESTS_GLSL
#define BVH_TESTS_GLSL

#include "bvh.glsl"

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

#endif
