// The L-buffer's texels: four half floats, as two words. Kircher 2009, section 2.2.
#ifndef INFERRED_LIGHTING_L_BUFFER_GLSL
#define INFERRED_LIGHTING_L_BUFFER_GLSL

// The greatest half float: what is brighter is held there instead of becoming infinite.
const float MOST_LIGHT = 65504.0;

uvec2 pack_lighting(vec4 lighting) {
    // NaN stays: a comparison with it is false.
    vec4 held = mix(lighting, vec4(MOST_LIGHT), greaterThan(lighting, vec4(MOST_LIGHT)));
    return uvec2(packHalf2x16(held.rg), packHalf2x16(held.ba));
}

#endif
