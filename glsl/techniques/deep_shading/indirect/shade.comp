// All entries of the compact geometry buffer, each once. Pass: src/techniques/deep_shading/indirect/shade.rs.
// variants: SHADOWS=traced|mapped
#version 460
#include "techniques/deep_shading/buffer_addresses.glsl"
#include "frame.glsl"
#include "bvh.glsl"
#include "loops.glsl"
#include "shading/light.glsl"
#include "techniques/deep_shading/space.glsl"
#include "techniques/deep_shading/stored.glsl"
#include "techniques/deep_shading/counters.glsl"

// As in ../surface.glsl.
layout(constant_id = 2) const uint BRDF_KIND = 2;
layout(constant_id = 3) const uint DIRECT_SHADOW = 0;
// As in ../shade.frag.
layout(constant_id = 94) const uint IS_COUNTED = 0;

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 2) readonly buffer Deep { DeepBlock deep; };
layout(std430, set = 0, binding = 3) readonly buffer Lights { LightBlock lights[]; };
layout(std430, set = 0, binding = 5) readonly buffer BvhNodes { BvhNodeBlock bvh_nodes[]; };
layout(std430, set = 0, binding = 6) readonly buffer BvhTriangles { BvhTriangleBlock bvh_triangles[]; };
layout(std430, set = 0, binding = 17) readonly buffer Middle { FrameBlock frame; };
layout(std430, set = 0, binding = 22) writeonly buffer Colors { uvec2 colors[]; };
layout(std430, set = 0, binding = 26) buffer Counters { uint counters[]; };
layout(std430, set = 0, binding = 39) readonly buffer BufferAddresses { BufferAddressBlock buffer_addresses; };
WRITES_PAIRS(set_color, colors)

#define ENTRY_ACCESS readonly
#define ENTRY_FUNCTION READS_QUADS
#include "techniques/deep_shading/indirect/entries.glsl"
#include "bvh_walk.glsl"
#include "shading/sum_lights.glsl"

void main() {
    uvec3 at = gl_GlobalInvocationID;
    if (at.x >= deep.layer_width_px) {
        return;
    }
    // As many threads as there may be entries: those of the samples.
    uint entry = sample_index(deep, at);
    if (entry >= counters[COUNTED_COLORS]) {
        return;
    }
    vec4 place = entry_place(entry);
    vec4 normal = entry_normal(entry);
    vec4 base_color = entry_base_color(entry);
    vec4 dark = entry_radiance(entry);
    vec3 radiance = dark.rgb;
    if (dark.w == 0.0) {
        Surface surface = Surface(base_color.rgb, base_color.w, normal.w, place.w);
        radiance = nan_if_cut(sum_lights(radiance, surface, place.xyz, normal.xyz, 0u, frame.light_count));
    }
    set_color(entry, stored_color(radiance));
    if (IS_COUNTED != 0u) {
        atomicAdd(counters[COUNTED_SHADED], 1u);
    }
}
