// A shading point: a pixel's middle on a triangle in canonical shading space, or the triangle's place nearest to it (section
// 4.4). A function of triangle and pixel alone, in this order of operations: the same for every caller, however the
// triangle got there, gets the same bits.
//
// Barycentric weights are ratios of homogeneous areas, taken from the pixel's middle on: products of places on the screen
// would lose a small triangle in rounding. They hold for triangles that reach behind the eye too.
#ifndef DEEP_SHADING_PLACE_GLSL
#define DEEP_SHADING_PLACE_GLSL

struct Place {
    // Perspective-correct, of sum 1.
    vec3 weights;
    // By how much they change a pixel to the right, and down.
    vec3 right;
    vec3 down;
    // Whether the triangle, wound as it was given, is counter-clockwise on the screen.
    bool is_front;
};

// The part of an edge before the near plane that is nearest to the pixel's middle. `from`, `to`: xy homogeneous pixels from
// the middle on, z depth, w. Returns the weight of `to` and the squared distance in pixels; the second is negative
// where the edge lies behind the near plane.
vec2 nearest_on_edge(vec4 from, vec4 to) {
    // Reversed depth: what is before the near plane has z above w.
    precise float from_depth = from.w - from.z;
    precise float to_depth = to.w - to.z;
    float first = 0.0;
    float last = 1.0;
    if (from_depth < 0.0) {
        first = from_depth / (from_depth - to_depth);
    }
    if (to_depth < 0.0) {
        last = from_depth / (from_depth - to_depth);
    }
    if (from_depth < 0.0 && to_depth < 0.0) {
        return vec2(0.0, -1.0);
    }
    precise vec4 start = mix(from, to, first);
    precise vec4 end = mix(from, to, last);
    precise vec2 start_px = start.xy / start.w;
    precise vec2 end_px = end.xy / end.w;
    precise vec2 along = end_px - start_px;
    precise float length_squared = dot(along, along);
    precise float part = length_squared > 0.0 ? clamp(-dot(start_px, along) / length_squared, 0.0, 1.0) : 0.0;
    precise vec2 nearest = start_px + part * along;
    // Straight on the screen is not even in space.
    precise float near_end = part * start.w;
    precise float near_start = (1.0 - part) * end.w;
    precise float even = near_end / max(near_start + near_end, 1e-37);
    return vec2(mix(first, last, even), dot(nearest, nearest));
}

// What a triangle's edges span with a place, homogeneous areas: of the edge opposite each corner. Arguments are the corners'
// homogeneous pixels from that place on. Parts of their sum are the corners' weights.
vec3 areas_of(vec2 a, vec2 b, vec2 c) {
    precise vec3 areas = vec3(b.x * c.y - b.y * c.x, c.x * a.y - c.y * a.x, a.x * b.y - a.y * b.x);
    return areas;
}

// A place of these weights with its rates. `from_a`, `from_b`, `from_c`: the corners' homogeneous pixels from a pixel's middle on;
// `w`: theirs; `moved`: how far from that middle the place lies, pixels.
Place place_of(vec2 from_a, vec2 from_b, vec2 from_c, vec3 w, vec3 weights, vec2 moved) {
    vec3 areas = areas_of(from_a, from_b, from_c);
    precise float area = areas.x + areas.y + areas.z;
    // Areas change evenly over the screen.
    precise vec3 right =
        vec3(w.z * from_b.y - w.y * from_c.y, w.x * from_c.y - w.z * from_a.y, w.y * from_a.y - w.x * from_b.y);
    precise vec3 down =
        vec3(w.y * from_c.x - w.z * from_b.x, w.z * from_a.x - w.x * from_c.x, w.x * from_b.x - w.y * from_a.x);
    precise float right_sum = right.x + right.y + right.z;
    precise float down_sum = down.x + down.y + down.z;
    precise float there = area + right_sum * moved.x + down_sum * moved.y;
    // Edge-on there is no rate: the finest level.
    bool has_rate = abs(there) > 1e-30;
    Place place;
    place.is_front = area < 0.0;
    place.weights = weights;
    place.right = has_rate ? (right - weights * right_sum) / there : vec3(0.0);
    place.down = has_rate ? (down - weights * down_sum) / there : vec3(0.0);
    return place;
}

// `a`, `b`, `c`: xy homogeneous pixels of shading space, z depth, w; `middle`: of the pixel.
Place place_at(vec4 a, vec4 b, vec4 c, vec2 middle) {
    precise vec2 from_a = a.xy - a.w * middle;
    precise vec2 from_b = b.xy - b.w * middle;
    precise vec2 from_c = c.xy - c.w * middle;
    vec3 areas = areas_of(from_a, from_b, from_c);
    precise float area = areas.x + areas.y + areas.z;
    precise vec3 weights = areas / area;
    bool is_inside = area != 0.0 && all(greaterThanEqual(weights, vec3(0.0)));
    precise vec2 moved = vec2(0.0);
    if (!is_inside) {
        vec4 corners[3] = vec4[3](vec4(from_a, a.zw), vec4(from_b, b.zw), vec4(from_c, c.zw));
        float least = 3.0e38;
        // A triangle that is behind the near plane has no place: any of it will do.
        weights = vec3(1.0, 0.0, 0.0);
        for (uint edge = 0u; edge < 3u; edge++) {
            vec2 nearest = nearest_on_edge(corners[edge], corners[(edge + 1u) % 3u]);
            if (nearest.y >= 0.0 && nearest.y < least) {
                least = nearest.y;
                weights = vec3(0.0);
                weights[edge] = 1.0 - nearest.x;
                weights[(edge + 1u) % 3u] = nearest.x;
            }
        }
        precise vec4 at = weights.x * corners[0] + weights.y * corners[1] + weights.z * corners[2];
        moved = at.w > 0.0 ? at.xy / at.w : vec2(0.0);
    }
    return place_of(from_a, from_b, from_c, vec3(a.w, b.w, c.w), weights, moved);
}

#endif
