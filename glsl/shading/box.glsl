// Where a ray is in a box.
#ifndef SHADING_BOX_GLSL
#define SHADING_BOX_GLSL

// Where a box begins and ends on a ray between two places of it, counted in the direction's length; both alike where it is not
// met.
vec2 in_box(vec3 least, vec3 most, vec3 origin, vec3 direction, float from, float to) {
    vec3 inverse = 1.0 / mix(direction, vec3(1e-20), equal(direction, vec3(0.0)));
    vec3 near = (least - origin) * inverse;
    vec3 far = (most - origin) * inverse;
    vec3 low = min(near, far);
    vec3 high = max(near, far);
    float begin = max(max(low.x, low.y), max(low.z, from));
    float end = min(min(high.x, high.y), min(high.z, to));
    return vec2(begin, max(begin, end));
}

#endif
