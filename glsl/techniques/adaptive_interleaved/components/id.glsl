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

// 1: lights are drawn by contribution (--id-choice).
layout(constant_id = 9) const uint BY_CONTRIBUTION = 0;

// What one iteration met.
struct Met {
    uint ray_count;
    uint missed_count;
};

// What arrives of `received` from a virtual light.
vec3 arriving(Point point, VplBlock light, vec3 received, inout Met met) {
    float distance;
    vec3 direction = towards_vpl(light, point.position_ws, distance);
    met.ray_count++;
    if (occluded(point.position_ws, point.normal_ws, direction, distance)) {
        met.missed_count++;
        return vec3(0.0);
    }
    return received * passed_towards(params.medium, point.position_ws, direction, distance);
}

vec3 unhidden(Point point, uint vpl) {
    return vpl_irradiance(vpls[vpl], point.position_ws, point.normal_ws, params.least_squared);
}

// Light of the subset's stretch `vpl` to `end`; it stands for all N x M of them.
vec3 light_of_subset(Point point, uint vpl, uint end, inout Met met) {
    precise vec3 sum = vec3(0.0);
    for (; vpl < end; vpl++) {
        vec3 received = unhidden(point, vpl);
        if (received != vec3(0.0)) {
            sum += arriving(point, vpls[vpl], received, met);
        }
    }
    expect_done(vpl == end);
    precise vec3 scaled = sum * float(tile_size(params));
    return scaled;
}

// The same by as many rays at most, to lights drawn evenly over the sum of what all would give: `part`, 0 to 1, is where
// the pixel begins, and no other of its tile or its iterations begins there.
vec3 light_of_drawn(Point point, uint first, uint end, float part, inout Met met) {
    float all = 0.0;
    uint look_count = 0u;
    uint vpl = 0u;
    for (; vpl < params.source_count; vpl++) {
        float weight = dot(unhidden(point, vpl), LUMINANCE);
        all += weight;
        look_count += weight > 0.0 && vpl >= first && vpl < end ? 1u : 0u;
    }
    expect_done(vpl == params.source_count);
    // A subset may be the only one that does not light the point.
    float step = all / float(max(look_count, 1u));
    if (!(step > 0.0)) {
        return vec3(0.0);
    }
    precise vec3 sum = vec3(0.0);
    float before = 0.0;
    float drawn = 0.0;
    for (vpl = 0u; vpl < params.source_count; vpl++) {
        vec3 received = unhidden(point, vpl);
        float weight = dot(received, LUMINANCE);
        before += weight;
        // Places part, part + 1, ... of a step each that lie below the sum.
        float reached = max(ceil(before / step - part), drawn);
        if (reached > drawn && weight > 0.0) {
            sum += arriving(point, vpls[vpl], received * ((reached - drawn) * step / weight), met);
        }
        drawn = reached;
    }
    expect_done(vpl == params.source_count);
    return sum;
}

// The ratio of virtual lights that something hides, of those that could light the point, is what guides.
void contribute(Point point, uint slot, uint iteration, inout Estimate estimate) {
    uint size = tile_size(params);
    // Each pixel of a tile has another subset in an iteration, and in its iterations each subset once.
    uint subset = (slot + iteration) % size;
    uint first = subset * params.source_count / size;
    uint end = (subset + 1u) * params.source_count / size;
    Met met = Met(0u, 0u);
    vec3 light;
    if (BY_CONTRIBUTION == 0u) {
        light = light_of_subset(point, first, end, met);
    } else {
        float part = (float(slot) + (float(iteration) + 0.5) / float(params.most)) / float(size);
        light = light_of_drawn(point, first, end, part, met);
    }
    precise vec3 sum = estimate.sum + light;
    estimate.sum = sum;
    estimate.information += met.ray_count > 0u ? float(met.missed_count) / float(met.ray_count) : 0.0;
    estimate.ray_count += met.ray_count;
}

// The mean of the iterations' ratios.
uint found_word(uint slot, Estimate estimate) {
    return floatBitsToUint(estimate.information / float(params.base));
}

#endif

#endif
