// The L-buffer: light that arrives at a texel, and what of its highlight. Two words a texel. Kircher 2009, sections 2.2, 5.1.
// Twin: src/techniques/inferred_lighting/light/store.rs.
//
// HIGHLIGHT   words
// intensity   four half floats, or four numbers of fixed point: light, and one number of the highlight (the paper's way)
// split       three channels of light with a common exponent; two half floats of the highlight
// rgb         three channels of light with a common exponent; three of the highlight
#ifndef INFERRED_LIGHTING_L_BUFFER_GLSL
#define INFERRED_LIGHTING_L_BUFFER_GLSL

#include "halves.glsl"
#include "nan.glsl"

// The greatest number with a common exponent that is not the code of NaN.
const float MOST_SHARED = 65280.0;

// Light at the last step of fixed point, to which brighter light is clamped; 0: half floats.
layout(constant_id = 21) const float LIGHT_RANGE = 0.0;
// The number after the last step encodes NaN.
const float LIGHT_STEPS = 65534.0;
// HIGHLIGHT_: --highlight.
layout(constant_id = 22) const uint HIGHLIGHT = 0;

const uint HIGHLIGHT_INTENSITY = 0u;
const uint HIGHLIGHT_SPLIT = 1u;
const uint HIGHLIGHT_RGB = 2u;

// What a texel encodes, and sums of it.
struct Lighting {
    // Lux, of which a surface without F0 scatters its albedo.
    vec3 irradiance;
    // By HIGHLIGHT: one number, two, or three (lighting.glsl).
    vec3 highlight;
};

// All bits of both mantissas and the exponent.
const uint SHARED_NAN = 0xffffffffu;

// Three numbers of 9 bits with an exponent of 5, as VK_FORMAT_E5B9G9R9 has them, each rounded to the nearest. Built by bits: the
// same on every driver.
uint pack_shared(vec3 light) {
    if (any(isnan(light))) {
        return SHARED_NAN;
    }
    vec3 held = clamp(light, vec3(0.0), vec3(MOST_SHARED));
    float most = max(max(held.r, held.g), held.b);
    int exponent = max(int(floatBitsToUint(most) >> 23) - 127, -16) + 16;
    float scale = uintBitsToFloat(uint(151 - exponent) << 23);
    if (uint(most * scale + 0.5) > 511u) {
        exponent++;
        scale *= 0.5;
    }
    uvec3 steps = uvec3(held * scale + 0.5);
    return steps.r | (steps.g << 9) | (steps.b << 18) | (uint(exponent) << 27);
}

vec3 unpack_shared(uint word) {
    if (word == SHARED_NAN) {
        return vec3(no_number());
    }
    float step_size = uintBitsToFloat(((word >> 27) + 103u) << 23);
    return vec3(word & 0x1ffu, (word >> 9) & 0x1ffu, (word >> 18) & 0x1ffu) * step_size;
}

uvec2 pack_fixed(vec4 numbers) {
    bvec4 unknown = isnan(numbers);
    vec4 known = mix(numbers, vec4(0.0), unknown);
    uvec4 steps = uvec4(clamp(known / LIGHT_RANGE, vec4(0.0), vec4(1.0)) * LIGHT_STEPS + 0.5);
    uvec4 codes = mix(steps, uvec4(0xffffu), unknown);
    return codes.xz | (codes.yw << 16);
}

vec4 unpack_fixed(uvec2 words) {
    uvec4 codes = uvec4(words.x & 0xffffu, words.x >> 16, words.y & 0xffffu, words.y >> 16);
    return mix(vec4(codes) * (LIGHT_RANGE / LIGHT_STEPS), vec4(no_number()), equal(codes, uvec4(0xffffu)));
}

uvec2 pack_lighting(Lighting lighting) {
    if (HIGHLIGHT == HIGHLIGHT_RGB) {
        return uvec2(pack_shared(lighting.irradiance), pack_shared(lighting.highlight));
    }
    if (HIGHLIGHT == HIGHLIGHT_SPLIT) {
        vec4 held = held_in_halves(vec4(lighting.highlight.xy, vec2(0.0)));
        return uvec2(pack_shared(lighting.irradiance), packHalf2x16(held.xy));
    }
    vec4 numbers = vec4(lighting.irradiance, lighting.highlight.x);
    if (LIGHT_RANGE > 0.0) {
        return pack_fixed(numbers);
    }
    vec4 held = held_in_halves(numbers);
    return uvec2(packHalf2x16(held.rg), packHalf2x16(held.ba));
}

Lighting unpack_lighting(uvec2 words) {
    if (HIGHLIGHT == HIGHLIGHT_RGB) {
        return Lighting(unpack_shared(words.x), unpack_shared(words.y));
    }
    if (HIGHLIGHT == HIGHLIGHT_SPLIT) {
        return Lighting(unpack_shared(words.x), vec3(unpackHalf2x16(words.y), 0.0));
    }
    if (LIGHT_RANGE > 0.0) {
        vec4 numbers = unpack_fixed(words);
        return Lighting(numbers.rgb, vec3(numbers.a, 0.0, 0.0));
    }
    vec2 last = unpackHalf2x16(words.y);
    return Lighting(vec3(unpackHalf2x16(words.x), last.x), vec3(last.y, 0.0, 0.0));
}

// Channels of HIGHLIGHT=intensity as a sampler reads them.
Lighting lighting_of(vec4 sampled) {
    vec4 numbers = LIGHT_RANGE > 0.0 ? sampled * (LIGHT_RANGE * 65535.0 / LIGHT_STEPS) : sampled;
    return Lighting(numbers.rgb, vec3(numbers.a, 0.0, 0.0));
}

bool is_unknown_sample(vec4 sampled) {
    return LIGHT_RANGE > 0.0 && any(equal(sampled, vec4(1.0)));
}

#endif
