// What both stages of the slices have. Pass: src/techniques/interleaved_sampling/slices.rs.
#ifndef TECHNIQUES_INTERLEAVED_SAMPLING_SLICES_GLSL
#define TECHNIQUES_INTERLEAVED_SAMPLING_SLICES_GLSL

#include "frame.glsl"
#include "shading/volume.glsl"

struct SlicesParams {
    uint plane_count;
    // Texels of a member's picture.
    uint layer_width;
    uint layer_height;
};

layout(push_constant) uniform Push { SlicesParams params; };
layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };

// Where the camera looks, whatever the lens does: planes are at right angles to it.
vec3 axis_ws() {
    return cross(frame.up_ws.xyz, frame.right_ws.xyz);
}

// How far before the eye's plane a place lies, metres.
float depth_of(vec3 place_ws) {
    return dot(place_ws - frame.eye_ws.xyz, axis_ws());
}

#endif
