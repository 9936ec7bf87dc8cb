// The rays of bvh_trace.glsl through the driver's own acceleration structure, by ray query: primitives of the structure
// are the triangles of the tree, in the tree's order (src/resident/structure.rs).
//
// Alpha and backs are asked about here, of each candidate that the driver finds. Where a ray meets a triangle is said by
// the tree's arithmetic, so that what follows from a hit is the same to the bit. What the driver decides otherwise are rays
// that graze an edge, and which of two triangles at one distance comes first.
#ifndef BVH_QUERY_GLSL
#define BVH_QUERY_GLSL

// Distance and weights of the second and the third corner; the driver's where by the tree's arithmetic a ray that grazes the
// triangle misses it.
vec3 met_at(BvhTriangleBlock plane, vec3 origin, vec3 direction, float limit, vec3 by_driver) {
    vec3 met;
    return triangle_hit(plane, origin, direction, limit, met) ? met : by_driver;
}

TraceHit trace(vec3 origin, vec3 direction, float limit, uint kind, uint seed) {
    TraceHit hit = TraceHit(false, limit, 0u, vec2(0.0));
    if (!(limit > 0.0)) {
        return hit;
    }
    uint flags = (kind & RAY_SHADOW) != 0u ? gl_RayFlagsTerminateOnFirstHitEXT : gl_RayFlagsNoneEXT;
    // Backs and fronts can be distinguished only for the triangle that is asked about.
    flags |= (kind & RAY_CAMERA) != 0u ? gl_RayFlagsNoOpaqueEXT : gl_RayFlagsNoneEXT;
    rayQueryEXT query;
    rayQueryInitializeEXT(query, structure, flags, 0xffu, origin, 0.0, direction, limit);
    bool goes_on = true;
    while (goes_on) {
        goes_on = rayQueryProceedEXT(query);
        if (goes_on) {
            uint triangle = uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, false));
            BvhTriangleBlock plane = triangle_at(triangle);
            bool is_met = (kind & RAY_CAMERA) == 0u || is_drawn(plane, direction);
#ifdef ALPHA_TESTED
            if (is_met && (floatBitsToUint(plane.corner.w) & TRIANGLE_TESTED) != 0u) {
                vec2 weights = rayQueryGetIntersectionBarycentricsEXT(query, false);
                vec3 met = met_at(plane, origin, direction, limit, vec3(limit, weights));
                is_met = stops(triangle, met.yz, kind, seed);
            }
#endif
            if (is_met) {
                rayQueryConfirmIntersectionEXT(query);
            }
        }
    }
    expect_done(!goes_on);
    if (rayQueryGetIntersectionTypeEXT(query, true) == gl_RayQueryCommittedIntersectionTriangleEXT) {
        uint triangle = uint(rayQueryGetIntersectionPrimitiveIndexEXT(query, true));
        float distance = rayQueryGetIntersectionTEXT(query, true);
        vec2 weights = rayQueryGetIntersectionBarycentricsEXT(query, true);
        vec3 met = met_at(triangle_at(triangle), origin, direction, limit, vec3(distance, weights));
        hit = TraceHit(true, met.x, triangle, met.yz);
    }
    return hit;
}

#endif
