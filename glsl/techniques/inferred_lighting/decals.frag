// Normals of decals over those of what they lie on, by their alpha. Kircher 2009, section 5.2. Pass:
// src/techniques/inferred_lighting/decals.rs.
// variants: VERTEX=plain|extended
#version 460
#include "techniques/inferred_lighting/encoding.glsl"
#include "resident.glsl"

struct DecalParams {
    // The draw's.
    MaterialBlock material;
    // Linear depth: the first step, and all of them.
    float first_depth_m;
    float depth_range_m;
    // Part of its depth by which what it lies on may be behind it.
    float depth_threshold;
};

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(push_constant) uniform Push { DecalParams params; };
#ifdef VERTEX_EXTENDED
layout(std430, set = 0, binding = 8) readonly buffer Placements { PlacementBlock placements[]; };
#endif
layout(set = 0, binding = 41) uniform usampler2D geometry_dsf;

#include "shading/material.glsl"

layout(location = 0) out vec4 out_normal;

void main() {
    MaterialBlock material = params.material;
    float alpha = base_color_at(material).a;
    uint word = texelFetch(geometry_dsf, ivec2(gl_FragCoord.xy), 0).r;
    vec2 range_m = vec2(params.first_depth_m, params.depth_range_m);
    float depth_m = linear_depth(frame, in_position_ws);
    float off_m = abs(depth_of_dsf(word, range_m) - depth_m);
    if (alpha < LEAST_ALPHA || !dsf_has_surface(word) || off_m > depth_slack_m(depth_m, params.depth_threshold, range_m)) {
        discard;
    }
    vec4 normal = channels_of(pack_view_normal(view_from_world(frame, normal_at(material, to_eye(frame, in_position_ws)))));
    out_normal = vec4(normal.xy * alpha, 0.0, alpha);
}
