// The material pass: full materials, lit by the L-buffer through a filter that distinguishes surfaces. Kircher 2009,
// sections 2.3, 3, 4. Pass: src/techniques/inferred_lighting/material.rs.
// variants: ALPHA=opaque|mask|blend VERTEX=plain|extended GUIDE=ids|normals LIGHT=words|sampled COUNT=off|on SHADED=pixel|sample
// spirv: 1.5
#version 460
#include "frame.glsl"
#include "resident.glsl"
#include "shading/brdf.glsl"
#include "nan.glsl"
#include "shading/sample.glsl"

struct InferredMaterialParams {
    // The draw's.
    MaterialBlock material;
    // Linear depth: the first step, and all of them.
    float first_depth_m;
    float depth_range_m;
    // Part of its depth by which a sample's may be off.
    float depth_threshold;
    // Texels of the light buffer a pixel.
    float light_scale_x;
    float light_scale_y;
    // BLEND: side of the stipple, and which of its texels are the draw's, row-major; 1 and 0: every texel; 0 and 0: the same, of
    // whatever the decal lies on.
    uint stipple_side;
    uint stipple_layer;
};

// What is hidden writes no counters.
#ifndef ALPHA_MASK
layout(early_fragment_tests) in;
#endif

layout(constant_id = 2) const uint BRDF_KIND = 2;

layout(push_constant) uniform Push { InferredMaterialParams params; };
layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
#ifdef VERTEX_EXTENDED
layout(std430, set = 0, binding = 8) readonly buffer Placements { PlacementBlock placements[]; };
#endif
#ifdef COUNT_ON
// Fragments of solid surfaces, and of BLEND ones, that no sample belonged to.
layout(std430, set = 0, binding = 2) buffer Rejections { uint rejected_counts[2]; };
#endif

#include "shading/material.glsl"
#include "techniques/inferred_lighting/light_filter.glsl"
#include "techniques/inferred_lighting/highlight.glsl"

layout(location = 0) out vec4 out_color;

Lighting lighting_here(MaterialBlock material) {
    float depth_m = linear_depth(frame, in_position_ws);
    int side = int(params.stipple_side);
    LightQuery query;
    query.at = gl_FragCoord.xy * vec2(params.light_scale_x, params.light_scale_y);
    query.id = fixed_code(in_ids.y);
    query.depth_m = depth_m;
    query.range_m = vec2(params.first_depth_m, params.depth_range_m);
    query.threshold_m = depth_slack_m(depth_m, params.depth_threshold, query.range_m);
    query.spacing = max(side, 1);
    query.offset = ivec2(int(params.stipple_layer) % query.spacing, int(params.stipple_layer) / query.spacing);
#ifdef ALPHA_BLEND
    query.is_decal = side == 0;
#else
    query.is_decal = false;
#endif
#ifdef GUIDE_NORMALS
    query.position_ws = in_position_ws;
    query.normal_ws = normal_at(material, to_eye(frame, in_position_ws));
#endif
    FilteredLight result = filtered_light(query);
#ifdef COUNT_ON
    if (result.is_rejected) {
#ifdef ALPHA_BLEND
        atomicAdd(rejected_counts[1], 1u);
#else
        atomicAdd(rejected_counts[0], 1u);
#endif
    }
#endif
#ifdef LIGHT_SAMPLED
    // A sum that a driver has cut (loops.glsl) fails the picture in fixed point too, which has no NaN for a sampler to blend.
    ivec2 nearest = clamp(ivec2(query.at), ivec2(0), textureSize(l_buffer, 0) - 1);
    if (is_unknown_sample(texelFetch(l_buffer, nearest, 0))) {
        return Lighting(vec3(no_number()), vec3(0.0));
    }
#endif
    return result.lighting;
}

// Radiance towards the eye.
vec3 lit(MaterialBlock material, vec3 base_color) {
    vec2 metallic_roughness = metallic_roughness_at(material);
    Surface surface = Surface(base_color, metallic_roughness.x, metallic_roughness.y, DEFAULT_DIELECTRIC_F0);
    float openness = 1.0;
    if (SURFACE_EXTRAS != 0u) {
        uint extras = extras_at(material);
        surface.dielectric_f0 = f0_of_extras(extras);
        openness = openness_of_extras(extras);
    }
    Lighting lighting = lighting_here(material);
    vec3 f0 = BRDF_KIND == BRDF_LAMBERT ? vec3(0.0) : f0_of(surface);
    vec3 ambient = frame.ambient.rgb;
    // The L-buffer has the whole ambient light: what is hidden of it is taken off.
    vec3 received = max(lighting.irradiance / PI - (1.0 - openness) * ambient, vec3(0.0));
    vec3 radiance = emissive_at(material) + (1.0 - f0) * albedo_of(surface) * received + f0 * ambient * openness;
    if (BRDF_KIND != BRDF_LAMBERT) {
        radiance += highlight_of(lighting, f0, f90_of(surface));
    }
    return radiance;
}

void main() {
    MaterialBlock material = params.material;
    vec4 base_color = base_color_at(material);
#ifdef ALPHA_MASK
    if (base_color.a < material.alpha_cutoff) {
        discard;
    }
#endif
#ifdef ALPHA_BLEND
    // What is as good as empty adds nothing, and no texel was lit for it.
    if (base_color.a < LEAST_ALPHA) {
        discard;
    }
#endif
    bool is_unlit = SURFACE_EXTRAS != 0u && (material.flags & MATERIAL_UNLIT) != 0u;
    vec3 radiance = as_sample(is_unlit ? base_color.rgb : lit(material, base_color.rgb));
#ifdef ALPHA_BLEND
    // Premultiplied: coverage dims what the surface sends as much as what lies behind it.
    out_color = vec4(radiance * base_color.a, base_color.a);
#else
    out_color = vec4(radiance, 1.0);
#endif
}
