// The geometry pass: normal, DSF data and, where the light pass has it, specular power. Kircher 2009, sections 2.1, 3.1, 4.
// Pass: src/techniques/inferred_lighting/geometry.rs.
// variants: ALPHA=opaque|mask|blend EXTRAS=off|on MOTION=off|on PACKING=words|channels VERTEX=plain|extended
#version 460
#include "techniques/inferred_lighting/encoding.glsl"
#ifdef EXTRAS_ON
#include "shading/brdf.glsl"
#endif
#include "resident.glsl"

struct GeometryParams {
    // The draw's.
    MaterialBlock material;
    // Linear depth: the first step, and all of them.
    float first_depth_m;
    float depth_range_m;
    // BLEND: side of the stipple, and which of its texels are the draw's, row-major.
    uint stipple_side;
    uint stipple_layer;
};

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(push_constant) uniform Push { GeometryParams params; };
#ifdef VERTEX_EXTENDED
layout(std430, set = 0, binding = 8) readonly buffer Placements { PlacementBlock placements[]; };
#endif

#include "shading/material.glsl"

#ifdef EXTRAS_ON
// 1: the light pass divides highlights by F0.
layout(constant_id = 24) const uint KEEPS_F0 = 0;
#endif

// Targets have as many bits a texel all, in every packing (section 5.2).
#ifdef PACKING_WORDS
#define TARGET uint
#define target_of(word) (word)
#else
#define TARGET vec4
#define target_of(word) channels_of(word)
#endif

layout(location = 0) out TARGET out_normal;
layout(location = 1) out TARGET out_dsf;
#ifdef EXTRAS_ON
layout(location = 2) out TARGET out_extras;
#endif

#ifdef MOTION_ON
#ifdef EXTRAS_ON
layout(location = 3) out uint out_motion;
#else
layout(location = 2) out uint out_motion;
#endif
layout(location = 7) in vec4 in_clip;
layout(location = 8) in vec4 in_earlier_clip;

const float MOST_MOTION_PX = 65504.0;

// Texels from where the surface was to where it is, right and down; 0 where it was not before the eye.
vec2 motion_px() {
    if (in_clip.w <= 0.0 || in_earlier_clip.w <= 0.0) {
        return vec2(0.0);
    }
    precise vec2 now = in_clip.xy / in_clip.w;
    precise vec2 earlier = in_earlier_clip.xy / in_earlier_clip.w;
    precise vec2 moved = (now - earlier) * 0.5 * vec2(frame.width_px, frame.height_px);
    return clamp(moved, vec2(-MOST_MOTION_PX), vec2(MOST_MOTION_PX));
}
#endif

void main() {
    MaterialBlock material = params.material;
#ifdef ALPHA_BLEND
    uvec2 cell = uvec2(gl_FragCoord.xy) % params.stipple_side;
    if (cell.y * params.stipple_side + cell.x != params.stipple_layer) {
        discard;
    }
    if (base_color_at(material).a < LEAST_ALPHA) {
        discard;
    }
#endif
#ifdef ALPHA_MASK
    if (base_color_at(material).a < material.alpha_cutoff) {
        discard;
    }
#endif
    out_normal = target_of(pack_view_normal(view_from_world(frame, normal_at(material, to_eye(frame, in_position_ws)))));
    float depth_m = linear_depth(frame, in_position_ws);
    out_dsf = target_of(pack_dsf(depth_m, vec2(params.first_depth_m, params.depth_range_m), in_ids.y));
#ifdef EXTRAS_ON
    vec2 metallic_roughness = metallic_roughness_at(material);
    uint f0_code = 0u;
    if (KEEPS_F0 != 0u) {
        // The base colour of what is no metal at all does not matter.
        vec3 base_color = material.metallic > 0.0 ? base_color_at(material).rgb : vec3(0.0);
        Surface surface = Surface(base_color, metallic_roughness.x, metallic_roughness.y, DEFAULT_DIELECTRIC_F0);
        if (SURFACE_EXTRAS != 0u) {
            surface.dielectric_f0 = f0_of_extras(extras_at(material));
        }
        f0_code = pack_f0(f0_of(surface), f90_of(surface));
    }
    out_extras = target_of(pack_extras_word(metallic_roughness.y, in_material, f0_code));
#endif
#ifdef MOTION_ON
    out_motion = packHalf2x16(motion_px());
#endif
}
