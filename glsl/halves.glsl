// What a half float holds: more would become infinite.
#ifndef HALVES_GLSL
#define HALVES_GLSL

// The greatest half float.
const float HALF_MAX = 65504.0;

// Brighter than that becomes that. A comparison and no min(), which may take the other number for NaN: what fails a picture
// would be a bright one.
vec4 held_in_halves(vec4 numbers) {
    return mix(numbers, vec4(HALF_MAX), greaterThan(numbers, vec4(HALF_MAX)));
}

vec3 held_in_halves(vec3 numbers) {
    return mix(numbers, vec3(HALF_MAX), greaterThan(numbers, vec3(HALF_MAX)));
}

#endif
