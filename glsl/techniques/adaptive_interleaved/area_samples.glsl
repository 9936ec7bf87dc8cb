// Points of area lights, which stand for the lights, and of punctual lights that are spheres. Host part:
// src/techniques/adaptive_interleaved/components/area_samples.rs.
#ifndef ADAPTIVE_INTERLEAVED_AREA_SAMPLES_GLSL
#define ADAPTIVE_INTERLEAVED_AREA_SAMPLES_GLSL

#include "sampling/sobol.glsl"
#include "shading/light_sphere.glsl"

struct AreaSampleBlock {
    vec4 position_ws;
    // xyz: unit normal; w: 1 where both sides shine, else 0.
    vec4 normal_ws;
    // rgb: radiance times the area that the point stands for, candela.
    vec4 intensity;
};

// Each light has a stretch of most * N * M points: those of an iteration lie together, one for each pixel of a tile.
layout(std430, set = 0, binding = 6) readonly buffer Sources { AreaSampleBlock area_samples[]; };

// What a place receives of the index-th punctual light, from the point of its sphere that has the number `own`: as many
// as an area light has points, none of them twice.
Incident incident_of(LightBlock light, uint index, vec3 position_ws, uint own) {
    if (radius_of(light) <= 0.0) {
        return incident_from(light, position_ws);
    }
    return incident_from_sphere(light, position_ws, sobol_pair(own, pair_seed(params.seed, index)));
}

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
