// A ray through the whole tree that asks alpha where a triangle says so: nearest hits and shadow rays, in one function so
// that a shader holds it once. Twin: src/bvh.rs, `Bvh::closest_hit`.
//
// The walk goes in two loops, down to a leaf and through its triangles, and looks at alpha outside both: a driver that runs
// lanes side by side runs what any of them needs for all. With RAYS_QUERY the driver walks a structure of its own
// (bvh_query.glsl). The including shader has the axis ALPHA and what bvh_walk.glsl,
// bvh_moving.glsl and, with ALPHA=tested, shading/traced.glsl want.
#ifndef BVH_TRACE_GLSL
#define BVH_TRACE_GLSL

#include "bvh_moving.glsl"
#include "bvh_walk.glsl"
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

// `kind`: RAY_ bits; a `limit` of 0 or less meets nothing. `seed`: of this ray's decisions about BLEND surfaces.
#ifdef RAYS_QUERY
#include "bvh_query.glsl"
#else
TraceHit trace(vec3 origin, vec3 direction, float limit, uint kind, uint seed) {
    TraceHit hit = TraceHit(false, limit, 0u, vec2(0.0));
    vec3 inverse = 1.0 / mix(direction, vec3(1e-20), equal(direction, vec3(0.0)));
    uint stack[BVH_STACK];
    int depth = 0;
    // A leaf's triangles that are still to be tried, and the node whose turn it is.
    uint triangle = 0u;
    uint end = 0u;
    uint node_index = 0u;
    bool has_node = limit > 0.0 && box_entry(bvh_nodes[0], origin, inverse, limit) >= 0.0;
    while (has_node || triangle < end) {
        while (has_node && triangle >= end) {
            BvhNodeBlock node = bvh_nodes[node_index];
            uint count = floatBitsToUint(node.min_count.w);
            uint first = floatBitsToUint(node.max_first.w);
            float left = -1.0;
            float right = -1.0;
            if (count == 0u) {
                left = box_entry(bvh_nodes[first], origin, inverse, hit.distance);
                right = box_entry(bvh_nodes[first + 1u], origin, inverse, hit.distance);
            } else {
                triangle = first;
                end = first + count;
            }
            bool is_left_first = right < 0.0 || (left >= 0.0 && left <= right);
            if (left >= 0.0 && right >= 0.0 && depth < BVH_STACK) {
                stack[depth++] = is_left_first ? first + 1u : first;
            }
            if (left >= 0.0 || right >= 0.0) {
                node_index = is_left_first ? first : first + 1u;
            } else {
                has_node = depth > 0;
                depth = max(depth - 1, 0);
                node_index = has_node ? stack[depth] : 0u;
            }
        }
#ifdef ALPHA_TESTED
        bool is_asked = false;
        vec3 asked;
#endif
        while (triangle < end) {
            BvhTriangleBlock plane = triangle_at(triangle);
            vec3 met;
            bool is_met = triangle_hit(plane, origin, direction, hit.distance, met);
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
