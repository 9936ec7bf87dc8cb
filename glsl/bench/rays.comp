// Rays through the whole tree and nothing else: what `bench rays` times. Pass: src/bench/rays/mod.rs.
//
// WALK: plain, the walk of shadow rays (bvh_walk.glsl), which has no order and knows any hit only; two and four, that of path
// tracing (bvh_trace.glsl), nearer child first, over nodes with as many children; query, the driver's, through a structure of
// its own.
// variants: WALK=plain|two|four|query
#version 460
#ifdef WALK_FOUR
#define NODES_FOUR
#endif
#ifdef WALK_QUERY
#extension GL_EXT_ray_query : require
#define RAYS_QUERY
#endif
#include "bvh.glsl"

struct RayBlock {
    // xyz: metres; w: how far it reaches, in lengths of its direction.
    vec4 origin_limit;
    vec4 direction;
};

struct RaysParams {
    uint ray_count;
    // RAY_ bits of bvh_trace.glsl, for every walk but the plain one.
    uint kind;
};

const uint THREADS = 64u;
layout(local_size_x = THREADS) in;

layout(push_constant) uniform Push { RaysParams params; };
#ifdef WALK_QUERY
layout(set = 0, binding = 4) uniform accelerationStructureEXT structure;
#else
layout(std430, set = 0, binding = 0) readonly buffer BvhNodes { BVH_NODE bvh_nodes[]; };
#endif
layout(std430, set = 0, binding = 1) readonly buffer BvhTriangles { BvhTriangleBlock bvh_triangles[]; };
layout(std430, set = 0, binding = 2) readonly buffer Rays { RayBlock rays[]; };
// 0: nothing was met; else 1 for any hit, and for the nearest its triangle and 1.
layout(std430, set = 0, binding = 3) writeonly buffer Hits { uint hits[]; };

#ifdef WALK_PLAIN
#include "bvh_walk.glsl"
#else
// Nothing moves here: a triangle is where it is when the shutter closes, too.
#define bvh_closing bvh_triangles
#include "bvh_trace.glsl"
#endif

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= params.ray_count) {
        return;
    }
    RayBlock ray = rays[index];
    vec3 origin = ray.origin_limit.xyz;
    vec3 direction = ray.direction.xyz;
#ifdef WALK_PLAIN
    // RAY_OFFSET is 0 here: the ray begins and ends where it says.
    hits[index] = occluded(origin, vec3(0.0), direction, ray.origin_limit.w) ? 1u : 0u;
#else
    TraceHit hit = trace(origin, direction, ray.origin_limit.w, params.kind, 0u);
    uint found = (params.kind & RAY_SHADOW) != 0u ? 1u : hit.triangle + 1u;
    hits[index] = hit.is_hit ? found : 0u;
#endif
}
