// BLEND surfaces over the finished picture, back to front, lit forward by every punctual light and by the virtual ones of
// their pixel. Pass: src/passes/blend.rs.
// variants: VERTEX=plain|extended
#version 460
#include "frame.glsl"
#include "bvh.glsl"
#include "loops.glsl"
#include "sampling/pattern.glsl"
#include "shading/light.glsl"
#include "shading/subset.glsl"
#include "resident.glsl"

// BRDF_ and SHADOW_ values.
layout(constant_id = 2) const uint BRDF_KIND = 2;
layout(constant_id = 3) const uint DIRECT_SHADOW = 0;

struct BlendParams {
    // Square of --vpl-clamp, in square metres.
    float least_squared;
    // n * m where pixels have subsets, else 1.
    float weight;
    // n x m; 0 x 0: every virtual point light on every pixel.
    uint pattern_x;
    uint pattern_y;
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

#include "shading/material.glsl"
#include "bvh_walk.glsl"
#include "shading/shade_lights.glsl"

layout(location = 0) out vec4 out_color;

void main() {
    MaterialBlock material = materials[in_material];
    vec4 base_color = base_color_at(material);
    if (SURFACE_EXTRAS != 0u && (material.flags & MATERIAL_UNLIT) != 0u) {
        out_color = vec4(base_color.rgb * base_color.a, base_color.a);
        return;
    }
    vec2 metallic_roughness = metallic_roughness_at(material);
    vec3 normal_ws = normal_at(material);
    Surface surface = Surface(base_color.rgb, metallic_roughness.x, metallic_roughness.y, DEFAULT_DIELECTRIC_F0);
    vec3 eye_ws = to_eye(frame, in_position_ws);
    float openness = 1.0;
    if (SURFACE_EXTRAS != 0u) {
        uint extras = extras_at(material);
        surface.dielectric_f0 = f0_of_extras(extras);
        openness = openness_of_extras(extras);
    }
    vec3 radiance = emissive_at(material) + ambient_reflectance(BRDF_KIND, surface) * frame.ambient.rgb * openness;
    uint light = 0u;
    for (; light < frame.light_count; light++) {
        radiance += shade_light(lights[light], surface, in_position_ws, normal_ws, eye_ws);
    }
    expect_done(light == frame.light_count);
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
        received += vpl_irradiance(vpls[vpl], in_position_ws, normal_ws, params.least_squared);
    }
    expect_done(vpl == end);
    radiance += albedo_of(surface) * received * (params.weight / PI);
    // Premultiplied: coverage dims what the surface sends as much as what lies behind it.
    out_color = vec4(nan_if_cut(radiance) * base_color.a, base_color.a);
}
