// The G-buffer's encoding: 16 bits a component, as integers, so that every driver stores the same bits.
// Segovia 2006, section 4.1. Twin: src/passes/gbuffer.rs.
//
// position  half: xyz in half floats | unorm16: xyz as fractions of the scene's box | float: xyz in 32 bits
//           | depth: no image, the depth buffer holds it
// normal    xyz in 16-bit snorm; in the fourth 16 bits roughness and metallic, 8 bits each
// color     base colour in half floats; in the fourth 16 bits the material's id
// emissive  radiance in half floats; in the fourth 16 bits what few materials say (shading/extras.glsl), 0 for the common
//           ones; an image only where the scene has emissive materials, or such
// A pixel without surface has all normal bits 0, which no unit normal has.
#ifndef PASSES_GBUFFER_GLSL
#define PASSES_GBUFFER_GLSL

#include "halves.glsl"
#include "passes/depth.glsl"

uvec2 pack_halves(vec3 value, uint last16) {
    precise vec3 held = held_in_halves(value);
    return uvec2(packHalf2x16(held.xy), (packHalf2x16(vec2(held.z, 0.0)) & 0xffffu) | (last16 << 16));
}

vec3 unpack_halves(uvec2 words) {
    return vec3(unpackHalf2x16(words.x), unpackHalf2x16(words.y).x);
}

uint last16(uvec2 words) {
    return words.y >> 16;
}

uvec2 pack_normal(vec3 normal, float roughness, float metallic) {
    uint last = uint(clamp(roughness, 0.0, 1.0) * 255.0 + 0.5) | (uint(clamp(metallic, 0.0, 1.0) * 255.0 + 0.5) << 8);
    return uvec2(packSnorm2x16(normal.xy), (packSnorm2x16(vec2(normal.z, 0.0)) & 0xffffu) | (last << 16));
}

bool has_surface(uvec2 normal_words) {
    return normal_words.x != 0u || (normal_words.y & 0xffffu) != 0u;
}

vec3 unpack_normal(uvec2 words) {
    precise vec3 normal = vec3(unpackSnorm2x16(words.x), unpackSnorm2x16(words.y).x);
    return normal * inversesqrt(max(dot(normal, normal), 1e-12));
}

// x: roughness, y: metallic.
vec2 unpack_roughness_metallic(uvec2 words) {
    return vec2(last16(words) & 0xffu, last16(words) >> 8) / 255.0;
}

uvec2 pack_unorm16(FrameBlock frame, vec3 position_ws) {
    vec3 fraction = clamp((position_ws - frame.box_min_ws.xyz) / frame.box_size_ws.xyz, 0.0, 1.0);
    uvec3 steps = uvec3(fraction * 65535.0 + 0.5);
    return uvec2(steps.x | (steps.y << 16), steps.z);
}

vec3 unpack_unorm16(FrameBlock frame, uvec2 words) {
    vec3 steps = vec3(words.x & 0xffffu, words.x >> 16, words.y & 0xffffu);
    precise vec3 position_ws = frame.box_min_ws.xyz + frame.box_size_ws.xyz * (steps / 65535.0);
    return position_ws;
}

// The words that hold a position, and what reads them back. `pixel` matters to `depth` only.
#if defined(POSITION_FLOAT)
#define POSITION_WORDS uvec4
vec3 unpack_position(FrameBlock frame, POSITION_WORDS words, uvec2 pixel) {
    return uintBitsToFloat(words.xyz);
}
#elif defined(POSITION_HALF)
#define POSITION_WORDS uvec2
vec3 unpack_position(FrameBlock frame, POSITION_WORDS words, uvec2 pixel) {
    return unpack_halves(words);
}
#elif defined(POSITION_UNORM16)
#define POSITION_WORDS uvec2
vec3 unpack_position(FrameBlock frame, POSITION_WORDS words, uvec2 pixel) {
    return unpack_unorm16(frame, words);
}
#elif defined(POSITION_DEPTH)
#define POSITION_WORDS uint
vec3 unpack_position(FrameBlock frame, POSITION_WORDS words, uvec2 pixel) {
    return position_from_depth(frame, pixel, uintBitsToFloat(words));
}
#endif

#endif
