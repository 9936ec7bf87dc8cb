// BLEND surfaces over the finished picture, back to front, lit forward by the punctual lights of their piece's list, and by the
// virtual ones of their pixel. Pass: src/passes/blend.rs.
// variants: VERTEX=plain|extended SHADOWS=traced|mapped SHADED=pixel|sample VPL_SHADOW=none|ray
#version 460
#include "frame.glsl"
#include "bvh.glsl"
#include "loops.glsl"
#include "sampling/pattern.glsl"
#include "shading/light.glsl"
#include "shading/subset.glsl"
#include "lights/object_lists.glsl"
#include "resident.glsl"

// BRDF_ and SHADOW_ values.
layout(constant_id = 2) const uint BRDF_KIND = 2;
layout(constant_id = 3) const uint DIRECT_SHADOW = 0;
// BRDF_LAMBERT or BRDF_GGX: how virtual point lights are scattered.
layout(constant_id = 118) const uint VPL_BRDF = 0;

struct BlendParams {
    // Square of --vpl-clamp, in square metres.
    float least_squared;
    // n * m where pixels have subsets, else 1.
    float weight;
    // n x m; 0 x 0: every virtual point light on every pixel.
    uint pattern_x;
    uint pattern_y;
    // The piece's.
    ObjectLightsBlock object;
};

layout(push_constant) uniform Push { BlendParams params; };
layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 2) readonly buffer Materials { MaterialBlock materials[]; };
layout(std430, set = 0, binding = 3) readonly buffer Lights { LightBlock lights[]; };
layout(std430, set = 0, binding = 4) readonly buffer Vpls { VplBlock vpls[]; };
layout(std430, set = 0, binding = 7) readonly buffer Subsets { SubsetBlock subsets[]; };
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
#ifdef VPL_SHADOW_RAY
#include "shading/vpl_shadow.glsl"
#endif
#include "shading/sample.glsl"

layout(location = 0) out vec4 out_color;

void main() {
    MaterialBlock material = materials[in_material];
    vec4 base_color = base_color_at(material);
    if (SURFACE_EXTRAS != 0u && (material.flags & MATERIAL_UNLIT) != 0u) {
        out_color = vec4(base_color.rgb * base_color.a, base_color.a);
        return;
    }
    vec3 position_ws = inside_box(params.object, in_position_ws);
    Lit lit = lit_at(material, base_color.rgb, position_ws, params.object.first, params.object.count);
    vec3 eye_ws = to_eye(frame, position_ws);
    // Irradiance under Lambert's, which all lights share; else radiance.
    vec3 received = vec3(0.0);
    uint first = 0u;
    uint end = frame.vpl_count;
    if (params.pattern_x != 0u) {
        SubsetBlock subset = subsets[subset_of(uvec2(params.pattern_x, params.pattern_y), uvec2(gl_FragCoord.xy))];
        first = subset.vpl_first;
        end = first + subset.vpl_count;
    }
    uint vpl = first;
    for (; vpl < end; vpl++) {
        vec3 of_light = vpl_irradiance(vpls[vpl], position_ws, lit.normal_ws, params.least_squared);
#ifdef VPL_SHADOW_RAY
        if (of_light == vec3(0.0) || is_hidden_from(vpls[vpl], position_ws, lit.normal_ws)) {
            continue;
        }
#endif
        if (VPL_BRDF != BRDF_LAMBERT) {
            float distance;
            vec3 towards = towards_vpl(vpls[vpl], position_ws, distance);
            of_light *= brdf(VPL_BRDF, lit.surface, lit.normal_ws, towards, eye_ws);
        }
        received += of_light;
    }
    expect_done(vpl == end);
    vec3 of_vpls = VPL_BRDF != BRDF_LAMBERT
        ? received * params.weight
        : albedo_of(lit.surface) * received * (params.weight / PI);
    vec3 radiance = lit.radiance + of_vpls;
    // Premultiplied: coverage dims what the surface sends as much as what lies behind it.
    out_color = vec4(as_sample(nan_if_cut(radiance)) * base_color.a, base_color.a);
}
