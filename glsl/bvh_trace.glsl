// A ray through the whole tree that asks alpha where a triangle says so: nearest hits and shadow rays, in one function so
// that a shader holds it once. Twin: src/bvh/mod.rs, `Bvh::closest_hit`.
//
// The walk goes in two loops, down to a leaf and through its triangles, and looks at alpha outside both: a driver that runs
// lanes side by side runs what any of them needs for all. With RAYS_QUERY the driver walks a structure of its own
// (bvh_query.glsl). The including shader has the axis ALPHA and what bvh_stack.glsl, bvh_nodes.glsl, bvh_moving.glsl and, with
// ALPHA=tested, shading/traced.glsl need.
//
// Among triangles at one distance the first in the tree's order is hit, so that the answer does not depend on the order
// in which the tree is walked. A box around another is entered wherever the inner one is, in floats too (each step of
// the test is monotonic), so every order reaches the same leaves before the limit, and any hit is the same hit for all.
// The nearest could still differ where two distances are within what rounding makes of a distance to a box: there a
// leaf may count as behind a triangle that is behind one of its own.
#ifndef BVH_TRACE_GLSL
#define BVH_TRACE_GLSL

#include "bvh_moving.glsl"
#include "bvh_tests.glsl"
#include "loops.glsl"
#include "sampling/sobol.glsl"

// Any hit will do.
const uint RAY_SHADOW = 1u;
// As pictures are drawn: backs of single-sided surfaces are not there.
const uint RAY_CAMERA = 2u;
// BLEND surfaces are not there.
const uint RAY_SOLID = 4u;

struct TraceHit {
    bool is_hit;
    // In lengths of the direction.
    float distance;
    uint triangle;
    vec2 barycentric;
};

// Whether the side that a ray meets is drawn.
bool is_drawn(BvhTriangleBlock plane, vec3 direction) {
    uint flags = floatBitsToUint(plane.corner.w);
    vec3 facing = cross(plane.edge1.xyz, plane.edge2.xyz);
    bool is_front = (dot(facing, direction) < 0.0) != ((flags & TRIANGLE_MIRRORED) != 0u);
    return is_front || (flags & TRIANGLE_SINGLE_SIDED) == 0u;
}

#ifdef ALPHA_TESTED
// Whether a ray stops at a triangle that alpha decides about. BLEND surfaces stop as many rays as their alpha says.
bool stops(uint triangle, vec2 barycentric, uint kind, uint seed) {
    float coverage = coverage_at(triangle, barycentric);
    if ((kind & RAY_SOLID) != 0u) {
        return coverage > 0.0 && traced_materials[floatBitsToUint(surfaces[triangle].v_material.w)].alpha != ALPHA_IS_BLEND;
    }
    return unit_of(mixed(seed ^ mixed(triangle + 1u))) < coverage;
}
#endif

// Both trace a ray the same way to the caller.
#ifdef RAYS_QUERY
#include "bvh_query.glsl"
#else
#include "bvh_stack.glsl"

// `kind`: RAY_ bits; a `limit` of 0 or less meets nothing. `seed`: of this ray's decisions about BLEND surfaces.
TraceHit trace(vec3 origin, vec3 direction, float limit, uint kind, uint seed) {
    TraceHit hit = TraceHit(false, limit, 0u, vec2(0.0));
    vec3 inverse = 1.0 / mix(direction, vec3(1e-20), equal(direction, vec3(0.0)));
    // A leaf's triangles that are still to be tried, and the node to visit next.
    uint triangle = 0u;
    uint end = 0u;
    uint node = ROOT;
    bool has_node = enters_root(origin, inverse, limit);
    stack_clear();
    while (has_node || triangle < end) {
        while (has_node && triangle >= end) {
            uvec2 leaf = leaf_at(node);
            Entered entered = NONE_ENTERED;
            if (leaf.y == 0u) {
                entered = entered_below(leaf.x, origin, inverse, hit.distance);
            } else {
                triangle = leaf.x;
                end = leaf.x + leaf.y;
            }
            has_node = walk_on(entered, node);
        }
#ifdef ALPHA_TESTED
        bool is_asked = false;
        vec3 asked;
#endif
        while (triangle < end) {
            BvhTriangleBlock plane = triangle_at(triangle);
            vec3 met;
            float behind = uintBitsToFloat(floatBitsToUint(hit.distance) + 1u);
            bool is_met = triangle_hit(plane, origin, direction, behind, met)
                && (met.x < hit.distance || triangle < hit.triangle);
            if ((kind & RAY_CAMERA) != 0u) {
                is_met = is_met && is_drawn(plane, direction);
            }
#ifdef ALPHA_TESTED
            if (is_met && (floatBitsToUint(plane.corner.w) & TRIANGLE_TESTED) != 0u) {
                is_asked = true;
                asked = met;
                break;
            }
#endif
            if (is_met) {
                hit = TraceHit(true, met.x, triangle, met.yz);
            }
            triangle++;
        }
#ifdef ALPHA_TESTED
        if (is_asked) {
            if (stops(triangle, asked.yz, kind, seed)) {
                hit = TraceHit(true, asked.x, triangle, asked.yz);
            }
            triangle++;
        }
#endif
        if ((kind & RAY_SHADOW) != 0u && hit.is_hit) {
            return hit;
        }
    }
    expect_done(!has_node && triangle >= end);
    return hit;
}
#endif

#endif
