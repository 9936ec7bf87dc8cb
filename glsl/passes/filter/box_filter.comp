// A box of N x M pixels that stops at discontinuities (Wald 2002, section 4.2, as Dubla 2009, section 3, has it): the
// mean of those that a walk reaches that never turns back, first along either axis, and crosses no discontinuity.
// Pass: src/passes/filter/box_filter.rs.
#version 460
#include "passes/gbuffer.glsl"

struct BoxParams {
    uint width_px;
    uint height_px;
    // Pixels of the box to the left, to the right, above and below the middle: at most MOST_REACH each.
    uint left;
    uint right;
    uint above;
    uint below;
    // Texel of the target at which it begins to write.
    uint target_first;
};

// Half of the widest box.
const uint MOST_REACH = 4u;

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;

layout(push_constant) uniform Push { BoxParams params; };
layout(std430, set = 0, binding = 0) readonly buffer Source { uvec2 source[]; };
// Bit 0: differs from +x, bit 1: from +y.
layout(std430, set = 0, binding = 1) readonly buffer Flags { uint flags[]; };
layout(std430, set = 0, binding = 2) writeonly buffer Target { uvec2 target[]; };

uint texel_of(ivec2 pixel) {
    return uint(pixel.y) * params.width_px + uint(pixel.x);
}

// Whether a step of 1 along x, or along y, from `pixel` in the direction of `sign` crosses no discontinuity.
bool is_open(ivec2 pixel, ivec2 step, int sign) {
    ivec2 lesser = sign > 0 ? pixel : pixel - step;
    ivec2 greater = lesser + step;
    if (lesser.x < 0 || lesser.y < 0 || greater.x >= int(params.width_px) || greater.y >= int(params.height_px)) {
        return false;
    }
    return (flags[texel_of(lesser)] & (step.x != 0 ? 1u : 2u)) == 0u;
}

// Adds one quadrant of the box: its columns beside the middle, and its rows, the middle's row included where `has_row`.
void add_quadrant(
    ivec2 middle,
    ivec2 signs,
    uvec2 reach,
    bool has_row,
    bool has_column,
    inout vec3 sum,
    inout float count
) {
    // Which columns of the row before are reached.
    bool reached[MOST_REACH + 1u];
    for (uint row = 0u; row <= reach.y; row++) {
        for (uint column = 0u; column <= reach.x; column++) {
            ivec2 pixel = middle + ivec2(column, row) * signs;
            bool along = column > 0u && reached[column - 1u] && is_open(pixel - ivec2(signs.x, 0), ivec2(1, 0), signs.x);
            bool down = row > 0u && reached[column] && is_open(pixel - ivec2(0, signs.y), ivec2(0, 1), signs.y);
            reached[column] = (row == 0u && column == 0u) || along || down;
            bool is_own = (row > 0u || has_row) && (column > 0u || has_column);
            if (reached[column] && is_own) {
                precise vec3 more = sum + unpack_halves(source[texel_of(pixel)]);
                sum = more;
                count += 1.0;
            }
        }
    }
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= int(params.width_px) || pixel.y >= int(params.height_px)) {
        return;
    }
    vec3 sum = vec3(0.0);
    float count = 0.0;
    // Each pixel of the box is in one quadrant: the axes are the first's, but for their other halves.
    add_quadrant(pixel, ivec2(1, 1), uvec2(params.right, params.below), true, true, sum, count);
    add_quadrant(pixel, ivec2(-1, 1), uvec2(params.left, params.below), true, false, sum, count);
    add_quadrant(pixel, ivec2(1, -1), uvec2(params.right, params.above), false, true, sum, count);
    add_quadrant(pixel, ivec2(-1, -1), uvec2(params.left, params.above), false, false, sum, count);
    target[params.target_first + texel_of(pixel)] = pack_halves(sum / count, 0u);
}
