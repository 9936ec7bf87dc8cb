// The discontinuity sensitive filter: the L-buffer at a fragment, from the nearest four samples that belong to its surface.
// Kircher 2009, section 3; for alpha surfaces, whose samples are one texel of each cell of a stipple, section 4. Twin:
// src/techniques/inferred_lighting/dsf.rs.
#ifndef INFERRED_LIGHTING_DSF_GLSL
#define INFERRED_LIGHTING_DSF_GLSL

#include "techniques/inferred_lighting/encoding.glsl"

layout(set = 0, binding = 40) uniform sampler2D l_buffer;
layout(set = 0, binding = 41) uniform usampler2D geometry_dsf;

// 0: bilinear filtering, whatever the samples belong to.
layout(constant_id = 6) const uint DSF = 1;
// Radius of the cone filter of alpha surfaces in texels of the light buffer; 0: they too are filtered bilinearly.
layout(constant_id = 7) const float CONE_RADIUS = 0.0;

// What the filter reads of its surface.
struct DsfQuery {
    // In texels of the light buffer; its middle is half a texel in.
    vec2 at;
    // The object's and the normal group's.
    uint id;
    float depth_m;
    // How far a sample's depth may be off.
    float threshold_m;
    // First step and all of the linear depth.
    vec2 range_m;
    // One sample in this many along both axes, beginning at `offset`.
    int spacing;
    ivec2 offset;
};

struct DsfResult {
    vec4 lighting;
    // None of the four belongs to the surface.
    bool is_rejected;
};

DsfResult filtered_lighting(DsfQuery query) {
    ivec2 extent = textureSize(geometry_dsf, 0);
    // The lattice of the surface's samples.
    ivec2 last = max((extent - 1 - query.offset) / query.spacing, ivec2(0));
    vec2 place = (query.at - 0.5 - vec2(query.offset)) / float(query.spacing);
    vec2 base = floor(place);
    vec2 fraction = place - base;
    vec4 weighted = vec4(0.0);
    float weight_sum = 0.0;
    vec4 plain = vec4(0.0);
    vec4 belonging = vec4(0.0);
    float belonging_count = 0.0;
    for (int i = 0; i < 4; i++) {
        ivec2 corner = ivec2(i & 1, i >> 1);
        ivec2 texel = min(clamp(ivec2(base) + corner, ivec2(0), last) * query.spacing + query.offset, extent - 1);
        vec2 near = mix(1.0 - fraction, fraction, vec2(corner));
        float bilinear = near.x * near.y;
        float weight = bilinear;
        if (query.spacing > 1 && CONE_RADIUS > 0.0) {
            float away = length((1.0 - near) * float(query.spacing));
            weight = max(1.0 - away / CONE_RADIUS, 0.0);
        }
        uint word = texelFetch(geometry_dsf, texel, 0).r;
        vec4 lighting = texelFetch(l_buffer, texel, 0);
        bool belongs = DSF == 0u
            || (dsf_has_surface(word) && word >> 16 == query.id
                && abs(depth_of_dsf(word, query.range_m) - query.depth_m) <= query.threshold_m);
        plain += lighting * bilinear;
        if (belongs) {
            weighted += lighting * weight;
            weight_sum += weight;
            belonging += lighting;
            belonging_count += 1.0;
        }
    }
    if (weight_sum > 0.0) {
        return DsfResult(weighted / weight_sum, false);
    }
    // Those that belong lie where the filter has no weight left.
    if (belonging_count > 0.0) {
        return DsfResult(belonging / belonging_count, false);
    }
    return DsfResult(plain, true);
}

#endif
