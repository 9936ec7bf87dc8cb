// A triangle at the pixels of shading space that it touches: shaded where the list has it (section 4.4; appendix A, pass 3), at a
// place that is computed, interpolated or the device's (section 5).
// Pass: src/techniques/deep_shading/shade/mod.rs.
// variants: LISTS=linked|compact VERTEX=plain|extended SHADOWS=traced|mapped BARYCENTRICS=computed|interpolated|device
#version 460
#ifdef BARYCENTRICS_DEVICE
#extension GL_EXT_fragment_shader_barycentric : require
#endif
#include "techniques/deep_shading/buffer_addresses.glsl"
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/surface.glsl"
#include "techniques/deep_shading/counters.glsl"

// As in insert.comp.
layout(constant_id = 92) const uint TOLERATES_DUPLICATES = 0;
// 1: what is shaded is counted.
layout(constant_id = 94) const uint IS_COUNTED = 0;

// The depth test of --zmax comes before the shader: its stores would put the test off.
layout(early_fragment_tests) in;

layout(location = 0) flat in uint in_primitive;
#ifdef BARYCENTRICS_INTERPOLATED
layout(location = 1) in vec3 in_weights;
#elif defined(BARYCENTRICS_DEVICE)
#define in_weights gl_BaryCoordEXT
#endif
#ifndef BARYCENTRICS_COMPUTED
#include "techniques/deep_shading/drawn_place.glsl"
#endif

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
layout(std430, set = 0, binding = 26) buffer Counters { uint counters[]; };

#include "techniques/deep_shading/nodes.glsl"

void main() {
#ifndef BARYCENTRICS_COMPUTED
    Place drawn = drawn_place();
#endif
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
    uint color = color_index(pixel, in_primitive);
    if (color == NO_COLOR) {
        return;
    }
#ifdef BARYCENTRICS_COMPUTED
    stand_in(in_primitive, at, false, vec3(0.0));
#else
    if (all(greaterThanEqual(drawn.weights, vec3(0.0)))) {
        stand_at(in_primitive, drawn);
    } else {
        stand_in(in_primitive, at, false, vec3(0.0));
    }
#endif
    uvec2 shaded = color_of_base(base_color_at(params.material));
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
