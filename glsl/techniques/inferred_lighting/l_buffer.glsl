// The L-buffer's texels: four half floats, or four numbers of fixed point, as two words. Kircher 2009, sections 2.2, 5.1.
#ifndef INFERRED_LIGHTING_L_BUFFER_GLSL
#define INFERRED_LIGHTING_L_BUFFER_GLSL

// The greatest half float: what is brighter is held there instead of becoming infinite.
const float MOST_LIGHT = 65504.0;

// Light at the last step of fixed point, to which brighter light is clamped; 0: half floats.
layout(constant_id = 21) const float LIGHT_RANGE = 0.0;
// The number after the last step encodes NaN.
const float LIGHT_STEPS = 65534.0;

uvec2 pack_fixed_lighting(vec4 lighting) {
    bvec4 unknown = isnan(lighting);
    vec4 known = mix(lighting, vec4(0.0), unknown);
    uvec4 steps = uvec4(clamp(known / LIGHT_RANGE, vec4(0.0), vec4(1.0)) * LIGHT_STEPS + 0.5);
    uvec4 codes = mix(steps, uvec4(0xffffu), unknown);
    return codes.xz | (codes.yw << 16);
}

uvec2 pack_lighting(vec4 lighting) {
    if (LIGHT_RANGE > 0.0) {
        return pack_fixed_lighting(lighting);
    }
    // NaN stays: a comparison with it is false.
    vec4 held = mix(lighting, vec4(MOST_LIGHT), greaterThan(lighting, vec4(MOST_LIGHT)));
    return uvec2(packHalf2x16(held.rg), packHalf2x16(held.ba));
}

// Light encoded by samples of the L-buffer, and by sums of them whose weights add up to 1.
vec4 light_of(vec4 sampled) {
    return LIGHT_RANGE > 0.0 ? sampled * (LIGHT_RANGE * 65535.0 / LIGHT_STEPS) : sampled;
}

bool is_unknown(vec4 sampled) {
    return LIGHT_RANGE > 0.0 && any(equal(sampled, vec4(1.0)));
}

#endif
