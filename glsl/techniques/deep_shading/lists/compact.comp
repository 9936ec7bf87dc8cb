// Each list sorted and without what stands in it again; the first ids in a row (section 4.3). A thread has a list to itself.
// Pass: src/techniques/deep_shading/lists/compact.rs.
#version 460
#include "techniques/deep_shading/space.glsl"
#include "techniques/deep_shading/counters.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 2) readonly buffer Deep { DeepBlock deep; };
layout(std430, set = 0, binding = 20) buffer Begins { uint begins[]; };
layout(std430, set = 0, binding = 21) buffer Nodes { uvec2 nodes[]; };
layout(std430, set = 0, binding = 22) writeonly buffer Colors { uvec2 colors[]; };
layout(std430, set = 0, binding = 23) buffer Linear { uint linear[]; };
layout(std430, set = 0, binding = 26) buffer Counters { uint counters[]; };

#define LISTS_COMPACT
#include "techniques/deep_shading/nodes.glsl"

#include "techniques/deep_shading/lists/sorted.glsl"

void main() {
    uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x >= deep.shading_width_px) {
        return;
    }
    uint pixel = at.y * deep.shading_width_px + at.x;
    uint list = begins[pixel];
    if (list == 0u) {
        return;
    }
    if (nodes[list - 1u].y != 0u) {
        list = sorted(list);
    }
    uint count = 0u;
    uint last = LINEAR_END;
    uint rest = 0u;
    uint tail = 0u;
    for (uint node = list; node != 0u;) {
        uvec2 held = nodes[node - 1u];
        if (held.x != last) {
            last = held.x;
            if (count < LINEAR_COUNT) {
                linear[pixel * LINEAR_COUNT + count] = held.x;
            } else {
                if (tail == 0u) {
                    rest = node;
                } else {
                    nodes[tail - 1u].y = node;
                }
                tail = node;
            }
            count++;
        }
        node = held.y;
    }
    if (tail != 0u) {
        nodes[tail - 1u].y = 0u;
    }
    if (count < LINEAR_COUNT) {
        linear[pixel * LINEAR_COUNT + count] = LINEAR_END;
    }
    uint first = atomicAdd(counters[COUNTED_COLORS], count);
    for (uint color = 0u; color < count; color++) {
        colors[first + color] = uvec2(0u);
    }
    // Its id lies in the row: the node can carry what belongs to the list.
    nodes[list - 1u] = uvec2(first, rest);
    begins[pixel] = list;
}
