// Points whose hidden lights a thread looks for: each pixel's, in the order of the sub-buffers whether there are any or not, so that
// neighbouring threads have the same lights, or the one of each cell of the pattern (--split subsample).
#ifndef INTERLEAVED_DEFERRED_HIDDEN_POINTS_GLSL
#define INTERLEAVED_DEFERRED_HIDDEN_POINTS_GLSL

#include "techniques/interleaved_deferred/mapping.glsl"
#include "techniques/interleaved_deferred/vpl_shadow/hidden.glsl"

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;

struct HiddenParams {
    MappingParams mapping;
    // Square of --vpl-clamp, in square metres.
    float least_squared;
    // 1 or more.
    uint words_a_point;
    // 1: a point stands for a cell of the pattern.
    uint is_of_cells;
    // First subset and first word of a point that the dispatch is about.
    uint subset_first;
    uint word_first;
    // The virtual lights that it is about, of the whole list.
    uint light_first;
    uint light_end;
    uint _unused;
};

struct HiddenPoint {
    bool exists;
    uvec2 pixel;
    // Its subset of the lights.
    uint subset;
    // Which of its words the thread has, and where that is.
    uint word;
    uint at;
};

// x of the workgroups: points of a subset; y: words; z: subsets.
HiddenPoint hidden_point(HiddenParams params) {
    MappingParams mapping = params.mapping;
    uint inside = gl_WorkGroupID.x * gl_WorkGroupSize.x * gl_WorkGroupSize.y + gl_LocalInvocationIndex;
    HiddenPoint point;
    point.subset = params.subset_first + gl_WorkGroupID.z;
    point.word = params.word_first + gl_WorkGroupID.y;
    uvec3 texel = uvec3(inside % mapping.sub_width_px, inside / mapping.sub_width_px, point.subset);
    point.pixel = params.is_of_cells != 0u ? middle_of_cell(mapping, texel.xy) : pixel_of_texel(mapping, texel);
    point.exists = texel.y < mapping.sub_height_px && is_in_frame(mapping, point.pixel);
    point.at = first_hidden_word(linear_of(mapping, texel), params.words_a_point) + point.word;
    return point;
}

#endif
