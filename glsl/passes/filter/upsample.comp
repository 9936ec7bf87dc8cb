// Guided bilinear upsampling of irradiance that was estimated at each n-th pixel of both directions: the four texels
// around a pixel, weighed by how near they are on the screen, in normal and off the pixel's plane, each weight a tent.
// Dubla 2009, section 4.1: joint bilateral upsampling whose Gaussians are bilinear. Pass:
// src/passes/filter/upsample.rs.
// variants: POSITION=half|unorm16|depth|float
#version 460
#include "passes/gbuffer_read.glsl"

struct UpsampleParams {
    // Texels of the source.
    uint width;
    uint height;
    // Pixels from one texel's to the next, in both directions.
    uint scale;
    // 1 - dot of the normals, and metres off the pixel's plane, at which a texel counts no more.
    float normal_threshold;
    float position_threshold;
    // Texel of the target at which it begins to write.
    uint target_first;
};

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;

layout(push_constant) uniform Push { UpsampleParams params; };
layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 1) readonly buffer Source { uvec2 source[]; };
layout(std430, set = 0, binding = 2) writeonly buffer Target { uvec2 target[]; };

float tent(float distance, float threshold) {
    return max(1.0 - distance / max(threshold, 1e-12), 0.0);
}

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= frame.width_px || pixel.y >= frame.height_px) {
        return;
    }
    uint target_index = params.target_first + pixel.y * frame.width_px + pixel.x;
    uvec2 normal_bits = normal_words(pixel);
    if (!has_surface(normal_bits)) {
        target[target_index] = uvec2(0u);
        return;
    }
    vec3 normal_ws = unpack_normal(normal_bits);
    vec3 position_ws = unpack_position(frame, position_words(pixel), pixel);
    uvec2 lower = pixel / params.scale;
    vec2 part = vec2(pixel % params.scale) / float(params.scale);
    precise vec3 sum = vec3(0.0);
    precise float weights = 0.0;
    // What stands for it where no texel is like it: the nearest in position.
    vec3 nearest = vec3(0.0);
    float nearest_squared = 1e30;
    for (uint i = 0u; i < 4u; i++) {
        uvec2 beside = uvec2(i & 1u, i >> 1);
        uvec2 texel = min(lower + beside, uvec2(params.width, params.height) - 1u);
        uvec2 other_pixel = texel * params.scale;
        uvec2 other_bits = normal_words(other_pixel);
        if (!has_surface(other_bits)) {
            continue;
        }
        vec3 away = unpack_position(frame, position_words(other_pixel), other_pixel) - position_ws;
        vec3 value = unpack_halves(source[texel.y * params.width + texel.x]);
        vec2 near = mix(1.0 - part, part, vec2(beside));
        precise float weight = near.x * near.y
            * tent(1.0 - dot(normal_ws, unpack_normal(other_bits)), params.normal_threshold)
            * tent(abs(dot(normal_ws, away)), params.position_threshold);
        sum += value * weight;
        weights += weight;
        float squared = dot(away, away);
        if (squared < nearest_squared) {
            nearest_squared = squared;
            nearest = value;
        }
    }
    target[target_index] = pack_halves(weights > 1e-4 ? sum / weights : nearest, 0u);
}
