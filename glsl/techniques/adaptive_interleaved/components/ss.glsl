// Soft shadows (SS): light straight from area lights, one point of each an iteration, and from punctual lights, each
// point with a shadow ray. Dubla 2009, section 3.3 and Listing 3. Host part:
// src/techniques/adaptive_interleaved/components/ss.rs.
#ifndef ADAPTIVE_INTERLEAVED_SS_GLSL
#define ADAPTIVE_INTERLEAVED_SS_GLSL

// A point of an area light.
struct AreaSampleBlock {
    vec4 position_ws;
    // xyz: unit normal; w: 1 where both sides shine, else 0.
    vec4 normal_ws;
    // rgb: radiance times the area that the point stands for, candela.
    vec4 intensity;
};

// Each light has a stretch of most * N * M points: those of an iteration lie together, one for each pixel of a tile.
layout(std430, set = 0, binding = 6) readonly buffer Sources { AreaSampleBlock area_samples[]; };
layout(std430, set = 0, binding = 7) readonly buffer Lights { LightBlock lights[]; };

vec3 area_irradiance(AreaSampleBlock light, vec3 position_ws, vec3 normal_ws, vec3 to_light) {
    precise float distance_squared = dot(to_light, to_light);
    float leaving = -dot(light.normal_ws.xyz, to_light);
    leaving = light.normal_ws.w != 0.0 ? abs(leaving) : max(leaving, 0.0);
    precise float facing = max(dot(normal_ws, to_light), 0.0) * leaving;
    // Both cosines carry one factor 1/d.
    precise float squared = max(distance_squared, LEAST_DISTANCE_SQUARED);
    return light.intensity.rgb * (facing / (squared * squared));
}

// What a point meets in one iteration.
struct Met {
    uint missed_count;
    uint light_count;
    // A bit a light: 1 where nothing hides it. Of lights that share a bit it changes where one of them does.
    uint lit;
};

// `received`: what arrives where nothing hides it. What a surface turns away from is hidden by the surface itself.
void add_light(
    Point point,
    vec3 received,
    vec3 direction_ws,
    float distance,
    uint index,
    inout Estimate estimate,
    inout Met met
) {
    met.light_count++;
    if (received == vec3(0.0)) {
        met.missed_count++;
        return;
    }
    estimate.ray_count++;
    if (occluded(point.position_ws, point.normal_ws, direction_ws, distance)) {
        met.missed_count++;
    } else {
        met.lit ^= 1u << (index % LIGHT_BITS);
        precise vec3 sum = estimate.sum + received;
        estimate.sum = sum;
    }
}

// Lights that do not reach so far guide nothing.
void contribute(Point point, uint slot, uint iteration, inout Estimate estimate) {
    uint size = tile_size(params);
    Met met = Met(0u, 0u, 0u);
    uint area = 0u;
    for (; area < params.source_count; area++) {
        AreaSampleBlock light = area_samples[(area * params.most + iteration) * size + slot];
        vec3 to_light = light.position_ws.xyz - point.position_ws;
        vec3 received = area_irradiance(light, point.position_ws, point.normal_ws, to_light);
        float distance = length(to_light);
        add_light(point, received, to_light / max(distance, 1e-12), distance, area, estimate, met);
    }
    expect_done(area == params.source_count);
    uint punctual = 0u;
    for (; punctual < params.light_count; punctual++) {
        Incident incident = incident_from(lights[punctual], point.position_ws);
        if (incident.irradiance != vec3(0.0)) {
            precise float cosine = max(dot(point.normal_ws, incident.direction_ws), 0.0);
            vec3 received = incident.irradiance * cosine;
            uint index = params.source_count + punctual;
            add_light(point, received, incident.direction_ws, incident.distance, index, estimate, met);
        }
    }
    expect_done(punctual == params.light_count);
    estimate.information += met.light_count > 0u ? float(met.missed_count) / float(met.light_count) : 0.0;
    estimate.lit_any |= met.lit;
    estimate.lit_all &= met.lit;
}

// The part of the lights that was hidden, or each light's bit. One that a texel met in some iterations only counts as
// met at every second texel, so that the tile is in its penumbra.
uint found_word(uint slot, Estimate estimate) {
    if (params.guides_each == 0u) {
        return floatBitsToUint(estimate.information / float(params.base));
    }
    return (slot & 1u) == 0u ? estimate.lit_any : estimate.lit_all & estimate.lit_any;
}

#endif
