// World space from a depth buffer.
#ifndef PASSES_DEPTH_GLSL
#define PASSES_DEPTH_GLSL

#include "frame.glsl"

vec3 position_from_depth(FrameBlock frame, uvec2 pixel, float depth) {
    vec2 ndc = (vec2(pixel) + 0.5) / vec2(frame.width_px, frame.height_px) * 2.0 - 1.0;
    precise vec4 position = frame.world_from_clip * vec4(ndc, depth, 1.0);
    precise vec3 position_ws = position.xyz / position.w;
    return position_ws;
}

#endif
