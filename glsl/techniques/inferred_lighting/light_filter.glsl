// The L-buffer at a fragment, from the four samples around it: those of its surface by the discontinuity sensitive filter
// (Kircher 2009, section 3), or by what other papers distinguish surfaces by. Of alpha surfaces, section 4, the samples
// are one texel of each cell of a stipple. With GUIDE=normals the including shader declares `frame`.
#ifndef INFERRED_LIGHTING_LIGHT_FILTER_GLSL
#define INFERRED_LIGHTING_LIGHT_FILTER_GLSL

#include "techniques/inferred_lighting/encoding.glsl"

layout(set = 0, binding = 40) uniform sampler2D l_buffer;
layout(set = 0, binding = 41) uniform usampler2D geometry_dsf;
#ifdef GUIDE_NORMALS
layout(set = 0, binding = 42) uniform usampler2D geometry_normal;
#endif

// FILTER_: --light-filter.
layout(constant_id = 6) const uint LIGHT_FILTER = 1;
// Radius of the cone filter of alpha surfaces in texels of the light buffer; 0: they too are filtered bilinearly.
layout(constant_id = 7) const float CONE_RADIUS = 0.0;
// 1: where all four samples belong to a solid surface, the sampler blends them.
layout(constant_id = 8) const uint SAMPLER_BLENDS = 0;
// GUIDE=normals: most that 1 - cos between two normals of one surface may be.
layout(constant_id = 9) const float NORMAL_THRESHOLD = 0.3;

// Whatever the samples belong to.
const uint FILTER_BILINEAR = 0u;
// By ids and depth.
const uint FILTER_DSF = 1u;
// The nearest sample alone.
const uint FILTER_NEAREST = 2u;
// Weights that fall off with the angle between the normals and the distance from the tangent plane (Kopf et al. 2007).
const uint FILTER_BILATERAL = 3u;
// By angle and distance, yes or no (Segovia 2006, section 4.5).
const uint FILTER_DISCONTINUITY = 4u;

// What the filter reads of its surface.
struct LightQuery {
    // In texels of the light buffer; its middle is half a texel in.
    vec2 at;
    // The object's and the normal group's.
    uint id;
    float depth_m;
    // How far a sample's depth may be off, or its place off the tangent plane.
    float threshold_m;
    // First step and all of the linear depth.
    vec2 range_m;
    // One sample in this many along both axes, beginning at `offset`.
    int spacing;
    ivec2 offset;
    // Read with GUIDE=normals.
    vec3 position_ws;
    vec3 normal_ws;
};

struct FilteredLight {
    vec4 lighting;
    // None of the four belongs to the surface.
    bool is_rejected;
};

#ifdef GUIDE_NORMALS
vec3 sample_position(ivec2 texel, float depth_m) {
    vec2 ndc = (vec2(texel) + 0.5) / vec2(textureSize(geometry_dsf, 0)) * 2.0 - 1.0;
    vec4 near = frame.world_from_clip * vec4(ndc, 1.0, 1.0);
    vec3 start = near.xyz / near.w;
    float start_m = linear_depth(frame, start);
    vec3 eye_ws = frame.eye_ws.xyz;
    return frame.eye_ws.w > 0.0 ? eye_ws + (start - eye_ws) * (depth_m / start_m)
                                : start + frame.forward_ws.xyz * (depth_m - start_m);
}

float alikeness(LightQuery query, ivec2 texel, float depth_m) {
    vec3 normal_vs = unpack_view_normal(texelFetch(geometry_normal, texel, 0).r);
    float turn = 1.0 - dot(world_from_view(frame, normal_vs), query.normal_ws);
    float off = abs(dot(query.normal_ws, sample_position(texel, depth_m) - query.position_ws));
    if (LIGHT_FILTER == FILTER_DISCONTINUITY) {
        return turn <= NORMAL_THRESHOLD && off <= query.threshold_m ? 1.0 : 0.0;
    }
    vec2 far = vec2(turn / max(NORMAL_THRESHOLD, 1e-6), off / query.threshold_m);
    float weight = exp(-dot(far, far));
    // What weighs less than this says nothing, and four such samples say noise.
    return weight < 1e-4 ? 0.0 : weight;
}
#endif

// How far a sample belongs to the surface, 0 to 1.
float belonging_of(LightQuery query, ivec2 texel) {
    if (LIGHT_FILTER == FILTER_BILINEAR) {
        return 1.0;
    }
    if (LIGHT_FILTER == FILTER_NEAREST) {
        return 1.0;
    }
    uint word = texelFetch(geometry_dsf, texel, 0).r;
    if (!dsf_has_surface(word)) {
        return 0.0;
    }
    float depth_m = depth_of_dsf(word, query.range_m);
#ifdef GUIDE_NORMALS
    return alikeness(query, texel, depth_m);
#else
    return word >> 16 == query.id && abs(depth_m - query.depth_m) <= query.threshold_m ? 1.0 : 0.0;
#endif
}

FilteredLight filtered_light(LightQuery query) {
    ivec2 extent = textureSize(geometry_dsf, 0);
    // The lattice of the surface's samples.
    ivec2 last = max((extent - 1 - query.offset) / query.spacing, ivec2(0));
    vec2 place = (query.at - 0.5 - vec2(query.offset)) / float(query.spacing);
    vec2 base = floor(place);
    vec2 fraction = place - base;
    ivec2 texels[4];
    vec4 belonging = vec4(0.0);
    for (int i = 0; i < 4; i++) {
        ivec2 corner = ivec2(i & 1, i >> 1);
        texels[i] = min(clamp(ivec2(base) + corner, ivec2(0), last) * query.spacing + query.offset, extent - 1);
        belonging[i] = belonging_of(query, texels[i]);
    }
    if (SAMPLER_BLENDS != 0u) {
        if (query.spacing == 1 && belonging == vec4(1.0)) {
            return FilteredLight(textureLod(l_buffer, query.at / vec2(extent), 0.0), false);
        }
    }
    vec4 weighted = vec4(0.0);
    float weight_sum = 0.0;
    vec4 plain = vec4(0.0);
    vec4 unweighted = vec4(0.0);
    float belonging_sum = 0.0;
    for (int i = 0; i < 4; i++) {
        vec2 near = mix(1.0 - fraction, fraction, vec2(i & 1, i >> 1));
        if (LIGHT_FILTER == FILTER_NEAREST) {
            near = mix(1.0 - step(0.5, fraction), step(0.5, fraction), vec2(i & 1, i >> 1));
        }
        float bilinear = near.x * near.y;
        float weight = bilinear;
        if (query.spacing > 1 && CONE_RADIUS > 0.0) {
            float away = length((1.0 - near) * float(query.spacing));
            weight = max(1.0 - away / CONE_RADIUS, 0.0);
        }
        vec4 lighting = texelFetch(l_buffer, texels[i], 0);
        plain += lighting * bilinear;
        if (belonging[i] > 0.0) {
            weight *= belonging[i];
            weighted += lighting * weight;
            weight_sum += weight;
            unweighted += lighting * belonging[i];
            belonging_sum += belonging[i];
        }
    }
    if (weight_sum > 0.0) {
        return FilteredLight(weighted / weight_sum, false);
    }
    // Those that belong lie where the filter has no weight left.
    if (belonging_sum > 0.0) {
        return FilteredLight(unweighted / belonging_sum, false);
    }
    return FilteredLight(plain, true);
}

#endif
