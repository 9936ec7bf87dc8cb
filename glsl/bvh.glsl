// The tree that src/bvh/ builds, as it lies in buffers. bvh_walk.glsl and bvh_trace.glsl walk it.
#ifndef BVH_GLSL
#define BVH_GLSL

// One node: its box, and its children or triangles.
struct BvhNodeBlock {
    // xyz: least corner; w as bits: 0 for an inner node, else the number of triangles.
    vec4 min_count;
    // xyz: greatest corner; w as bits: the first of two neighbouring children, or the first triangle. To a walk without a
    // stack an inner node's is the place after all below it (bvh_walk.glsl).
    vec4 max_first;
};

// Four children of a node, axis by axis, so that one reading tests all of them.
struct BvhWideBlock {
    // Corners of their boxes; a missing child lies where no ray reaches.
    vec4 min_x;
    vec4 min_y;
    vec4 min_z;
    vec4 max_x;
    vec4 max_y;
    vec4 max_z;
    // From bit LEAF_SHIFT on 0 and below it a node's index, or a number of triangles and below it the first.
    uvec4 children;
};

const uint LEAF_SHIFT = 26u;

// What the nodes are, by the including shader's axis NODES, where it has one.
#ifdef NODES_FOUR
#define BVH_NODE BvhWideBlock
#else
#define BVH_NODE BvhNodeBlock
#endif

// One triangle, in the order in which leaves list them.
struct BvhTriangleBlock {
    // xyz: the first corner; w as bits: TRIANGLE_ bits.
    vec4 corner;
    vec4 edge1;
    vec4 edge2;
};

// Alpha decides whether a ray meets it (MASK, BLEND).
const uint TRIANGLE_TESTED = 1u;
// Its back is not drawn.
const uint TRIANGLE_SINGLE_SIDED = 2u;
// Its draw mirrors: its front is the side from which its corners run clockwise.
const uint TRIANGLE_MIRRORED = 4u;

// A shadow ray starts this many metres off its surface, along the normal.
layout(constant_id = 60) const float RAY_OFFSET = 1e-4;

// What DIRECT_SHADOW asks rays for. Shadow maps are another number, which asks for none.
const uint SHADOW_NONE = 0u;
const uint SHADOW_SUN = 1u;
const uint SHADOW_RAY = 2u;

#endif
