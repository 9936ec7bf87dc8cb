// Airlight (PM): light of area lights and punctual lights that a medium scatters once, into the ray that is seen, by a
// march along it whose steps are interleaved over the pixels of a tile. Dubla 2009, section 3.4 and Listing 4. Host
// part: src/techniques/adaptive_interleaved/components/pm.rs.
#ifndef ADAPTIVE_INTERLEAVED_PM_GLSL
#define ADAPTIVE_INTERLEAVED_PM_GLSL

// The number of the texel before, and how many texels of the tile have another than the one before them.
struct Found {
    float previous;
    uint different_count;
};

// No number: the first texel is compared with none.
const Found NOTHING_FOUND = Found(-1.0, 0u);

// Numbers are parts of few steps and lights: what is nearer than this is the same, whatever rounding made of it.
const float SAME_NUMBER = 0.0000152587890625;

void add_found(AdaptiveParams params, uint word, inout Found found) {
    float number = uintBitsToFloat(word);
    if (found.previous >= 0.0 && abs(number - found.previous) > SAME_NUMBER) {
        found.different_count++;
    }
    found.previous = number;
}

float refine_of(AdaptiveParams params, Found found, uint texel_count) {
    return float(found.different_count) / float(texel_count);
}

bool refines(float refine) {
    return refine > 0.0;
}

#ifdef ESTIMATES

#include "shading/medium.glsl"
#include "techniques/adaptive_interleaved/area_samples.glsl"

layout(std430, set = 0, binding = 7) readonly buffer Lights { LightBlock lights[]; };

// The medium is seen beside surfaces too.
bool is_estimated(Point point) {
    return true;
}

// Which part of a pixel's stretch of a step an iteration has: the middle first, then those beside it in turns, so that
// few iterations lean to neither end.
uint part_of_stretch(uint iteration) {
    uint middle = params.most / 2u;
    uint away = (iteration + 1u) / 2u;
    return iteration % 2u == 1u ? middle - away : middle + away;
}

// Where the pixel's places lie in a step, 0 to 1: none is that of another pixel of the tile, or of another iteration.
float offset_in_step(uint slot, uint iteration) {
    float part = (float(part_of_stretch(iteration)) + 0.5) / float(params.most);
    return (float(slot) + part) / float(tile_size(params));
}

// What a place of the march meets.
struct Met {
    // Radiance that it scatters to the eye, over the medium's coefficient.
    vec3 scattered;
    // Lights that something hides, or that shine elsewhere.
    uint missed_count;
    bool is_in_halo;
};

void add_scattered(
    vec3 place_ws,
    vec3 seen_along,
    vec3 irradiance,
    vec3 direction_ws,
    float distance,
    inout Estimate estimate,
    inout Met met
) {
    met.is_in_halo = met.is_in_halo || distance < params.halo;
    if (irradiance == vec3(0.0)) {
        met.missed_count++;
        return;
    }
    estimate.ray_count++;
    // There is no surface that the ray would have to leave.
    if (occluded(place_ws, vec3(0.0), direction_ws, distance)) {
        met.missed_count++;
        return;
    }
    float turned = phase(params.medium.asymmetry, dot(direction_ws, seen_along));
    met.scattered += irradiance * (turned * passed_towards(params.medium, place_ws, direction_ws, distance));
}

// `place`: which of the march's it is. Points of an area light are the pixel's own at each place, and over the places
// all of its points in turn.
Met met_at(vec3 place_ws, vec3 seen_along, uint place, uint own, inout Estimate estimate) {
    Met met = Met(vec3(0.0), 0u, false);
    uint point_count = params.most * tile_size(params);
    uint area = 0u;
    for (; area < params.source_count; area++) {
        AreaSampleBlock light = area_samples[area * point_count + (own + place) % point_count];
        vec3 to_light = light.position_ws.xyz - place_ws;
        float distance = length(to_light);
        vec3 irradiance = facing_irradiance(light, to_light);
        add_scattered(place_ws, seen_along, irradiance, to_light / max(distance, 1e-12), distance, estimate, met);
    }
    expect_done(area == params.source_count);
    uint punctual = 0u;
    for (; punctual < params.light_count; punctual++) {
        Incident light = incident_of(lights[punctual], punctual, place_ws, (own + place) % point_count);
        add_scattered(place_ws, seen_along, light.irradiance, light.direction_ws, light.distance, estimate, met);
    }
    expect_done(punctual == params.light_count);
    return met;
}

// Both numbers of Listing 4 as one: the part of the lights and places that is hidden, and the part of the places in a
// halo, each where it is neither none nor all; their mean where both are.
float combined(float missed_part, float halo_part) {
    float sum = 0.0;
    float count = 0.0;
    if (missed_part > 0.0 && missed_part < 1.0) {
        sum += missed_part;
        count += 1.0;
    }
    if (halo_part > 0.0 && halo_part < 1.0) {
        sum += halo_part;
        count += 1.0;
    }
    return sum / max(count, 1.0);
}

void contribute(Point point, uint slot, uint iteration, inout Estimate estimate) {
    ViewRay ray = view_ray(frame, vec2(point.pixel) + 0.5);
    float seen = point.has_surface ? dot(point.position_ws - ray.origin, ray.direction) : ray.limit;
    vec2 ends = in_medium(params.medium, ray.origin, ray.direction, -ray.behind, seen);
    float offset = offset_in_step(slot, iteration);
    uint own = iteration * tile_size(params) + slot;
    uint light_count = params.source_count + params.light_count;
    uint place_count = uint(max(ceil((ends.y - ends.x) / params.march_step - offset), 0.0));
    uint missed_count = 0u;
    uint halo_count = 0u;
    precise vec3 sum = vec3(0.0);
    uint place = 0u;
    for (; place < place_count; place++) {
        float advanced = (float(place) + offset) * params.march_step;
        vec3 place_ws = ray.origin + ray.direction * (ends.x + advanced);
        Met met = met_at(place_ws, ray.direction, place, own, estimate);
        sum += met.scattered * exp(-params.medium.extinction * advanced);
        missed_count += met.missed_count;
        halo_count += met.is_in_halo ? 1u : 0u;
    }
    expect_done(place == place_count);
    precise vec3 scaled = sum * (params.medium.scattering * params.march_step);
    estimate.sum += scaled;
    if (place_count > 0u) {
        float missed_part = float(missed_count) / float(place_count * light_count);
        estimate.information += combined(missed_part, float(halo_count) / float(place_count));
    }
}

// The mean of the iterations' numbers.
uint found_word(uint slot, Estimate estimate) {
    return floatBitsToUint(estimate.information / float(params.base));
}

#endif

#endif
