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

// Whether the sample at `at` (pixels) sees the triangle, from either side, between the near plane and the far one. Corners: xy
// homogeneous pixels, z depth, w. Neighbours compute the areas at their edge from the same corners, which differ by the sign
// alone: no sample falls between them, and one on the edge itself is in both. Where it does, `weights` are the corners' and as
// place_at would have them, which looks for the nearest place besides; `is_front`: counter-clockwise.
bool covers(vec4 a, vec4 b, vec4 c, vec2 at, out vec3 weights, out bool is_front) {
    vec3 areas = areas_of(from_sample(a, at), from_sample(b, at), from_sample(c, at));
    precise float area = areas.x + areas.y + areas.z;
    precise vec3 parts = areas / area;
    weights = parts;
    is_front = area < 0.0;
    bool is_inside = all(greaterThanEqual(areas, vec3(0.0))) || all(lessThanEqual(areas, vec3(0.0)));
    vec2 depth = covered_depth(a, b, c, parts);
    return is_inside && area != 0.0 && depth.y > 0.0 && depth.x >= 0.0 && depth.x <= depth.y;
}

#endif
