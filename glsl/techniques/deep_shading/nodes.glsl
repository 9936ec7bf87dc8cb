// The deep shading buffer: which triangles must be shaded at each pixel of shading space (section 4.3).
//
// A list is linked (begins, nodes) or, with the axis LISTS=compact, its first LINEAR_COUNT ids lie in a row, sorted, and the
// rest is linked. A node is its sample's own: as many as samples can never run out, and no lane takes one that it does not
// need. Pointers are one more than indices; 0 ends a list.
//
// After compaction the node that `begins` points to holds where the list's colours begin, and the first of the linked rest.
//
// The including shader declares begin_of, node_of and, with LISTS=compact, row_id of buffer_addresses.glsl.
#ifndef DEEP_SHADING_NODES_GLSL
#define DEEP_SHADING_NODES_GLSL

// The paper's M.
const uint LINEAR_COUNT = 16u;
const uint NO_COLOR = 0xffffffffu;
// More than every id.
const uint LINEAR_END = 0xffffffffu;

// Where the colour of a triangle at a pixel of shading space lies; NO_COLOR: it is not in the list.
uint color_index(uint pixel, uint primitive) {
    uint at = begin_of(pixel);
    if (at == 0u) {
        return NO_COLOR;
    }
#ifdef LISTS_COMPACT
    uvec2 head = node_of(at - 1u);
    uint place = 0u;
    for (; place < LINEAR_COUNT; place++) {
        uint id = row_id(pixel * LINEAR_COUNT + place);
        if (id >= primitive) {
            return id == primitive ? head.x + place : NO_COLOR;
        }
    }
    at = head.y;
    while (at != 0u) {
        uvec2 node = node_of(at - 1u);
        if (node.x >= primitive) {
            return node.x == primitive ? head.x + place : NO_COLOR;
        }
        place++;
        at = node.y;
    }
#else
    while (at != 0u) {
        uvec2 node = node_of(at - 1u);
        if (node.x == primitive) {
            return at - 1u;
        }
        at = node.y;
    }
#endif
    return NO_COLOR;
}

#endif
