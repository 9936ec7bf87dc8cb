// Irradiance at a surface point from one subset of the lights: virtual point lights, then punctual lights that were
// joined to the subsets (--direct interleaved). Every method of the split calls this one function, from compute shaders
// and from a fragment shader; where the irradiance goes is theirs.
//
// With the axis VPL_BRDF=ggx it is what the surface sends towards the eye, in the units of the irradiance: pi times the radiance over
// the colour of demodulation.glsl.
#ifndef INTERLEAVED_DEFERRED_IRRADIANCE_GLSL
#define INTERLEAVED_DEFERRED_IRRADIANCE_GLSL

#include "bvh.glsl"
#include "loops.glsl"
#include "shading/light.glsl"
#include "shading/subset.glsl"
#include "techniques/interleaved_deferred/shade/params.glsl"
#include "techniques/interleaved_deferred/vpl_shadow/hidden.glsl"
#ifdef VPL_BRDF_GGX
#include "techniques/interleaved_deferred/demodulation.glsl"
#endif

// Points that a thread shades.
layout(constant_id = 2) const uint TEXELS = 1;
layout(constant_id = 3) const uint DIRECT_SHADOW = 0;
// Whether punctual lights are joined to the subsets: even a loop that never iterates takes seconds to compile.
layout(constant_id = 5) const bool HAS_JOINED = true;

layout(push_constant) uniform Push { ShadeParams params; };
layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 1) readonly buffer Vpls { VplBlock vpls[]; };
layout(std430, set = 0, binding = 2) readonly buffer SubsetLights { LightBlock subset_lights[]; };
layout(std430, set = 0, binding = 3) readonly buffer Subsets { SubsetBlock subsets[]; };
layout(std430, set = 0, binding = 4) readonly buffer BvhNodes { BvhNodeBlock bvh_nodes[]; };
layout(std430, set = 0, binding = 5) readonly buffer BvhTriangles { BvhTriangleBlock bvh_triangles[]; };
#ifdef VPL_SHADOW_TESTED
layout(std430, set = 0, binding = 7) readonly buffer Hidden { uint hidden[]; };
#endif

#include "bvh_walk.glsl"

// What a thread shades with one reading of its light list: a light is read lane by lane on drivers that cannot know that
// all lanes read the same one, and that costs more than the arithmetic of one point.
vec3 point_position_ws[TEXELS];
vec3 point_normal_ws[TEXELS];
bool point_has_surface[TEXELS];
#ifdef VPL_BRDF_GGX
Surface point_surface[TEXELS];
vec3 point_eye_ws[TEXELS];
#endif
#ifdef VPL_SHADOW_TESTED
// Its first word of `hidden`.
uint point_hidden_at[TEXELS];
#endif
vec3 point_sum[TEXELS];
// Packed halves; all bits 0 without a surface.
uvec2 point_irradiance[TEXELS];

// Where a pixel's words of `hidden` are.
uint place_of_pixel(uvec2 pixel) {
    return linear_of(params.mapping, texel_of_pixel(params.mapping, pixel));
}

// The i-th point is the surface that these words of the G-buffer hold; none where `exists` is false. `place`: as
// `first_hidden_word`.
void set_point(uint i, bool exists, uvec2 normal_bits, POSITION_WORDS position, uvec2 pixel, uint place) {
#ifdef VPL_SHADOW_TESTED
    point_hidden_at[i] = first_hidden_word(place, params.words_a_point);
#endif
    point_has_surface[i] = exists && has_surface(normal_bits);
    point_normal_ws[i] = unpack_normal(normal_bits);
    point_position_ws[i] = unpack_position(frame, position, pixel);
}

#ifdef VPL_BRDF_GGX
// The i-th point's material, and where it is seen from; after `set_point`. `color`: as color_words of material_of_frame.glsl.
void set_material(uint i, uvec2 normal_bits, uvec2 color) {
    vec2 roughness_metallic = unpack_roughness_metallic(normal_bits);
    float f0 = SURFACE_EXTRAS != 0u ? f0_of_extras(last16(color)) : DEFAULT_DIELECTRIC_F0;
    point_surface[i] = Surface(unpack_halves(color), roughness_metallic.y, roughness_metallic.x, f0);
    point_eye_ws[i] = to_eye(frame, point_position_ws[i]);
}

// What the i-th point makes of irradiance from a direction, which is above its surface where that is not 0.
vec3 seen_of(vec3 received, vec3 to_light_ws, uint i) {
    precise vec3 reflected = brdf(BRDF_GGX, point_surface[i], point_normal_ws[i], to_light_ws, point_eye_ws[i]) * received;
    precise vec3 seen = PI * reflected / modulus_of(point_surface[i]);
    return seen;
}
#endif

bool has_any_surface() {
    bool any_surface = false;
    for (uint i = 0u; i < TEXELS; i++) {
        any_surface = any_surface || point_has_surface[i];
    }
    return any_surface;
}

bool is_shadowed(LightBlock light, Incident incident, uint i) {
    bool casts = DIRECT_SHADOW == SHADOW_RAY || (DIRECT_SHADOW == SHADOW_SUN && is_directional(light));
    return casts && occluded(point_position_ws[i], point_normal_ws[i], incident.direction_ws, incident.distance);
}

void add_to(uint i, vec3 received) {
    precise vec3 sum = point_sum[i] + received;
    point_sum[i] = sum;
}

vec3 received_from(VplBlock vpl, uint i) {
    vec3 received = vpl_irradiance(vpl, point_position_ws[i], point_normal_ws[i], params.least_squared);
#ifdef VPL_BRDF_GGX
    float distance;
    received = seen_of(received, towards_vpl(vpl, point_position_ws[i], distance), i);
#endif
    return received;
}

// Adds to each point what it receives from a subset's lights from `first` to `end`, of those that it sees where that was tested.
#ifdef VPL_SHADOW_TESTED
void add_vpls(uint first, uint end) {
    // The pass that has looked may have been cut short, too.
    expect_done(hidden[0] == 0u);
    uint vpl_index = first;
    for (uint word = 0u; vpl_index < end; word++) {
        uint words[TEXELS];
        for (uint i = 0u; i < TEXELS; i++) {
            words[i] = point_has_surface[i] ? hidden[point_hidden_at[i] + word] : 0u;
        }
        uint word_first = vpl_index;
        for (; vpl_index < min(end, word_first + LIGHTS_A_WORD); vpl_index++) {
            VplBlock vpl = vpls[vpl_index];
            for (uint i = 0u; i < TEXELS; i++) {
                vec3 received = received_from(vpl, i);
                add_to(i, (words[i] >> (vpl_index - word_first) & 1u) == 0u ? received : vec3(0.0));
            }
        }
    }
    expect_done(vpl_index == end);
}
#else
void add_vpls(uint first, uint end) {
    uint vpl_index = first;
    for (; vpl_index < end; vpl_index++) {
        VplBlock vpl = vpls[vpl_index];
        for (uint i = 0u; i < TEXELS; i++) {
            add_to(i, received_from(vpl, i));
        }
    }
    expect_done(vpl_index == end);
}
#endif

// Each point's irradiance from all lights of `subset`, in the order of the lists, rounded to halves once.
void shade_points(SubsetBlock subset) {
    for (uint i = 0u; i < TEXELS; i++) {
        point_sum[i] = vec3(0.0);
    }
    bool is_lit = has_any_surface();
    uint vpl_end = is_lit ? subset.vpl_first + subset.vpl_count : 0u;
    add_vpls(min(subset.vpl_first, vpl_end), vpl_end);
    // Before the punctual lights join: both factors are whole, and with one pattern for both kinds this one is 1 and keeps
    // the bits of the one sum.
    for (uint i = 0u; i < TEXELS; i++) {
        point_sum[i] *= params.cluster_size;
    }
    uint light_end = HAS_JOINED && is_lit ? subset.light_first + subset.light_count : 0u;
    uint light_index = min(subset.light_first, light_end);
    for (; light_index < light_end; light_index++) {
        LightBlock light = subset_lights[light_index];
        uint i = 0u;
        for (; i < TEXELS; i++) {
            Incident incident = incident_from(light, point_position_ws[i]);
            precise float cosine = dot(point_normal_ws[i], incident.direction_ws);
            bool faces = point_has_surface[i] && cosine > 0.0 && incident.irradiance != vec3(0.0);
            if (faces && !is_shadowed(light, incident, i)) {
                precise vec3 received = incident.irradiance * cosine;
#ifdef VPL_BRDF_GGX
                received = seen_of(received, incident.direction_ws, i);
#endif
                add_to(i, received);
            }
        }
        expect_done(i == TEXELS);
    }
    expect_done(light_index == light_end);
    for (uint i = 0u; i < TEXELS; i++) {
        precise vec3 weighted = nan_if_cut(point_sum[i] * params.weight);
        point_irradiance[i] = point_has_surface[i] ? pack_halves(weighted, 0u) : uvec2(0u);
    }
}

#endif
