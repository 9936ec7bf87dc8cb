// From a triangle's number to its draw, for shaders that no draw of it runs. After scene_buffers.glsl, with DRAW_OF_TRIANGLE.
// Written by src/techniques/deep_shading/ranges.rs.
#ifndef DEEP_SHADING_RANGES_GLSL
#define DEEP_SHADING_RANGES_GLSL

// A draw's triangles, as one order counts them: by their ids, or as they are drawn.
struct DrawnRangeBlock {
    // The number of its first one: ranges are sorted by it.
    uint first;
    // A triangle's number is its place among all indices, a third of it, plus this (modulo 2^32).
    uint number_offset;
    uint draw;
    // As of DrawnParams.
    uint vertex_offset;
    uint primitive_offset;
    uint flags;
};

// NUMBERED_IN_ORDER: as they are drawn.
#ifdef NUMBERED_IN_ORDER
layout(std430, set = 0, binding = 33) readonly buffer OrderedRanges { DrawnRangeBlock ranges[]; };
#else
layout(std430, set = 0, binding = 33) readonly buffer DrawnRanges { DrawnRangeBlock ranges[]; };
#endif

// Sets `params` to the draw of the triangle of this number: the last one that begins there or before. Returns the triangle's place.
uint find_draw(uint number) {
    uint first = 0u;
    uint count = uint(ranges.length());
    while (count > 1u) {
        uint before = count / 2u;
        bool is_after = ranges[first + before].first <= number;
        first += is_after ? before : 0u;
        count = is_after ? count - before : before;
    }
    params.draw = ranges[first].draw;
    params.vertex_offset = ranges[first].vertex_offset;
    params.primitive_offset = ranges[first].primitive_offset;
    params.flags = ranges[first].flags;
    return number - ranges[first].number_offset;
}

#endif
