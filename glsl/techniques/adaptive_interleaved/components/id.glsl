// Indirect diffuse light (ID): virtual point lights in N x M subsets, each with a shadow ray. Dubla 2009, section 3.2
// and Listing 2. Host part: src/techniques/adaptive_interleaved/components/id.rs.
#ifndef ADAPTIVE_INTERLEAVED_ID_GLSL
#define ADAPTIVE_INTERLEAVED_ID_GLSL

#include "techniques/adaptive_interleaved/mean_guidance.glsl"

bool refines(float refine) {
    return refine > 0.0;
}

#ifdef ESTIMATES

layout(std430, set = 0, binding = 6) readonly buffer Sources { VplBlock vpls[]; };

bool is_estimated(Point point) {
    return point.has_surface;
}

// The ratio of virtual lights that something hides, of those that could light the point, is what guides.
void contribute(Point point, uint slot, uint iteration, inout Estimate estimate) {
    uint size = tile_size(params);
    // Each pixel of a tile has another subset in an iteration, and in its iterations each subset once.
    uint subset = (slot + iteration) % size;
    uint vpl = subset * params.source_count / size;
    uint end = (subset + 1u) * params.source_count / size;
    uint ray_count = 0u;
    uint missed_count = 0u;
    precise vec3 sum = vec3(0.0);
    for (; vpl < end; vpl++) {
        VplBlock light = vpls[vpl];
        vec3 received = vpl_irradiance(light, point.position_ws, point.normal_ws, params.least_squared);
        if (received != vec3(0.0)) {
            vec3 to_light = light.position_ws.xyz - point.position_ws;
            float distance = length(to_light);
            vec3 direction = to_light / max(distance, 1e-12);
            ray_count++;
            if (occluded(point.position_ws, point.normal_ws, direction, distance)) {
                missed_count++;
            } else {
                sum += received * passed_towards(params.medium, point.position_ws, direction, distance);
            }
        }
    }
    expect_done(vpl == end);
    // A subset stands for all N x M of them.
    precise vec3 scaled = sum * float(size);
    estimate.sum += scaled;
    estimate.information += ray_count > 0u ? float(missed_count) / float(ray_count) : 0.0;
    estimate.ray_count += ray_count;
}

// The mean of the iterations' ratios.
uint found_word(uint slot, Estimate estimate) {
    return floatBitsToUint(estimate.information / float(params.base));
}

#endif

#endif
