// All that a pixel touches of a triangle, as a convex polygon: the triangle, cut off at the near plane, and a square around
// each of its points (section 4.4; Hasselgren et al. 2005 make the same in a geometry shader).
//
// A square adds as many corners as it has: three and four are seven, and a triangle that the near plane has cut has eight.
//
// The including shader has `deep` (DeepBlock).
#ifndef DEEP_SHADING_HULL_GLSL
#define DEEP_SHADING_HULL_GLSL

#include "techniques/deep_shading/snap.glsl"

const uint HULL_CORNERS = 8u;
// Floats place what is far outside by as much of it less well.
const float HULL_REACH_PART = 1.0 / 1048576.0;
// What is farther out than this many sides of shading space is not placed well enough: the hull is all of it, and what is too
// much falls out at the look-up.
const float HULL_FARTHEST = 256.0;

struct Hull {
    // Pixels, in order; `count` of them, at least 3, or 0 where all is behind the near plane.
    vec2 corners[HULL_CORNERS];
    uint count;
};

// From a pixel's middle to its rim.
float reach_px() {
    return 0.5 + snap_px();
}

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

// In even shading space, or in one sector of it that is warped. `a`, `b`, `c`: xy homogeneous pixels, z depth (reversed), w.
Hull even_hull_of(vec4 a, vec4 b, vec4 c) {
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
    vec2 space = 2.0 * even_half_px(deep) + 1.0;
    if (!(max(far.x, far.y) < HULL_FARTHEST * max(space.x, space.y))) {
        return box_of(vec2(-1.0), space + 1.0);
    }
    float reach = reach_px() + HULL_REACH_PART * max(far.x, far.y);
    vec2 size = greatest - least;
    float longest = max(size.x, size.y);
    // Of corners that are rounded to 2^-24 of their places, and of products.
    float rounding = longest * (1e-3 + 3e-7 * max(far.x, far.y) + 6e-7 * longest);
    // Thinner than what floats tell apart: the box around it holds it too, and what is too much falls out at the look-up.
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

// The sector between the diagonals that a point before the eye lies in, from the middle of shading space on: where x is greater
// than y or not, and the sign of that one.
uvec2 sector_of(vec2 from_middle) {
    bool is_wide = abs(from_middle.x) > abs(from_middle.y);
    return uvec2(is_wide, (is_wide ? from_middle.x : from_middle.y) < 0.0);
}

// Places that lie in `least` to `greatest`, warped, lie in this box: towards the middle they move the more the farther out
// they are on the other axis.
Hull warped_box_of(vec2 least, vec2 greatest) {
    vec2 half_px = even_half_px(deep);
    vec2 low = (least - half_px) / half_px;
    vec2 high = (greatest - half_px) / half_px;
    vec2 nearest = max(vec2(0.0), max(low, -high));
    vec2 farthest = max(abs(low), abs(high));
    float falloff = deep.warp_falloff;
    vec2 low_other = vec2(low.x < 0.0 ? nearest.y : farthest.y, low.y < 0.0 ? nearest.x : farthest.x);
    vec2 high_other = vec2(high.x > 0.0 ? nearest.y : farthest.y, high.y > 0.0 ? nearest.x : farthest.x);
    vec2 from = low * (1.0 + falloff) / (1.0 + falloff * max(abs(low), low_other));
    vec2 to = high * (1.0 + falloff) / (1.0 + falloff * max(abs(high), high_other));
    vec2 warped_half_px = 0.5 * vec2(deep.shading_width_px, deep.shading_height_px);
    return box_of(warped_half_px * (1.0 + from) - reach_px(), warped_half_px * (1.0 + to) + reach_px());
}

// In shading space. Corners as above, in even shading space.
Hull hull_of(vec4 a, vec4 b, vec4 c) {
    if (deep.warp_falloff == 0.0) {
        return even_hull_of(a, b, c);
    }
    vec2 half_px = even_half_px(deep);
    vec2 warped_half_px = 0.5 * vec2(deep.shading_width_px, deep.shading_height_px);
    vec4 given[3] = vec4[3](a, b, c);
    bool has_sector = true;
    uvec2 sector = sector_of(a.xy / (a.w * half_px) - 1.0);
    for (uint index = 0u; index < 3u; index++) {
        vec4 corner = given[index];
        vec2 from_middle = corner.xy / half_px - corner.w;
        has_sector = has_sector && corner.w > 0.0 && sector_of(from_middle / corner.w) == sector;
        float far = sector.x == 1u ? abs(from_middle.x) : abs(from_middle.y);
        float w = (corner.w + deep.warp_falloff * far) / (1.0 + deep.warp_falloff);
        // What is before the near plane stays so.
        given[index] = vec4(warped_half_px * (from_middle + w), corner.z + w - corner.w, w);
    }
    if (has_sector) {
        return even_hull_of(given[0], given[1], given[2]);
    }
    Hull whole = even_hull_of(a, b, c);
    vec2 least = whole.corners[0];
    vec2 greatest = whole.corners[0];
    for (uint index = 1u; index < whole.count; index++) {
        least = min(least, whole.corners[index]);
        greatest = max(greatest, whole.corners[index]);
    }
    if (whole.count == 0u) {
        return whole;
    }
    return warped_box_of(least, greatest);
}

// A strip's order of a convex polygon's corners: 0, 1, last, 2, last but one and so on.
uint strip_corner(uint place, uint count) {
    if (place == 0u) {
        return 0u;
    }
    return place % 2u == 1u ? (place + 1u) / 2u : count - place / 2u;
}

#endif
