// Soft shadows (SS): light straight from area lights, one point of each an iteration, and from punctual lights, each
// point with a shadow ray. Dubla 2009, section 3.3 and Listing 3. Host part:
// src/techniques/adaptive_interleaved/components/ss.rs.
#ifndef ADAPTIVE_INTERLEAVED_SS_GLSL
#define ADAPTIVE_INTERLEAVED_SS_GLSL

// What the texels of a tile found together: the sum of their numbers; or, of a word with a bit for each light, bits that
// any has, and that all have, and how many are missing in all of them together.
struct Found {
    float sum;
    uint any;
    uint all;
    uint missing_count;
};

const Found NOTHING_FOUND = Found(0.0, 0u, 0xffffffffu, 0u);

// Lights that have a bit of their own in the word of a texel; more share them. One bit fewer than a word has: all of them
// together are not NOT_ESTIMATED.
const uint LIGHT_BITS = 31u;

// The bits that lights have.
uint light_bits(AdaptiveParams params) {
    return (1u << min(params.source_count + params.light_count, LIGHT_BITS)) - 1u;
}

void add_found(AdaptiveParams params, uint word, inout Found found) {
    if (params.guides_each != 0u) {
        found.any |= word;
        found.all &= word;
        found.missing_count += bitCount(~word & light_bits(params));
    } else {
        precise float sum = found.sum + uintBitsToFloat(word);
        found.sum = sum;
    }
}

// The mean of the numbers; with a bit for each light the part that is hidden of those lights alone that some texels
// meet and others do not.
float refine_of(AdaptiveParams params, Found found, uint texel_count) {
    if (params.guides_each == 0u) {
        return found.sum / float(texel_count);
    }
    uint bits = light_bits(params);
    uint parted_count = bitCount(found.any & ~found.all & bits);
    uint missing_count = found.missing_count - bitCount(~found.any & bits) * texel_count;
    return parted_count > 0u ? float(missing_count) / float(parted_count * texel_count) : 0.0;
}

// Wholly lit and wholly dark tiles have no penumbra.
bool refines(float refine) {
    return refine > 0.0 && refine < 1.0;
}

#ifdef ESTIMATES

#include "techniques/adaptive_interleaved/area_samples.glsl"

layout(std430, set = 0, binding = 7) readonly buffer Lights { LightBlock lights[]; };

bool is_estimated(Point point) {
    return point.has_surface;
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
        precise vec3 sum =
            estimate.sum + received * passed_towards(params.medium, point.position_ws, direction_ws, distance);
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
        vec3 received = area_irradiance(light, point.normal_ws, to_light);
        float distance = length(to_light);
        add_light(point, received, to_light / max(distance, 1e-12), distance, area, estimate, met);
    }
    expect_done(area == params.source_count);
    uint punctual = 0u;
    for (; punctual < params.light_count; punctual++) {
        Incident incident = incident_of(lights[punctual], punctual, point.position_ws, iteration * size + slot);
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

#endif
