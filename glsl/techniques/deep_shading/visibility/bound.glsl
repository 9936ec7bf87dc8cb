// A convex polygon around all that a triangle covers of a layer while the shutter is open, from all of the lens (section 4.2;
// McGuire et al. 2010).
//
// A corner that moves on a straight line before the eye is seen on a straight line too, from each place on the lens: the six
// ellipses, in which the lens shows the corners at both ends of the exposure, have all of the triangle in their hull. The
// polygon's sides touch that hull. They lie along the triangle's edges at both ends, along its way, and along the screen: of a
// sharp triangle the polygon is that triangle. No side needs to know the others, which a walk around the hull would. Around
// what is small, and around what of a triangle lies before the near plane, the polygon is an upright rectangle.
//
// Where a pixel has its samples anywhere, `around_px` is how far they lie from its middle on each axis: the polygon has the middles
// of all pixels in it that may have a sample in the triangle.
#ifndef DEEP_SHADING_BOUND_GLSL
#define DEEP_SHADING_BOUND_GLSL

#include "techniques/deep_shading/snap.glsl"

// Sides of the screen, of the triangle's edges at both ends, and of its path.
const uint BOUND_MOST_SIDES = 12u;
// Without motion the triangle has one place and no way.
const uint BOUND_STILL_SIDES = 7u;
// Floats place what is far outside by as much of it less well.
const float BOUND_REACH_PART = 1.0 / 1048576.0;
// What is farther out than this many sides of a layer is not placed well enough: what a rectangle has of the layer is tested.
const float BOUND_FARTHEST = 256.0;
// Area up to which a rectangle does: on lavapipe what a side takes is as long as some hundred tests (with
// `--sample-tests layers` 512 would save 5 to 10 % more; in a loop 256 takes up to 8 % more, 16 up to 14).
const float BOUND_UPRIGHT_PX2 = 64.0;
// The sine of the least angle between sides: where two meet at less, their corner would be lost in rounding.
const float BOUND_LEAST_TURN = 0.01;

// Where all of the eye's lens sees a corner at one end of the exposure, pixels.
struct Spot {
    vec2 middle;
    vec2 radii;
};

struct Bound {
    // Pixels of the layer, counter-clockwise as y goes up.
    vec2 corners[BOUND_MOST_SIDES];
    // At least 3, or 0 where the layer has nothing of the triangle.
    uint count;
};

Spot spot_of(Seen seen, TupleBlock tuple, vec2 half_layer) {
    vec2 at = seen.clip.xy / seen.clip.w;
    vec2 radii = vec2(0.0);
    if (HAS_LENS != 0u) {
        vec2 reach = deep.lens * lens_part(seen.depth) / seen.clip.w;
        at.x += reach.x * tuple.eye;
        radii = abs(reach) * (1.0 - abs(tuple.eye));
    }
    return Spot(half_layer * (at * tuple.scale + tuple.shift + 1.0), half_layer * tuple.scale * radii);
}

// A side's direction, out of what it bounds: along `edge`, away from `inside`.
vec2 side_along(vec2 edge, vec2 inside) {
    vec2 outward = vec2(edge.y, -edge.x);
    float size = length(outward);
    if (!(size > 0.0)) {
        return vec2(1.0, 0.0);
    }
    return (dot(outward, inside) > 0.0 ? -outward : outward) / size;
}

// Grows with a direction's angle, from 0 to 4.
float turn_of(vec2 direction) {
    float part = direction.x / (abs(direction.x) + abs(direction.y));
    return direction.y < 0.0 ? 3.0 + part : 1.0 - part;
}

bool is_apart(vec2 from, vec2 to) {
    return dot(from, to) <= 0.0 || abs(from.x * to.y - from.y * to.x) > BOUND_LEAST_TURN;
}

// How far beyond the near plane a corner lies, in clip space: reversed depth, in which it is linear. The lens moves neither
// depth nor w.
float beyond_near(Seen seen) {
    return seen.clip.w - seen.clip.z;
}

// An upright rectangle, pixels.
struct Extent {
    vec2 least;
    vec2 greatest;
};

Extent widened_by(Extent extent, Spot spot, vec2 reach) {
    return Extent(
        min(extent.least, spot.middle - spot.radii - reach), max(extent.greatest, spot.middle + spot.radii + reach));
}

// Extent of the part before the near plane: that part of the hull of both ends of the exposure lies between the corners
// that are seen and the places where lines from those to the others cross the plane. Only where `is_wanted`, by which
// the loop ends, because some drivers run both sides of every branch.
Extent cut_extent(Seen seen[6], TupleBlock tuple, vec2 layer, float around_px, bool is_wanted) {
    Extent extent = Extent(vec2(3.0e38), vec2(-3.0e38));
    for (uint pair = 0u; pair < 36u && is_wanted; pair++) {
        Seen from = seen[pair / 6u];
        Seen to = seen[pair % 6u];
        bool is_corner = pair / 6u == pair % 6u;
        float inside = beyond_near(from);
        float outside = beyond_near(to);
        if (inside >= 0.0 && (is_corner || outside < 0.0)) {
            float part = is_corner ? 0.0 : inside / (inside - outside);
            Spot spot = spot_of(Seen(mix(from.clip, to.clip, part), mix(from.depth, to.depth, part)), tuple, 0.5 * layer);
            // A place between two far corners is near the eye, and rounded as they are.
            vec4 largest = max(abs(from.clip), abs(to.clip));
            float rounding = BOUND_REACH_PART;
            if (!is_corner) {
                rounding *= 1.0 + max(max(largest.x, largest.y), largest.w) / mix(from.clip.w, to.clip.w, part);
            }
            vec2 reach = snap_px() + around_px + rounding * (abs(spot.middle) + spot.radii + layer);
            extent = widened_by(extent, spot, reach);
        }
    }
    return extent;
}

// What the layer has of it.
Bound upright(Extent extent, vec2 layer) {
    vec2 least = max(extent.least, vec2(-1.0));
    vec2 greatest = min(extent.greatest, layer + 1.0);
    Bound bound;
    bound.corners[0] = least;
    bound.corners[1] = vec2(greatest.x, least.y);
    bound.corners[2] = greatest;
    bound.corners[3] = vec2(least.x, greatest.y);
    bound.count = all(lessThan(least, greatest)) ? 4u : 0u;
    return bound;
}

// `seen`: three corners when the shutter opens, and the same when it closes.
Bound bound_of(Seen seen[6], TupleBlock tuple, vec2 layer, float around_px) {
    Spot spots[6];
    vec2 middle = vec2(0.0);
    float farthest = 0.0;
    bool is_placed = true;
    for (uint index = 0u; index < 6u; index++) {
        spots[index] = spot_of(seen[index], tuple, 0.5 * layer);
        middle += spots[index].middle / 6.0;
        vec2 far = abs(spots[index].middle) + spots[index].radii;
        farthest = max(farthest, max(far.x, far.y));
        is_placed = is_placed && seen[index].clip.w > 0.0 && beyond_near(seen[index]) >= 0.0;
    }
    is_placed = is_placed && farthest < BOUND_FARTHEST * max(layer.x, layer.y);
    float reach = snap_px() + BOUND_REACH_PART * farthest;
    Extent extent = cut_extent(seen, tuple, layer, around_px, !is_placed);
    for (uint index = 0u; index < 6u && is_placed; index++) {
        extent = widened_by(extent, spots[index], vec2(reach + around_px));
    }
    Bound rectangle = upright(extent, layer);
    vec2 size = extent.greatest - extent.least;
    bool is_upright = !is_placed || rectangle.count == 0u || size.x * size.y <= BOUND_UPRIGHT_PX2;
    vec2 sides[BOUND_MOST_SIDES];
    sides[0] = vec2(1.0, 0.0);
    sides[1] = vec2(0.0, 1.0);
    sides[2] = vec2(-1.0, 0.0);
    sides[3] = vec2(0.0, -1.0);
    uint side_count = 4u;
    for (uint end = 0u; end <= IS_MOVING; end++) {
        for (uint edge = 0u; edge < 3u; edge++) {
            vec2 from = spots[3u * end + edge].middle;
            vec2 to = spots[3u * end + (edge + 1u) % 3u].middle;
            sides[side_count] = side_along(to - from, spots[3u * end + (edge + 2u) % 3u].middle - from);
            side_count++;
        }
    }
    if (IS_MOVING != 0u) {
        vec2 way = spots[3].middle + spots[4].middle + spots[5].middle - 3.0 * middle;
        vec2 across = side_along(way, vec2(0.0));
        sides[side_count] = across;
        sides[side_count + 1u] = -across;
        side_count += 2u;
    }
    // Loops end at once.
    side_count = is_upright ? 0u : side_count;
    // By shifting: where two places changed contents, Mesa 22.3.6's lavapipe could read what was kept after it was overwritten.
    for (uint last = 1u; last < side_count; last++) {
        vec2 side = sides[last];
        float turn = turn_of(side);
        uint at = last;
        while (at > 0u && turn < turn_of(sides[at - 1u])) {
            sides[at] = sides[at - 1u];
            at--;
        }
        sides[at] = side;
    }
    uint apart = 1u;
    for (uint index = 1u; index < side_count; index++) {
        if (is_apart(sides[apart - 1u], sides[index])) {
            sides[apart] = sides[index];
            apart++;
        }
    }
    if (!is_apart(sides[apart - 1u], sides[0])) {
        apart--;
    }
    apart = is_upright ? 0u : apart;
    float distances[BOUND_MOST_SIDES];
    for (uint index = 0u; index < apart; index++) {
        distances[index] = -3.0e38;
        for (uint corner = 0u; corner < 6u; corner++) {
            float far = dot(sides[index], spots[corner].middle - middle) + length(sides[index] * spots[corner].radii);
            distances[index] = max(distances[index], far + reach);
        }
        distances[index] += around_px * (abs(sides[index].x) + abs(sides[index].y));
    }
    Bound bound;
    bound.count = apart;
    for (uint index = 0u; index < apart; index++) {
        uint next = (index + 1u) % apart;
        vec2 side = sides[index];
        vec2 after = sides[next];
        vec2 at = vec2(
            distances[index] * after.y - distances[next] * side.y, distances[next] * side.x - distances[index] * after.x);
        bound.corners[index] = middle + at / (side.x * after.y - side.y * after.x);
    }
    if (is_upright) {
        return rectangle;
    }
    return bound;
}

#endif
