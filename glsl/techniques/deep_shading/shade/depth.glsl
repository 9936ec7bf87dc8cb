// How far back what is drawn into shading space may lie, where zmax is its depth buffer (section 4.4): never behind a sample
// that saw it.
//
// The including shader has `deep` (DeepBlock). Corners are as `hull_around` takes them.
#ifndef DEEP_SHADING_SHADE_DEPTH_GLSL
#define DEEP_SHADING_SHADE_DEPTH_GLSL

#include "techniques/deep_shading/snap.glsl"

// Depth, reversed, over shading space: all of one number, or a plane.
struct Depths {
    // A pixel.
    vec2 slope;
    float at_origin;
};

// Margins, as parts of a depth and of what a triangle spans: samples' depths are interpolated. A plane holds them whatever their
// weights are, the nearest corner only as far as weights are exact.
const float DEPTH_MARGIN = 1e-3;
const float PLANE_MARGIN_OF_SPAN = 0.01;
const float CORNER_MARGIN_OF_SPAN = 0.05;

// What is thinner than a pixel spans no more than its slope over one, which floats find badly.
const float THIN_PX = 1.0;
// Corners farther out than this are rounded to more than a thousandth of a pixel.
const float PLANE_FARTHEST_PX = 8192.0;

// From a pixel's middle to its rim.
float reach_px() {
    return 0.5 + snap_px();
}

float depth_at(Depths depths, vec2 place_px) {
    return max(dot(depths.slope, place_px) + depths.at_origin, 0.0);
}

// At the near plane where a corner lies before it.
Depths nearest_depths(vec4 a, vec4 b, vec4 c) {
    vec3 z = vec3(a.z, b.z, c.z);
    vec3 w = vec3(a.w, b.w, c.w);
    if (any(lessThanEqual(w, vec3(0.0))) || any(greaterThanEqual(z, w))) {
        return Depths(vec2(0.0), 1.0);
    }
    vec3 depths = z / w;
    float nearest = max(depths.x, max(depths.y, depths.z));
    float span = nearest - min(depths.x, min(depths.y, depths.z));
    return Depths(vec2(0.0), min((1.0 + DEPTH_MARGIN) * nearest + CORNER_MARGIN_OF_SPAN * span, 1.0));
}

// In the triangle's plane, nearer by what it rises from the middle of a pixel to its rim; no corner lies before the near plane.
// Before that plane where floats do not find it.
Depths plane_depths(vec4 a, vec4 b, vec4 c) {
    vec3 first = a.xyz / a.w;
    vec3 second = b.xyz / b.w - first;
    vec3 third = c.xyz / c.w - first;
    vec2 opposite = third.xy - second.xy;
    float area = second.x * third.y - second.y * third.x;
    float longest = sqrt(max(dot(opposite, opposite), max(dot(second.xy, second.xy), dot(third.xy, third.xy))));
    float farthest = max(abs(first.x), abs(first.y)) + longest;
    if (!(abs(area) >= THIN_PX * longest) || !(farthest <= PLANE_FARTHEST_PX)) {
        return Depths(vec2(0.0), 2.0);
    }
    vec2 slope = vec2(second.z * third.y - third.z * second.y, third.z * second.x - second.z * third.x) / area;
    float nearest = first.z + max(0.0, max(second.z, third.z));
    float span = nearest - (first.z + min(0.0, min(second.z, third.z)));
    float margin = DEPTH_MARGIN * nearest + PLANE_MARGIN_OF_SPAN * span;
    float rise = reach_px() * (abs(slope.x) + abs(slope.y));
    return Depths(slope, first.z - dot(slope, first.xy) + rise + margin);
}

#endif
