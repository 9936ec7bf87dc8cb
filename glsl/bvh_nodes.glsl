// What is below a node of the tree, to a ray. NODES: two, the children are neighbours, each with its own box (BvhNodeBlock);
// four, a node has the boxes of its children (BvhWideBlock). Host: src/bvh/nodes.rs.
//
// The including shader has the axis NODES and declares bvh_nodes[].
#ifndef BVH_NODES_GLSL
#define BVH_NODES_GLSL

#include "bvh_tests.glsl"

#ifdef NODES_FOUR
const uint NODE_WIDTH = 4u;
#else
const uint NODE_WIDTH = 2u;
#endif

// What a walk begins with.
const uint ROOT = 0u;

// Children whose boxes a ray enters, nearest first.
struct Entered {
    // Number of them before the limit: the first ones.
    uint count;
    // Those behind the limit too, which the same ray finds again in the same order whatever its limit is by then.
    uvec4 nodes;
};

const Entered NONE_ENTERED = Entered(0u, uvec4(0u));

// The first triangle of a leaf and how many there are; 0 for an inner node, then what `entered_below` takes.
uvec2 leaf_at(uint node) {
#ifdef NODES_FOUR
    return uvec2(node & ((1u << LEAF_SHIFT) - 1u), node >> LEAF_SHIFT);
#else
    return uvec2(floatBitsToUint(bvh_nodes[node].max_first.w), floatBitsToUint(bvh_nodes[node].min_count.w));
#endif
}

// Whether a walk begins at all. Where the root is no leaf its children say the same.
bool enters_root(vec3 origin, vec3 inverse, float limit) {
#ifdef NODES_FOUR
    return limit > 0.0;
#else
    return limit > 0.0 && box_entry(bvh_nodes[ROOT], origin, inverse, limit) >= 0.0;
#endif
}

Entered entered_below(uint first, vec3 origin, vec3 inverse, float limit) {
    Entered entered = NONE_ENTERED;
#ifdef NODES_FOUR
    vec4 near_x = (bvh_nodes[first].min_x - origin.x) * inverse.x;
    vec4 far_x = (bvh_nodes[first].max_x - origin.x) * inverse.x;
    vec4 near_y = (bvh_nodes[first].min_y - origin.y) * inverse.y;
    vec4 far_y = (bvh_nodes[first].max_y - origin.y) * inverse.y;
    vec4 near_z = (bvh_nodes[first].min_z - origin.z) * inverse.z;
    vec4 far_z = (bvh_nodes[first].max_z - origin.z) * inverse.z;
    vec4 entry = max(max(min(near_x, far_x), min(near_y, far_y)), max(min(near_z, far_z), 0.0));
    vec4 leave = min(min(max(near_x, far_x), max(near_y, far_y)), max(near_z, far_z));
    // Bits of floats from 0 on are in order; the last two say which child it is, so that sorting is of words alone. What is
    // cut off makes an entry earlier, never later. The sign goes too: the greater one of -0 and 0 may be -0.
    const uint ORDER_MASK = 0x7ffffffcu;
    const uint MISSED = 0xffffffffu;
    uvec4 keys = mix(uvec4(MISSED), (floatBitsToUint(entry) & ORDER_MASK) | uvec4(0u, 1u, 2u, 3u), lessThanEqual(entry, leave));
    keys = uvec4(min(keys.xz, keys.yw), max(keys.xz, keys.yw));
    keys = uvec4(min(keys.x, keys.y), max(keys.x, keys.y), min(keys.z, keys.w), max(keys.z, keys.w));
    keys.yz = uvec2(min(keys.y, keys.z), max(keys.y, keys.z));
    bvec4 is_before = lessThanEqual(keys & ~3u, uvec4(floatBitsToUint(limit)));
    entered.count = uint(is_before.x) + uint(is_before.y) + uint(is_before.z) + uint(is_before.w);
    uvec4 children = bvh_nodes[first].children;
    entered.nodes = uvec4(children[keys.x & 3u], children[keys.y & 3u], children[keys.z & 3u], children[keys.w & 3u]);
#else
    const float ENDLESS = 3.4e38;
    float left = box_entry(bvh_nodes[first], origin, inverse, ENDLESS);
    float right = box_entry(bvh_nodes[first + 1u], origin, inverse, ENDLESS);
    bool is_right_first = right >= 0.0 && (left < 0.0 || right < left);
    float nearer = is_right_first ? right : left;
    float other = is_right_first ? left : right;
    entered.count = uint(nearer >= 0.0 && nearer <= limit) + uint(other >= 0.0 && other <= limit);
    entered.nodes.xy = is_right_first ? uvec2(first + 1u, first) : uvec2(first, first + 1u);
#endif
    return entered;
}

#endif
