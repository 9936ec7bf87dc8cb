// Irradiance at a surface point from one subset of the lights: virtual point lights, then punctual lights that were
// joined to the subsets (--direct interleaved). Every road of the split calls this one function, from compute shaders
// and from a fragment shader; where the irradiance goes is theirs.
#ifndef INTERLEAVED_DEFERRED_IRRADIANCE_GLSL
#define INTERLEAVED_DEFERRED_IRRADIANCE_GLSL

#include "bvh.glsl"
#include "shading/light.glsl"
#include "techniques/interleaved_deferred/mapping.glsl"

// A subset's stretches of the two lists.
struct SubsetBlock {
    uint vpl_first;
    uint vpl_count;
    uint light_first;
    uint light_count;
};

struct ShadeParams {
    MappingParams mapping;
    // Square of --vpl-clamp, in square metres.
    float least_squared;
    // n * m: the mean over a pattern is the sum over all lights.
    float weight;
    // First subset of this dispatch; 0 where a dispatch has them all.
    uint subset_first;
};

layout(constant_id = 3) const uint DIRECT_SHADOW = 0;

layout(push_constant) uniform Push { ShadeParams params; };
layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 1) readonly buffer Vpls { VplBlock vpls[]; };
layout(std430, set = 0, binding = 2) readonly buffer SubsetLights { LightBlock subset_lights[]; };
layout(std430, set = 0, binding = 3) readonly buffer Subsets { SubsetBlock subsets[]; };
layout(std430, set = 0, binding = 4) readonly buffer BvhNodes { BvhNodeBlock bvh_nodes[]; };
layout(std430, set = 0, binding = 5) readonly buffer BvhTriangles { BvhTriangleBlock bvh_triangles[]; };

#include "bvh_walk.glsl"

uvec2 shade_subset(SubsetBlock subset, vec3 position_ws, vec3 normal_ws) {
    precise vec3 sum = vec3(0.0);
    for (uint vpl = subset.vpl_first; vpl < subset.vpl_first + subset.vpl_count; vpl++) {
        sum += vpl_irradiance(vpls[vpl], position_ws, normal_ws, params.least_squared);
    }
    for (uint index = subset.light_first; index < subset.light_first + subset.light_count; index++) {
        LightBlock light = subset_lights[index];
        Incident incident = incident_from(light, position_ws);
        precise float cosine = dot(normal_ws, incident.direction_ws);
        if (cosine <= 0.0 || incident.irradiance == vec3(0.0)) {
            continue;
        }
        if (DIRECT_SHADOW == SHADOW_RAY || (DIRECT_SHADOW == SHADOW_SUN && light.kind == LIGHT_DIRECTIONAL)) {
            if (occluded(position_ws, normal_ws, incident.direction_ws, incident.distance)) {
                continue;
            }
        }
        precise vec3 received = incident.irradiance * cosine;
        sum += received;
    }
    precise vec3 weighted = sum * params.weight;
    return pack_halves(weighted, 0u);
}

#endif
