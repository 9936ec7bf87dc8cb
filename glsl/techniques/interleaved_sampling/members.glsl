// Where the samples of the member that is drawn lie in the frame. Keller and Heidrich 2001, section 2.1.
// Host: src/techniques/interleaved_sampling/table.rs.
#ifndef TECHNIQUES_INTERLEAVED_SAMPLING_MEMBERS_GLSL
#define TECHNIQUES_INTERLEAVED_SAMPLING_MEMBERS_GLSL

#include "frame.glsl"

// A basis: so many of it lie along so many pixels.
struct MembersParams {
    uint period_x_px;
    uint period_y_px;
    uint bases_x;
    uint bases_y;
    // A member's samples across and down.
    uint grid_width;
    uint grid_height;
    // Where in the table the first members of pixels begin.
    uint firsts_at;
    // How many there are, and how many of them a run draws.
    uint members;
    uint members_at_once;
};

layout(push_constant) uniform Push { MembersParams params; };
layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 1) readonly buffer Members { uint members[]; };

const uint NO_SAMPLE = 0xffffffffu;

// The first of the members that are drawn.
uint first_of_run() {
    return frame.sample_index * params.members_at_once;
}

// Where the table has the pixels of a member: across, and then down.
uint table_begin(const in uint member) {
    return member * (params.bases_x + params.bases_y);
}

// The pixel that a member's sample lies in, which the frame may not have.
uvec2 pixel_of(const in uint member, uvec2 place) {
    uint begin = table_begin(member);
    return uvec2(
        place.x / params.bases_x * params.period_x_px + members[begin + place.x % params.bases_x],
        place.y / params.bases_y * params.period_y_px + members[begin + params.bases_x + place.y % params.bases_y]);
}

// Which of the samples along an axis lies in a pixel; NO_SAMPLE: none does.
uint place_along(uint begin, uint bases, uint period_px, uint pixel) {
    for (uint base = 0; base < bases; base++) {
        if (members[begin + base] == pixel % period_px) {
            return pixel / period_px * bases + base;
        }
    }
    return NO_SAMPLE;
}

// The stipple pattern of a member: the place of its sample in a pixel, NO_SAMPLE for one or both where it has none.
uvec2 place_of(const in uint member, uvec2 pixel) {
    uint begin = table_begin(member);
    return uvec2(
        place_along(begin, params.bases_x, params.period_x_px, pixel.x),
        place_along(begin + params.bases_x, params.bases_y, params.period_y_px, pixel.y));
}

// Whether a member has a sample in a pixel.
bool has_sample(const in uint member, uvec2 pixel) {
    uvec2 place = place_of(member, pixel);
    return place.x != NO_SAMPLE && place.y != NO_SAMPLE;
}

#endif
