// Ambient occlusion (AO): light from all around that no surface stops, a ray an iteration. The fourth component, which
// Dubla 2009, section 3, leaves to others: guided as its soft shadows are. Host part:
// src/techniques/adaptive_interleaved/components/ao.rs.
#ifndef ADAPTIVE_INTERLEAVED_AO_GLSL
#define ADAPTIVE_INTERLEAVED_AO_GLSL

#include "techniques/adaptive_interleaved/mean_guidance.glsl"

// Where nothing is stopped, and where all is, further rays would find the same.
bool refines(float refine) {
    return refine > 0.0 && refine < 1.0;
}

#ifdef ESTIMATES

#include "shading/scatter.glsl"

// xyz: unit vectors around z, as dense as their cosine with it. Those of an iteration lie together, one for each pixel of
// a tile.
layout(std430, set = 0, binding = 6) readonly buffer Sources { vec4 directions[]; };

bool is_estimated(Point point) {
    return point.has_surface;
}

void contribute(Point point, uint slot, uint iteration, inout Estimate estimate) {
    vec3 direction = around(point.normal_ws, directions[iteration * tile_size(params) + slot].xyz);
    estimate.ray_count++;
    if (occluded(point.position_ws, point.normal_ws, direction, FAR)) {
        estimate.information += 1.0;
        return;
    }
    float passed = passed_towards(params.medium, point.position_ws, direction, FAR);
    precise vec3 sum = estimate.sum + frame.ambient.rgb * (PI * passed);
    estimate.sum = sum;
}

// The part of the iterations' rays that was stopped.
uint found_word(uint slot, Estimate estimate) {
    return floatBitsToUint(estimate.information / float(params.base));
}

#endif

#endif
