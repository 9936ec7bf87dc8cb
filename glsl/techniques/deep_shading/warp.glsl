// Foveated shading space (Clarberg & Munkberg 2014, section 7, has it as future work): finer in the middle than towards the rim.
//
// A place (x, y), from the middle of shading space on in parts of its half sides, goes to (1 + c)(x, y) / (1 + c m), where m is the
// greater of |x| and |y| and c the falloff: a pixel of it is (1 + c m) as wide as one in the middle across the way to the rim, and
// the square of that along it, as acuity falls (Guenter et al. 2012, section 4, have sizes linear in the angle). In each of the
// four sectors between the diagonals m is a coordinate and the map a projective one: straight lines stay straight there, as
// shading space needs it.
#ifndef DEEP_SHADING_WARP_GLSL
#define DEEP_SHADING_WARP_GLSL

// Half of even shading space, pixels.
vec2 even_half_px(DeepBlock deep) {
    return 0.5 * deep.scaled_px + deep.guard_px;
}

// The place in shading space of one in even shading space, both in pixels.
vec2 warped(DeepBlock deep, vec2 at) {
    if (deep.warp_falloff == 0.0) {
        return at;
    }
    vec2 half_px = even_half_px(deep);
    precise vec2 from_middle = (at - half_px) / half_px;
    precise float far = max(abs(from_middle.x), abs(from_middle.y));
    precise vec2 to = from_middle * ((1.0 + deep.warp_falloff) / (1.0 + deep.warp_falloff * far));
    precise vec2 placed = 0.5 * vec2(deep.shading_width_px, deep.shading_height_px) * (1.0 + to);
    return placed;
}

// A pixel of shading space in even shading space.
struct EvenPixel {
    vec2 middle;
    // How far its middle moves when it moves by one pixel of shading space to the right, and down.
    vec2 right;
    vec2 down;
};

EvenPixel even_pixel(DeepBlock deep, uvec2 pixel) {
    EvenPixel even = EvenPixel(vec2(pixel) + 0.5, vec2(1.0, 0.0), vec2(0.0, 1.0));
    if (deep.warp_falloff == 0.0) {
        return even;
    }
    vec2 half_px = even_half_px(deep);
    vec2 warped_half_px = 0.5 * vec2(deep.shading_width_px, deep.shading_height_px);
    precise vec2 to = (even.middle - warped_half_px) / warped_half_px;
    bool is_wide = abs(to.x) > abs(to.y);
    precise float far = is_wide ? abs(to.x) : abs(to.y);
    precise float rest = 1.0 + deep.warp_falloff - deep.warp_falloff * far;
    precise vec2 middle = half_px * (1.0 + to / rest);
    // By how much `rest` shrinks.
    precise vec2 shrinks = deep.warp_falloff * (is_wide ? vec2(sign(to.x), 0.0) : vec2(0.0, sign(to.y))) / warped_half_px;
    precise vec2 own = half_px / (warped_half_px * rest);
    precise vec2 of_rest = half_px * to / (rest * rest);
    even.middle = middle;
    even.right = vec2(own.x, 0.0) + of_rest * shrinks.x;
    even.down = vec2(0.0, own.y) + of_rest * shrinks.y;
    return even;
}

#endif
