// A ray through the tree, without a stack. The including shader declares `bvh_nodes[]`, in the order of src/bvh/flat.rs, and
// `bvh_triangles[]` (bvh.glsl has their types). Twin: src/bvh/shadow.rs.
#ifndef BVH_WALK_GLSL
#define BVH_WALK_GLSL

#include "bvh_tests.glsl"
#include "loops.glsl"

// Where a walk through the tree is, and the leaf that it has entered; no triangles: none yet.
struct NodeWalk {
    uint at;
    uint first_triangle;
    uint triangle_count;
};

// One node further, unless a leaf is entered or the walk has ended.
void visit_node(inout NodeWalk walk, uint end, vec3 origin, vec3 inverse, float limit) {
    if (walk.triangle_count != 0u || walk.at >= end) {
        return;
    }
    BvhNodeBlock node = bvh_nodes[walk.at];
    bool is_entered = box_entry(node, origin, inverse, limit) >= 0.0;
    uint count = floatBitsToUint(node.min_count.w);
    // First triangle of a leaf; for other nodes the place after all below them.
    uint first = floatBitsToUint(node.max_first.w);
    walk.at = count == 0u && !is_entered ? first : walk.at + 1u;
    walk.first_triangle = first;
    walk.triangle_count = is_entered ? count : 0u;
}

// Whether anything lies between a surface point and a light `distance` away in the unit direction.
bool occluded(vec3 position_ws, vec3 normal_ws, vec3 direction_ws, float distance) {
    vec3 offset = normal_ws * RAY_OFFSET;
    vec3 origin = position_ws + offset;
    // Off the surface the light lies another way: the shadow of what is close to a lamp would fall beside its place. A sun is
    // too far for squares of floats, and for this.
    if (offset != vec3(0.0) && distance < 1e15) {
        vec3 to_light = direction_ws * distance - offset;
        distance = length(to_light);
        direction_ws = to_light / max(distance, 1e-12);
    }
    float limit = distance - 2.0 * RAY_OFFSET;
    // The least and the greatest of NaN and a number may be the number: boxes would hold such a ray.
    if (!(limit > 0.0)) {
        return false;
    }
    vec3 inverse = 1.0 / mix(direction_ws, vec3(1e-20), equal(direction_ws, vec3(0.0)));
    vec3 met;
    BvhNodeBlock root = bvh_nodes[0];
    uint end = floatBitsToUint(root.min_count.w) == 0u ? floatBitsToUint(root.max_first.w) : 1u;
    NodeWalk walk = NodeWalk(0u, 0u, 0u);
    while (walk.at < end) {
        walk.triangle_count = 0u;
        // Several nodes an iteration: a driver may count iterations, of all rays of a thread together (loops.glsl).
        visit_node(walk, end, origin, inverse, limit);
        visit_node(walk, end, origin, inverse, limit);
        visit_node(walk, end, origin, inverse, limit);
        visit_node(walk, end, origin, inverse, limit);
        uint triangle = walk.first_triangle;
        uint triangle_end = walk.first_triangle + walk.triangle_count;
        for (; triangle < triangle_end; triangle++) {
            if (triangle_hit(bvh_triangles[triangle], origin, direction_ws, limit, met)) {
                return true;
            }
        }
        expect_done(triangle == triangle_end);
    }
    expect_done(walk.at >= end);
    return false;
}

#endif
