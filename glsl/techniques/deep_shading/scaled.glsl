// Triangles in shading space, each scaled to be as coarse as its blur lets it be (section 6). scales.comp writes the scales.
#ifndef DEEP_SHADING_SCALED_GLSL
#define DEEP_SHADING_SCALED_GLSL

// 1: triangles have scales.
layout(constant_id = 109) const uint HAS_SCALES = 0;

// What a triangle has, by its id. x: scales along both axes, half floats of 0 to 1; y: the place that stays where it is, whole
// pixels of even shading space, 16 bits a side.
layout(std430, set = 0, binding = 19) readonly buffer Scales { uvec2 scales[]; };

// A place on the triangle, xy homogeneous pixels of even shading space, zw depth and w, where shading space has it.
vec4 scaled(vec4 canonical, uint primitive) {
    if (HAS_SCALES == 0u) {
        return canonical;
    }
    uvec2 words = scales[primitive];
    vec2 scale = unpackHalf2x16(words.x);
    vec2 still = vec2(words.y & 0xffffu, words.y >> 16);
    precise vec2 at = canonical.xy * scale + canonical.w * (still * (1.0 - scale));
    return vec4(at, canonical.zw);
}

#endif
