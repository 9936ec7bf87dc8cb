// All that a square touches of a triangle that goes along it, as a convex polygon: the triangle, cut off at the near plane, and a
// square around each of its points (section 4.4; Hasselgren et al. 2005 make the same in a geometry shader).
//
// A square adds as many corners as it has: three and four are seven, and a triangle that the near plane has cut has eight.
#ifndef DEEP_SHADING_HULL_GLSL
#define DEEP_SHADING_HULL_GLSL

#include "techniques/deep_shading/snap.glsl"

const uint HULL_CORNERS = 8u;
// Vertices of a fan: six triangles are an octagon.
const uint HULL_VERTICES = 18u;
// Floats place what is far outside by as much of it less well.
const float HULL_REACH_PART = 1.0 / 1048576.0;
// What is farther out than this many sides of what is drawn into is not placed well enough: the hull is all of it, and what is
// too much falls out at the look-up.
const float HULL_FARTHEST = 256.0;

struct Hull {
    // Pixels, in order; `count` of them, at least 3, or 0 where all is behind the near plane.
    vec2 corners[HULL_CORNERS];
    uint count;
};

vec2 signs(vec2 of) {
    return vec2(of.x < 0.0 ? -1.0 : 1.0, of.y < 0.0 ? -1.0 : 1.0);
}

// Points in one place are one: an edge without a length would have no side. Returns how many there are then.
uint added(inout vec2 points[4], uint count, vec4 point) {
    vec2 at = point.xy / point.w;
    if (count == 4u || (count > 0u && points[count - 1u] == at)) {
        return count;
    }
    points[count] = at;
    return count + 1u;
}

Hull box_of(vec2 least, vec2 greatest) {
    Hull hull;
    hull.corners[0] = least;
    hull.corners[1] = vec2(greatest.x, least.y);
    hull.corners[2] = greatest;
    hull.corners[3] = vec2(least.x, greatest.y);
    hull.count = 4u;
    return hull;
}

// `a`, `b`, `c`: xy homogeneous pixels, z depth (reversed), w. `reach`: half of the square's side, pixels; `extent`: what is drawn
// into, pixels.
Hull hull_around(vec4 a, vec4 b, vec4 c, float reach, vec2 extent) {
    vec4 given[3] = vec4[3](a, b, c);
    vec2 cut[4];
    uint cut_count = 0u;
    for (uint index = 0u; index < 3u; index++) {
        vec4 here = given[index];
        vec4 next = given[(index + 1u) % 3u];
        float depth = here.w - here.z;
        float next_depth = next.w - next.z;
        if (depth >= 0.0 && here.w > 0.0) {
            cut_count = added(cut, cut_count, here);
        }
        if ((depth < 0.0) != (next_depth < 0.0)) {
            vec4 crossing = mix(here, next, depth / (depth - next_depth));
            if (crossing.w > 0.0) {
                cut_count = added(cut, cut_count, crossing);
            }
        }
    }
    if (cut_count > 1u && cut[cut_count - 1u] == cut[0]) {
        cut_count--;
    }
    Hull hull;
    hull.count = 0u;
    if (cut_count == 0u) {
        return hull;
    }
    vec2 least = cut[0];
    vec2 greatest = cut[0];
    float area = 0.0;
    for (uint index = 0u; index < cut_count; index++) {
        vec2 here = cut[index];
        vec2 next = cut[(index + 1u) % cut_count];
        least = min(least, here);
        greatest = max(greatest, here);
        vec2 from = here - cut[0];
        vec2 to = next - cut[0];
        area += from.x * to.y - from.y * to.x;
    }
    vec2 far = max(abs(least), abs(greatest));
    if (!(max(far.x, far.y) < HULL_FARTHEST * max(extent.x, extent.y))) {
        return box_of(vec2(-1.0), extent + 1.0);
    }
    reach += HULL_REACH_PART * max(far.x, far.y);
    vec2 size = greatest - least;
    float longest = max(size.x, size.y);
    // Error of corners that are rounded to 2^-24 of their places, and of products.
    float rounding = longest * (1e-3 + 3e-7 * max(far.x, far.y) + 6e-7 * longest);
    // Thinner than floats can resolve: the box around it holds it too, and the look-up drops what is too much.
    if (cut_count < 3u || abs(area) <= rounding) {
        return box_of(least - reach, greatest + reach);
    }
    float turn = area < 0.0 ? -1.0 : 1.0;
    vec2 before = cut[0] - cut[cut_count - 1u];
    for (uint index = 0u; index < cut_count; index++) {
        vec2 after = cut[(index + 1u) % cut_count] - cut[index];
        // The square's corners that lie farthest out along the edges that meet here.
        vec2 first = signs(turn * vec2(before.y, -before.x));
        vec2 last = signs(turn * vec2(after.y, -after.x));
        hull.corners[hull.count] = cut[index] + reach * first;
        hull.count++;
        if (first != last && hull.count < HULL_CORNERS) {
            if (first == -last) {
                // Two corners on: the one between them, in the sense of the polygon.
                hull.corners[hull.count] = cut[index] + reach * turn * vec2(-first.y, first.x);
                hull.count = min(hull.count + 1u, HULL_CORNERS - 1u);
            }
            hull.corners[hull.count] = cut[index] + reach * last;
            hull.count++;
        }
        before = after;
    }
    return hull;
}

// A strip's order of a convex polygon's corners: 0, 1, last, 2, last but one and so on.
uint strip_corner(uint place, uint count) {
    if (place == 0u) {
        return 0u;
    }
    return place % 2u == 1u ? (place + 1u) / 2u : count - place / 2u;
}

// The corner of a vertex of the fan, of `HULL_VERTICES`; what the fan has too many of is of one point.
vec2 fan_corner(Hull hull, uint vertex) {
    uint place = vertex % 3u == 0u ? 0u : vertex / 3u + vertex % 3u;
    return hull.corners[min(place, hull.count - 1u)];
}

#endif
