// What the geometry pass leaves a texel, and how it is read. Kircher 2009, section 2.1. Twin:
// src/techniques/inferred_lighting/encoding.rs.
//
// normal  xy of the view-space normal after the map of the sphere to the hemisphere, 16-bit snorm each
// dsf     16 bits of linear depth, 65535 where no surface is; above them the object's id and the normal group's, 8 bits each
// extras  8 bits each of roughness and of the material's id, where the light pass has the specular power
#ifndef INFERRED_LIGHTING_ENCODING_GLSL
#define INFERRED_LIGHTING_ENCODING_GLSL

#include "frame.glsl"

const uint NO_SURFACE = 0xffffffffu;
// Steps of linear depth.
const float DEPTH_STEPS = 65534.0;

// Equation 1; the singular direction is away from the eye.
uint pack_view_normal(vec3 normal_vs) {
    vec3 halfway = normal_vs + vec3(0.0, 0.0, 1.0);
    return packSnorm2x16(halfway.xy * inversesqrt(max(dot(halfway, halfway), 1e-12)));
}

// Equations 2 and 3.
vec3 unpack_view_normal(uint word) {
    precise vec2 mapped = unpackSnorm2x16(word);
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
    return uint(fraction * DEPTH_STEPS + 0.5) | (id << 16);
}

float depth_of_dsf(uint word, vec2 range_m) {
    return range_m.x + float(word & 0xffffu) * (range_m.y / DEPTH_STEPS);
}

bool dsf_has_surface(uint word) {
    return (word & 0xffffu) != 0xffffu;
}

uint pack_extras_word(float roughness, uint material) {
    return uint(clamp(roughness, 0.0, 1.0) * 255.0 + 0.5) | ((material & 0xffu) << 8);
}

float roughness_of_extras(uint word) {
    return float(word & 0xffu) / 255.0;
}

#endif
