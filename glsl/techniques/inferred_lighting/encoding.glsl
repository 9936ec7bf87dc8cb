// What the geometry pass leaves a texel, and how it is read. Kircher 2009, section 2.1. Twin:
// src/techniques/inferred_lighting/encoding.rs.
//
// normal  xy of the view-space normal after the map of the sphere to the hemisphere, 16-bit snorm each
// dsf     16 bits of linear depth, 65535 where no surface is; above them the object's id and the normal group's, 8 bits each
// extras  8 bits each of roughness and of the material's id, 16 of F0, where the light pass has the specular power
//
// A texel is a word of two 16-bit numbers. Its target is that word, or the word's bytes in four channels, or its numbers in
// two channels of fixed point (section 5); all are read as the word. In fixed point a number has FIXED_STEPS steps of the
// 65535, those in the middle.
#ifndef INFERRED_LIGHTING_ENCODING_GLSL
#define INFERRED_LIGHTING_ENCODING_GLSL

#include "frame.glsl"

// Odd; 0: the target is not fixed point, and numbers are whole words' halves.
layout(constant_id = 20) const uint FIXED_STEPS = 0;

// Alpha below which a BLEND surface is taken for empty: no lit sample belongs there (section 6).
const float LEAST_ALPHA = 1.0 / 255.0;

// The least number that is used. Branches, because the build cannot evaluate a choice of constants.
uint first_number() {
    if (FIXED_STEPS == 0u) {
        return 0u;
    }
    return (0xffffu - FIXED_STEPS) / 2u;
}

// A 16-bit number as fixed point has it, and back.
uint fixed_code(uint number) {
    if (FIXED_STEPS == 0u) {
        return number;
    }
    return first_number() + (number * FIXED_STEPS + 0x7fffu) / 0xffffu;
}

// Steps of linear depth: the last of all is where no surface is.
uint depth_steps() {
    if (FIXED_STEPS == 0u) {
        return 65534u;
    }
    return FIXED_STEPS - 1u;
}

// What stands in the target of a word.
vec4 channels_of(uint word) {
    // A quarter of a step more: a driver that rounds and one that cuts find the same number.
    if (FIXED_STEPS == 0u) {
        return (vec4(word & 0xffu, (word >> 8) & 0xffu, (word >> 16) & 0xffu, word >> 24) + 0.25) / 255.0;
    }
    return vec4((vec2(word & 0xffffu, word >> 16) + 0.25) / 65535.0, 0.0, 0.0);
}

// Equation 1; the singular direction is away from the eye.
uint pack_view_normal(vec3 normal_vs) {
    vec3 halfway = normal_vs + vec3(0.0, 0.0, 1.0);
    vec2 mapped = halfway.xy * inversesqrt(max(dot(halfway, halfway), 1e-12));
    if (FIXED_STEPS == 0u) {
        return packSnorm2x16(mapped);
    }
    // 0 has a code of its own, in the middle.
    float most = float(FIXED_STEPS / 2u);
    uvec2 codes = first_number() + uvec2(clamp(mapped, vec2(-1.0), vec2(1.0)) * most + most + 0.5);
    return codes.x | (codes.y << 16);
}

vec2 mapped_normal(uint word) {
    if (FIXED_STEPS == 0u) {
        return unpackSnorm2x16(word);
    }
    float most = float(FIXED_STEPS / 2u);
    return (vec2(uvec2(word & 0xffffu, word >> 16) - first_number()) - most) / most;
}

// Equations 2 and 3.
vec3 unpack_view_normal(uint word) {
    precise vec2 mapped = mapped_normal(word);
    precise float z = sqrt(max(1.0 - dot(mapped, mapped), 0.0));
    precise vec3 normal_vs = vec3(2.0 * z * mapped, 2.0 * z * z - 1.0);
    return normal_vs;
}

vec3 view_from_world(FrameBlock frame, vec3 direction_ws) {
    return vec3(
        dot(frame.right_ws.xyz, direction_ws), dot(frame.up_ws.xyz, direction_ws), -dot(frame.forward_ws.xyz, direction_ws));
}

vec3 world_from_view(FrameBlock frame, vec3 direction_vs) {
    precise vec3 direction_ws = frame.right_ws.xyz * direction_vs.x + frame.up_ws.xyz * direction_vs.y
        - frame.forward_ws.xyz * direction_vs.z;
    return direction_ws;
}

// Metres from the eye's plane.
float linear_depth(FrameBlock frame, vec3 position_ws) {
    return dot(frame.forward_ws.xyz, position_ws - frame.eye_ws.xyz);
}

// `range_m`: depth of the first step, and of all of them.
uint pack_dsf(float depth_m, vec2 range_m, uint id) {
    float fraction = clamp((depth_m - range_m.x) / range_m.y, 0.0, 1.0);
    uint steps = uint(fraction * float(depth_steps()) + 0.5);
    return (first_number() + steps) | (fixed_code(id) << 16);
}

float depth_of_dsf(uint word, vec2 range_m) {
    return range_m.x + float((word & 0xffffu) - first_number()) * (range_m.y / float(depth_steps()));
}

// How far apart two depths of one surface may be, `threshold` a part of the depth: that, and two steps.
float depth_slack_m(float depth_m, float threshold, vec2 range_m) {
    return threshold * abs(depth_m) + 2.0 * range_m.y / float(depth_steps());
}

bool dsf_has_surface(uint word) {
    return (word & 0xffffu) != first_number() + depth_steps() + 1u;
}

// F0 in 16 bits, by roots, which dark values need. 0: nothing mirrors, at no angle. Up to 32767: gray, as of all that is not metal;
// from 32768 on: 5 bits a channel. The ends of gray are left out, so that fewer steps of fixed point do not round into them.
const uint F0_COLORED = 0x8000u;
const uint F0_LEAST_GRAY = 64u;
const uint F0_MOST_GRAY = 0x7fffu - 64u;

uint pack_f0(vec3 f0, float f90) {
    if (f90 == 0.0) {
        return 0u;
    }
    vec3 root = sqrt(clamp(f0, vec3(0.0), vec3(1.0)));
    if (all(lessThan(abs(root - root.ggg), vec3(1.0 / 1024.0)))) {
        return clamp(uint(root.g * float(0x7fff) + 0.5), F0_LEAST_GRAY, F0_MOST_GRAY);
    }
    uvec3 steps = uvec3(root * 31.0 + 0.5);
    return F0_COLORED | (steps.r << 10) | (steps.g << 5) | steps.b;
}

vec3 unpack_f0(uint code) {
    vec3 root = vec3(float(code) / float(0x7fff));
    if (code >= F0_COLORED) {
        root = vec3((code >> 10) & 0x1fu, (code >> 5) & 0x1fu, code & 0x1fu) / 31.0;
    }
    return root * root;
}

// In fixed point roughness and F0 have a number each, and the material's id has no room.
uint pack_extras_word(float roughness, uint material, uint f0_code) {
    float held = clamp(roughness, 0.0, 1.0);
    if (FIXED_STEPS == 0u) {
        return uint(held * 255.0 + 0.5) | ((material & 0xffu) << 8) | (f0_code << 16);
    }
    uint code = first_number() + uint(held * float(FIXED_STEPS) + 0.5);
    return code | (fixed_code(f0_code) << 16);
}

float roughness_of_extras(uint word) {
    if (FIXED_STEPS == 0u) {
        return float(word & 0xffu) / 255.0;
    }
    return float((word & 0xffffu) - first_number()) / float(FIXED_STEPS);
}

uint f0_code_of_extras(uint word) {
    if (FIXED_STEPS == 0u) {
        return word >> 16;
    }
    return (((word >> 16) - first_number()) * 0xffffu + FIXED_STEPS / 2u) / FIXED_STEPS;
}

#endif
