// A triangle's colour at a place, bilinearly from its level of its draw's texture.
//
// A chart's neighbours in the atlas may own texels that a look-up at its rim reads, where a level leaves too little between them: they
// are passed over. Equal colours give that colour to the bit.
//
// After stored.glsl, counting.glsl and atlas.glsl.
#ifndef DEEP_SHADING_LOOKUP_GLSL
#define DEEP_SHADING_LOOKUP_GLSL

#include "nan.glsl"

layout(std430, set = 0, binding = 42) readonly buffer Owners { uint owners[]; };
layout(std430, set = 0, binding = 43) readonly buffer Texels { uvec2 texels[]; };

vec3 between(vec3 from, vec3 to, float part) {
    precise vec3 color = from + part * (to - from);
    return color;
}

// `triangle`: of the index buffer; `weights`: of its corners. As it is stored.
uvec2 looked_up(uint triangle, vec3 weights) {
    uint level = level_of(triangle, canonical_corners(triangle));
    Charted charted = charted_at(triangle, level);
    precise vec2 at = weights.x * charted.corners[0] + weights.y * charted.corners[1] + weights.z * charted.corners[2] - 0.5;
    at = clamp(at, vec2(0.0), vec2(level_side(level) - 1u));
    uvec2 base = min(uvec2(at), uvec2(level_side(level) - 1u));
    uvec2 next = min(base + 1u, uvec2(level_side(level) - 1u));
    vec2 part = at - vec2(base);
    vec3 colors[4];
    bool is_there[4];
    bool is_own[4];
    for (uint tap = 0u; tap < 4u; tap++) {
        uint index = texel_index(level, uvec2(tap % 2u == 0u ? base.x : next.x, tap < 2u ? base.y : next.y));
        uint owner = owners[index] & OWNER_TRIANGLE;
        is_there[tap] = owner != 0u;
        is_own[tap] = owner != 0u && chart_of(owner - 1u) == chart_of(triangle);
        uvec2 words = texels[index];
        colors[tap] = vec3(unpackHalf2x16(words.x), unpackHalf2x16(words.y).x);
    }
    if (!(is_own[0] || is_own[1] || is_own[2] || is_own[3])) {
        if (!(is_there[0] || is_there[1] || is_there[2] || is_there[3])) {
            count(COUNTED_MISSING);
            // Where nothing nearer covers it later, the picture fails.
            return stored_color(vec3(no_number()));
        }
        count(COUNTED_OTHER_CHARTS);
        is_own = is_there;
    }
    vec3 taken[4];
    for (uint tap = 0u; tap < 4u; tap++) {
        // Beside it, above or below it, or across.
        uint from = is_own[tap] ? tap : is_own[tap ^ 1u] ? tap ^ 1u : is_own[tap ^ 2u] ? tap ^ 2u : tap ^ 3u;
        taken[tap] = colors[from];
    }
    return stored_color(
        between(between(taken[0], taken[1], part.x), between(taken[2], taken[3], part.x), part.y));
}

#endif
