// Points of area lights, which stand for the lights. Host part:
// src/techniques/adaptive_interleaved/components/area_samples.rs.
#ifndef ADAPTIVE_INTERLEAVED_AREA_SAMPLES_GLSL
#define ADAPTIVE_INTERLEAVED_AREA_SAMPLES_GLSL

#include "shading/light.glsl"

struct AreaSampleBlock {
    vec4 position_ws;
    // xyz: unit normal; w: 1 where both sides shine, else 0.
    vec4 normal_ws;
    // rgb: radiance times the area that the point stands for, candela.
    vec4 intensity;
};

// Each light has a stretch of most * N * M points: those of an iteration lie together, one for each pixel of a tile.
layout(std430, set = 0, binding = 6) readonly buffer Sources { AreaSampleBlock area_samples[]; };

// Cosine at the light times the distance: 0 where it does not shine.
float leaving_towards(AreaSampleBlock light, vec3 to_light) {
    float leaving = -dot(light.normal_ws.xyz, to_light);
    return light.normal_ws.w != 0.0 ? abs(leaving) : max(leaving, 0.0);
}

// Irradiance of a surface of this normal.
vec3 area_irradiance(AreaSampleBlock light, vec3 normal_ws, vec3 to_light) {
    precise float distance_squared = dot(to_light, to_light);
    precise float facing = max(dot(normal_ws, to_light), 0.0) * leaving_towards(light, to_light);
    // Both cosines carry one factor 1/d.
    precise float squared = max(distance_squared, LEAST_DISTANCE_SQUARED);
    return light.intensity.rgb * (facing / (squared * squared));
}

// Irradiance of what faces the light.
vec3 facing_irradiance(AreaSampleBlock light, vec3 to_light) {
    precise float squared = max(dot(to_light, to_light), LEAST_DISTANCE_SQUARED);
    return light.intensity.rgb * (leaving_towards(light, to_light) / (squared * sqrt(squared)));
}

#endif
