// A convex polygon around all that a triangle covers of a layer while the shutter is open, from all of the lens (section 4.2;
// McGuire et al. 2010).
//
// A corner that moves on a straight line before the eye is seen on a straight line too, from each place on the lens: the six
// ellipses, in which the lens shows the corners at both ends of the exposure, have all of the triangle in their hull. The
// polygon's sides touch that hull. They lie along the triangle's edges at both ends, along its way, and along the screen: of a
// sharp triangle the polygon is that triangle. No side needs to know the others, which a walk around the hull would.
#ifndef DEEP_SHADING_BOUND_GLSL
#define DEEP_SHADING_BOUND_GLSL

#include "techniques/deep_shading/snap.glsl"

// Of the screen, of the triangle's edges at both ends, and of its way.
const uint BOUND_MOST_SIDES = 12u;
// Without motion the triangle has one place and no way.
const uint BOUND_STILL_SIDES = 7u;
// Floats place what is far outside by as much of it less well.
const float BOUND_REACH_PART = 1.0 / 1048576.0;
// What is farther out than this many sides of a layer is not placed well enough: all of the layer is tested.
const float BOUND_FARTHEST = 256.0;
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
    // At least 3, or 0 where all is before the near plane.
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

Bound whole_layer(vec2 layer) {
    Bound bound;
    bound.corners[0] = vec2(-1.0);
    bound.corners[1] = vec2(layer.x + 1.0, -1.0);
    bound.corners[2] = layer + 1.0;
    bound.corners[3] = vec2(-1.0, layer.y + 1.0);
    bound.count = 4u;
    return bound;
}

// `seen`: three corners when the shutter opens, and the same when it closes.
Bound bound_of(Seen seen[6], TupleBlock tuple, vec2 layer) {
    uint near_count = 0u;
    for (uint index = 0u; index < 6u; index++) {
        // Reversed depth. The lens moves neither depth nor w.
        bool is_seen = seen[index].clip.w > 0.0 && seen[index].clip.z <= seen[index].clip.w;
        near_count += is_seen ? 0u : 1u;
    }
    if (near_count > 0u) {
        Bound bound = whole_layer(layer);
        bound.count = near_count == 6u ? 0u : bound.count;
        return bound;
    }
    Spot spots[6];
    vec2 middle = vec2(0.0);
    float farthest = 0.0;
    for (uint index = 0u; index < 6u; index++) {
        spots[index] = spot_of(seen[index], tuple, 0.5 * layer);
        middle += spots[index].middle / 6.0;
        vec2 far = abs(spots[index].middle) + spots[index].radii;
        farthest = max(farthest, max(far.x, far.y));
    }
    if (!(farthest < BOUND_FARTHEST * max(layer.x, layer.y))) {
        return whole_layer(layer);
    }
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
    for (uint last = 1u; last < side_count; last++) {
        for (uint at = last; at > 0u && turn_of(sides[at]) < turn_of(sides[at - 1u]); at--) {
            vec2 side = sides[at];
            sides[at] = sides[at - 1u];
            sides[at - 1u] = side;
        }
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
    float reach = snap_px() + BOUND_REACH_PART * farthest;
    float distances[BOUND_MOST_SIDES];
    for (uint index = 0u; index < apart; index++) {
        distances[index] = -3.0e38;
        for (uint corner = 0u; corner < 6u; corner++) {
            float far = dot(sides[index], spots[corner].middle - middle) + length(sides[index] * spots[corner].radii);
            distances[index] = max(distances[index], far + reach);
        }
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
    return bound;
}

#endif
