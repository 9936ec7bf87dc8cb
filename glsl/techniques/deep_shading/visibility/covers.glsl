// The sample-in-triangle test of stochastic rasterisation (section 4.2): by homogeneous areas, so that a triangle may reach
// behind the eye. After place.glsl.
#ifndef DEEP_SHADING_COVERS_GLSL
#define DEEP_SHADING_COVERS_GLSL

// Depth and w, one through the other is depth, of a place with these weights.
vec2 covered_depth(vec4 a, vec4 b, vec4 c, vec3 weights) {
    precise vec2 depth = weights.x * a.zw + weights.y * b.zw + weights.z * c.zw;
    return depth;
}

// A corner's homogeneous pixels from `at` on.
vec2 from_sample(vec4 corner, vec2 at) {
    precise vec2 from = corner.xy - corner.w * at;
    return from;
}

// Whether areas are those of a sample in the triangle, from either side. Neighbours compute the areas at their edge from the same
// corners, which differ by the sign alone: no sample falls between them, and one on the edge itself is in both.
bool is_inside(vec3 areas) {
    return all(greaterThanEqual(areas, vec3(0.0))) || all(lessThanEqual(areas, vec3(0.0)));
}

// What corners have at a place between them: weights of sum 1, as place_at would have them, which looks for the nearest place
// besides. Numbers only where the triangle is not edge-on.
vec3 covered_weights(vec3 areas) {
    precise float area = areas.x + areas.y + areas.z;
    precise vec3 parts = areas / area;
    return parts;
}

// Whether what has this depth and w lies between the near plane and the far one.
bool is_between_planes(vec2 depth) {
    return depth.y > 0.0 && depth.x >= 0.0 && depth.x <= depth.y;
}

#endif
