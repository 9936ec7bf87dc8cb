// Samples find their shading samples in a cache; a sample that finds none writes what its material says there into the
// compact geometry buffer. Pass: src/techniques/deep_shading/indirect/gbuffer.rs.
// variants: VERTEX=plain|extended VISIBILITY=interleaved|stochastic
#version 460
#include "techniques/deep_shading/buffer_addresses.glsl"
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/surface.glsl"
#include "techniques/deep_shading/redraw.glsl"
#include "techniques/deep_shading/counters.glsl"
#include "techniques/deep_shading/indirect/pointers.glsl"

// As in shade.frag.
layout(constant_id = 94) const uint IS_COUNTED = 0;

layout(set = 0, binding = 27) uniform usampler2DArray spids;
layout(std430, set = 0, binding = 26) buffer Counters { uint counters[]; };
layout(std430, set = 0, binding = 34) writeonly buffer Pointers { uint pointers[]; };
layout(std430, set = 0, binding = 39) readonly buffer BufferAddresses { BufferAddressBlock buffer_addresses; };
WRITES_WORDS(set_pointer, pointers)

#define ENTRY_ACCESS writeonly
#define ENTRY_FUNCTION WRITES_QUADS
#include "techniques/deep_shading/indirect/entries.glsl"
#include "techniques/deep_shading/indirect/cache.glsl"

void main() {
    uvec3 at = uvec3(gl_FragCoord.xy, in_tuple);
    // As in ../shade.frag.
    if (at.x >= deep.layer_width_px || at.y >= deep.layer_height_px) {
        return;
    }
    uvec2 spid = texelFetch(spids, ivec3(at), 0).xy;
    if (spid.x != in_primitive) {
        return;
    }
    uint own = sample_index(deep, at);
    bool is_outside = spid.y == NO_SHADING_PIXEL;
    uint owner = own;
    if (!is_outside) {
        owner = memoised(spid, own);
    } else if (IS_COUNTED != 0u) {
        atomicAdd(counters[COUNTED_STRAYS], 1u);
    }
    if (owner != own) {
        set_pointer(own, owner + 1u);
        return;
    }
    uint entry = atomicAdd(counters[COUNTED_COLORS], 1u);
    set_pointer(own, POINTER_OWNS | entry);
    stand_in(in_primitive, uvec2(spid.y & 0xffffu, spid.y >> 16), is_outside, seen_weights());
    vec3 base_color = base_color_at(params.material).rgb;
    Lit dark = dark_at(params.material, base_color);
    entry_place(entry, vec4(in_position_ws, dark.surface.dielectric_f0));
    entry_normal(entry, vec4(dark.normal_ws, dark.surface.roughness));
    entry_base_color(entry, vec4(base_color, dark.surface.metallic));
    entry_radiance(entry, is_unlit() ? vec4(base_color, 1.0) : vec4(dark.radiance, 0.0));
}
