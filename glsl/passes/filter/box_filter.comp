// A box of N x M pixels that stops at discontinuities (Wald 2002, section 4.2, as Dubla 2009, section 3, has it): the
// mean of those that a walk reaches that never turns back, first along either axis, and crosses no discontinuity.
// Pass: src/passes/filter/box_filter.rs.
#version 460
#include "passes/gbuffer.glsl"

struct BoxParams {
    uint width_px;
    uint height_px;
    // Texel of the target at which it begins to write.
    uint target_first;
};

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;
// Pixels of a column that a thread filters, so that it reads a neighbour once.
layout(constant_id = 3) const uint ROWS = 1;
// Pixels of the box to the left, to the right, above and below the middle.
layout(constant_id = 4) const uint LEFT = 1;
layout(constant_id = 5) const uint RIGHT = 1;
layout(constant_id = 6) const uint ABOVE = 1;
layout(constant_id = 7) const uint BELOW = 1;

layout(push_constant) uniform Push { BoxParams params; };
layout(std430, set = 0, binding = 0) readonly buffer Source { uvec2 source[]; };
// Bit 0: differs from +x, bit 1: from +y.
layout(std430, set = 0, binding = 1) readonly buffer Flags { uint flags[]; };
layout(std430, set = 0, binding = 2) writeonly buffer Target { uvec2 target[]; };

const uint CLOSED_RIGHT = 1u;
const uint CLOSED_BELOW = 2u;
const uint CLOSED = 3u;

// The box around a pixel, row by row: values, and which steps to the right and down from each pixel are closed.
vec3 window_value[(ABOVE + 1u + BELOW) * (LEFT + 1u + RIGHT)];
uint window_closed[(ABOVE + 1u + BELOW) * (LEFT + 1u + RIGHT)];

uint texel_of(ivec2 pixel) {
    return uint(pixel.y) * params.width_px + uint(pixel.x);
}

void read(uint index, ivec2 pixel) {
    ivec2 size = ivec2(params.width_px, params.height_px);
    window_value[index] = vec3(0.0);
    window_closed[index] = CLOSED;
    if (all(greaterThanEqual(pixel, ivec2(0))) && all(lessThan(pixel, size))) {
        uint texel = texel_of(pixel);
        window_value[index] = unpack_halves(source[texel]);
        window_closed[index] = (flags[texel] & CLOSED)
            | (pixel.x + 1 == size.x ? CLOSED_RIGHT : 0u)
            | (pixel.y + 1 == size.y ? CLOSED_BELOW : 0u);
    }
}

// Adds one quadrant of the box, its side along each axis being that of `signs`; the middle's column and row are included
// where `has_column` and `has_row`.
void add_quadrant(ivec2 signs, uvec2 reach, bool has_row, bool has_column, inout vec3 sum, inout float count) {
    const int width = int(LEFT + 1u + RIGHT);
    // Which columns of the row before are reached, a bit each.
    uint reached = 1u;
    for (uint row = 0u; row <= reach.y; row++) {
        int line = (int(ABOVE) + int(row) * signs.y) * width + int(LEFT);
        int line_before = line - signs.y * width;
        for (uint column = 0u; column <= reach.x; column++) {
            int at = line + int(column) * signs.x;
            bool is_reached = row == 0u && column == 0u;
            if (row > 0u) {
                int lesser = signs.y > 0 ? line_before + int(column) * signs.x : at;
                is_reached = (reached & (1u << column)) != 0u && (window_closed[lesser] & CLOSED_BELOW) == 0u;
            }
            if (column > 0u) {
                int lesser = signs.x > 0 ? at - 1 : at;
                bool is_open = (window_closed[lesser] & CLOSED_RIGHT) == 0u;
                is_reached = is_reached || ((reached & (1u << (column - 1u))) != 0u && is_open);
            }
            reached = is_reached ? reached | (1u << column) : reached & ~(1u << column);
            if ((row > 0u || has_row) && (column > 0u || has_column)) {
                precise vec3 more = sum + window_value[at];
                sum = is_reached ? more : sum;
                count += is_reached ? 1.0 : 0.0;
            }
        }
    }
}

void main() {
    ivec2 first = ivec2(gl_GlobalInvocationID.xy * uvec2(1u, ROWS));
    if (first.x >= int(params.width_px) || first.y >= int(params.height_px)) {
        return;
    }
    const uint width = LEFT + 1u + RIGHT;
    const uint height = ABOVE + 1u + BELOW;
    for (uint row = 0u; row + 1u < height; row++) {
        for (uint column = 0u; column < width; column++) {
            read((row + 1u) * width + column, first + ivec2(int(column) - int(LEFT), int(row) - int(ABOVE)));
        }
    }
    for (uint row = 0u; row < ROWS; row++) {
        ivec2 pixel = first + ivec2(0, row);
        if (pixel.y >= int(params.height_px)) {
            return;
        }
        for (uint index = 0u; index + width < width * height; index++) {
            window_value[index] = window_value[index + width];
            window_closed[index] = window_closed[index + width];
        }
        for (uint column = 0u; column < width; column++) {
            read((height - 1u) * width + column, pixel + ivec2(int(column) - int(LEFT), int(BELOW)));
        }
        vec3 sum = vec3(0.0);
        float count = 0.0;
        // Each pixel of the box is in one quadrant: the axes are the first's, but for their other halves.
        add_quadrant(ivec2(1, 1), uvec2(RIGHT, BELOW), true, true, sum, count);
        add_quadrant(ivec2(-1, 1), uvec2(LEFT, BELOW), true, false, sum, count);
        add_quadrant(ivec2(1, -1), uvec2(RIGHT, ABOVE), false, true, sum, count);
        add_quadrant(ivec2(-1, -1), uvec2(LEFT, ABOVE), false, false, sum, count);
        target[params.target_first + texel_of(pixel)] = pack_halves(sum / count, 0u);
    }
}
