// A triangle at the pixels of shading space that it touches: shaded where the list has it (section 4.4; appendix A, pass 3).
// Pass: src/techniques/deep_shading/shade/mod.rs.
// variants: LISTS=linked|compact ZMAX=off|on VERTEX=plain|extended SHADOWS=traced|mapped
#version 460
#include "techniques/deep_shading/buffer_addresses.glsl"
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/surface.glsl"
#include "techniques/deep_shading/counters.glsl"

// As in insert.comp.
layout(constant_id = 92) const uint TOLERATES_DUPLICATES = 0;
// 1: what is shaded is counted.
layout(constant_id = 94) const uint IS_COUNTED = 0;

layout(location = 0) flat in uint in_primitive;

layout(std430, set = 0, binding = 20) readonly buffer Begins { uint begins[]; };
layout(std430, set = 0, binding = 21) readonly buffer Nodes { uvec2 nodes[]; };
layout(std430, set = 0, binding = 22) writeonly buffer Colors { uvec2 colors[]; };
layout(std430, set = 0, binding = 39) readonly buffer BufferAddresses { BufferAddressBlock buffer_addresses; };

READS_WORDS(begin_of, begins)
READS_PAIRS(node_of, nodes)
WRITES_PAIRS(set_color, colors)
#ifdef LISTS_COMPACT
layout(std430, set = 0, binding = 23) readonly buffer Linear { uint linear[]; };
READS_WORDS(row_id, linear)
#endif
#ifdef ZMAX_ON
layout(std430, set = 0, binding = 25) readonly buffer ZMax { uint zmax[]; };
READS_WORDS(zmax_of, zmax)
#endif
layout(std430, set = 0, binding = 26) buffer Counters { uint counters[]; };

#include "techniques/deep_shading/nodes.glsl"

#ifdef ZMAX_ON
// Whether nothing of the triangle in this pixel is as near as what is farthest of all that samples saw here. Never so where
// a sample saw this triangle: it saw it between its corners. The margin is for interpolation, whose errors are parts of what
// a triangle spans.
bool is_hidden(uint pixel) {
    uint corner = 3u * (in_primitive - params.primitive_offset);
    vec4 clips[3] = vec4[3](
        canonical_clip(vertex_of(corner)), canonical_clip(vertex_of(corner + 1u)), canonical_clip(vertex_of(corner + 2u)));
    float nearest = 0.0;
    float farthest = 1.0;
    for (uint index = 0u; index < 3u; index++) {
        if (clips[index].w <= 0.0 || clips[index].z > clips[index].w) {
            return false;
        }
        float depth = clips[index].z / clips[index].w;
        nearest = max(nearest, depth);
        farthest = min(farthest, depth);
    }
    float farthest_seen = uintBitsToFloat(~zmax_of(pixel));
    return nearest + 0.05 * (nearest - farthest) + 1e-3 * nearest < farthest_seen;
}
#endif

void main() {
    uvec2 at = uvec2(gl_FragCoord.xy);
    // A quad at the rim has pixels beyond it, which are run too: what they would read may be no pointer. Nothing is
    // attached that could be written, so a thread returns: one that is discarded continues as a helper of its quad
    // (glslang takes discard for demotion) and still reads.
    if (at.x >= deep.shading_width_px || at.y >= deep.shading_height_px) {
        return;
    }
    if (IS_COUNTED != 0u) {
        atomicAdd(counters[COUNTED_DRAWN], 1u);
    }
    uint pixel = at.y * deep.shading_width_px + at.x;
    // Nothing was seen here.
    if (begin_of(pixel) == 0u) {
        return;
    }
#ifdef ZMAX_ON
    if (is_hidden(pixel)) {
        return;
    }
#endif
    uint color = color_index(pixel, in_primitive);
    if (color == NO_COLOR) {
        return;
    }
    uvec2 shaded = color_on(in_primitive, at, false, vec3(0.0));
    set_color(color, shaded);
#ifdef LISTS_LINKED
    if (TOLERATES_DUPLICATES != 0u) {
        // Samples may point to any of them.
        for (uint node = node_of(color).y; node != 0u; node = node_of(node - 1u).y) {
            if (node_of(node - 1u).x == in_primitive) {
                set_color(node - 1u, shaded);
            }
        }
    }
#endif
    if (IS_COUNTED != 0u) {
        atomicAdd(counters[COUNTED_SHADED], 1u);
    }
}
