// The material pass: a surface with its whole material under the lights of its object's list.
// Pass: src/passes/forward/material.rs.
// variants: ALPHA=opaque|mask VERTEX=plain|extended LIGHTS=uniform|storage SHADOWS=traced|mapped SHADED=pixel|sample
#version 460
#include "frame.glsl"
#include "bvh.glsl"
#include "loops.glsl"
#include "shading/light.glsl"
#include "lights/object_lists.glsl"
#include "resident.glsl"

// BRDF_ and SHADOW_ values.
layout(constant_id = 2) const uint BRDF_KIND = 2;
layout(constant_id = 3) const uint DIRECT_SHADOW = 0;

struct MaterialParams {
    // The draw's, as in gbuffer.frag.
    MaterialBlock material;
    ObjectLightsBlock object;
};

layout(push_constant) uniform Push { MaterialParams params; };
layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
#ifdef LIGHTS_UNIFORM
// As many as a uniform buffer of 64 KiB holds.
const uint UNIFORM_LIGHT_COUNT = 1024u;
layout(std140, set = 0, binding = 3) uniform Lights { LightBlock lights[UNIFORM_LIGHT_COUNT]; };
#else
layout(std430, set = 0, binding = 3) readonly buffer Lights { LightBlock lights[]; };
#endif
layout(std430, set = 0, binding = 5) readonly buffer BvhNodes { BvhNodeBlock bvh_nodes[]; };
layout(std430, set = 0, binding = 6) readonly buffer BvhTriangles { BvhTriangleBlock bvh_triangles[]; };
#ifdef VERTEX_EXTENDED
layout(std430, set = 0, binding = 8) readonly buffer Placements { PlacementBlock placements[]; };
#endif
layout(std430, set = 0, binding = 9) readonly buffer LightLists { uint light_lists[]; };

#define LISTS_OBJECT
#include "shading/material.glsl"
#include "bvh_walk.glsl"
#include "shading/lit.glsl"
#include "shading/sample.glsl"

// rgb: radiance; a: lights that were evaluated for it, which the report counts.
layout(location = 0) out vec4 out_color;

void main() {
    vec4 base_color = base_color_at(params.material);
#ifdef ALPHA_MASK
    if (base_color.a < params.material.alpha_cutoff) {
        discard;
    }
#endif
    if (SURFACE_EXTRAS != 0u && (params.material.flags & MATERIAL_UNLIT) != 0u) {
        out_color = vec4(base_color.rgb, 0.0);
        return;
    }
    vec3 position_ws = inside_box(params.object, in_position_ws);
    Lit lit = lit_at(params.material, base_color.rgb, position_ws, params.object.first, params.object.count);
    out_color = vec4(as_sample(nan_if_cut(lit.radiance)), as_sample(float(params.object.count)));
}
