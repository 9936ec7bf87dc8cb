// The L-buffer at a fragment, from the four samples around it: those of its surface by the discontinuity sensitive filter
// (Kircher 2009, section 3), or by what other papers distinguish surfaces by. Of alpha surfaces, section 4, the samples
// are one texel of each cell of a stipple. With GUIDE=normals the including shader declares `frame`; its axis LIGHT=words|sampled
// says how the L-buffer is read. The shader's head says `// spirv: 1.5`, in which gl_HelperInvocation can be read everywhere
// (docs/drivers.md).
#ifndef INFERRED_LIGHTING_LIGHT_FILTER_GLSL
#define INFERRED_LIGHTING_LIGHT_FILTER_GLSL

#include "techniques/inferred_lighting/encoding.glsl"
#include "techniques/inferred_lighting/l_buffer.glsl"

#ifdef LIGHT_SAMPLED
// Its channels, which the sampler can blend.
layout(set = 0, binding = 40) uniform sampler2D l_buffer;
#else
// Its words.
layout(set = 0, binding = 40) uniform usampler2D l_buffer;
#endif
layout(set = 0, binding = 41) uniform usampler2D geometry_dsf;
#ifdef GUIDE_NORMALS
layout(set = 0, binding = 42) uniform usampler2D geometry_normal;
#endif

// FILTER_: --light-filter.
layout(constant_id = 6) const uint LIGHT_FILTER = 1;
// Radius of the cone filter of alpha surfaces in texels of the light buffer; 0: they too are filtered bilinearly.
layout(constant_id = 7) const float CONE_RADIUS = 0.0;
// Rings of texels beyond the four in which a surface looks for its own where none of those is: 0 or 1.
layout(constant_id = 8) const uint RINGS = 1;
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
    // Samples of any object are its, at its depth.
    bool is_decal;
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
    Lighting lighting;
    // Nothing that was looked at belongs to the surface.
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
    bool is_same = query.is_decal || word >> 16 == query.id;
    return is_same && abs(depth_m - query.depth_m) <= query.threshold_m ? 1.0 : 0.0;
#endif
}

// Texel of the surface's lattice at whole coordinates `at`.
ivec2 lattice_texel(LightQuery query, ivec2 at, ivec2 last, ivec2 extent) {
    return min(clamp(at, ivec2(0), last) * query.spacing + query.offset, extent - 1);
}

Lighting lighting_at(ivec2 texel) {
#ifdef LIGHT_SAMPLED
    return lighting_of(texelFetch(l_buffer, texel, 0));
#else
    return unpack_lighting(texelFetch(l_buffer, texel, 0).rg);
#endif
}

// Adds a part of one to another.
void add_part(inout Lighting sum, Lighting part, float weight) {
    sum.irradiance += part.irradiance * weight;
    sum.highlight += part.highlight * weight;
}

// What belongs to the surface of the 12 texels of its lattice around the four, nearer ones more: a tent twice as wide as theirs.
// `weight_sum` is 0 where nothing does, and where the surface `is_needless`.
//
// Why a loop that begins at its end: software drivers run a branch that no lane takes, and leave a loop that none enters. As a
// branch this added a third to a frame, and as a loop that helper invocations enter nearly as much.
Lighting ring_light(
    LightQuery query, bool is_needless, ivec2 base, vec2 fraction, ivec2 last, ivec2 extent, out float weight_sum
) {
    Lighting sum = Lighting(vec3(0.0), vec3(0.0));
    weight_sum = 0.0;
    for (int i = is_needless ? 16 : 0; i < 16; i++) {
        ivec2 away = ivec2(i & 3, i >> 2) - 1;
        bool is_inner = (away.x == 0 || away.x == 1) && (away.y == 0 || away.y == 1);
        ivec2 texel = lattice_texel(query, base + away, last, extent);
        float belonging = is_inner ? 0.0 : belonging_of(query, texel);
        if (belonging > 0.0) {
            vec2 tent = max(1.0 - 0.5 * abs(vec2(away) - fraction), vec2(1e-3));
            float weight = belonging * tent.x * tent.y;
            add_part(sum, lighting_at(texel), weight);
            weight_sum += weight;
        }
    }
    return sum;
}

FilteredLight filtered_light(LightQuery query) {
    ivec2 extent = textureSize(geometry_dsf, 0);
    // The lattice of the surface's samples.
    ivec2 last = max((extent - 1 - query.offset) / query.spacing, ivec2(0));
    vec2 place = (query.at - 0.5 - vec2(query.offset)) / float(query.spacing);
    ivec2 base = ivec2(floor(place));
    vec2 fraction = place - vec2(base);
    ivec2 texels[4];
    vec4 belonging = vec4(0.0);
    vec4 bilinear = vec4(0.0);
    vec4 weights = vec4(0.0);
    for (int i = 0; i < 4; i++) {
        ivec2 corner = ivec2(i & 1, i >> 1);
        texels[i] = lattice_texel(query, base + corner, last, extent);
        belonging[i] = belonging_of(query, texels[i]);
        vec2 near = mix(1.0 - fraction, fraction, vec2(corner));
        if (LIGHT_FILTER == FILTER_NEAREST) {
            near = mix(1.0 - step(0.5, fraction), step(0.5, fraction), vec2(corner));
        }
        bilinear[i] = near.x * near.y;
        float weight = bilinear[i];
        if (query.spacing > 1 && CONE_RADIUS > 0.0) {
            float away = length((1.0 - near) * float(query.spacing));
            weight = max(1.0 - away / CONE_RADIUS, 0.0);
        }
        weights[i] = belonging[i] * weight;
    }
#ifdef LIGHT_SAMPLED
    if (query.spacing == 1 && belonging == vec4(1.0)) {
        return FilteredLight(lighting_of(textureLod(l_buffer, query.at / vec2(extent), 0.0)), false);
    }
#endif
    float weight_sum = dot(weights, vec4(1.0));
    bool is_rejected = false;
    if (!(weight_sum > 0.0)) {
        // Those that belong lie where the filter has no weight left; or none belongs.
        float belonging_sum = dot(belonging, vec4(1.0));
        is_rejected = !(belonging_sum > 0.0);
        weights = is_rejected ? bilinear : belonging;
        weight_sum = is_rejected ? 1.0 : belonging_sum;
    }
    if (RINGS != 0u) {
        float ring_sum;
        Lighting ring = ring_light(query, !is_rejected || gl_HelperInvocation, base, fraction, last, extent, ring_sum);
        if (ring_sum > 0.0) {
            return FilteredLight(Lighting(ring.irradiance / ring_sum, ring.highlight / ring_sum), false);
        }
    }
    Lighting sum = Lighting(vec3(0.0), vec3(0.0));
    for (int i = 0; i < 4; i++) {
        // What has no weight may be anything, and that times 0 no number.
        if (weights[i] > 0.0) {
            add_part(sum, lighting_at(texels[i]), weights[i] / weight_sum);
        }
    }
    return FilteredLight(sum, is_rejected);
}

#endif
