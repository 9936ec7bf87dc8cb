// A box along a direction and across it, which a triangle covers nothing outside of: what msaa.vert draws a triangle around, and
// what msaa.frag leaves the rest of that triangle out by.
#ifndef DEEP_SHADING_BASELINE_BOX_GLSL
#define DEEP_SHADING_BASELINE_BOX_GLSL

// Pixels.
struct Box {
    vec2 along;
    vec2 least;
    vec2 greatest;
};

vec2 turned(vec2 along, vec2 at) {
    return vec2(dot(along, at), along.x * at.y - along.y * at.x);
}

// How far the corners of a pixel lie from its middle along a direction, and a tenth for rounding.
float half_pixel(vec2 along) {
    return 0.55 * (abs(along.x) + abs(along.y));
}

// `tight`: a box without any margin. Whether something of the pixel with this middle may lie in it.
bool may_touch(Box tight, vec2 middle) {
    vec2 at = turned(tight.along, middle);
    float reach = half_pixel(tight.along);
    return all(greaterThanEqual(at, tight.least - reach)) && all(lessThanEqual(at, tight.greatest + reach));
}

#endif
