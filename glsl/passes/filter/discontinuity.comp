// Discontinuity buffer (DB): does a pixel differ from its three positive neighbours? Segovia 2006, section 4.5.
// Bit 0: from +x, bit 1: from +y, bit 2: from +xy. The paper's flag is whether any bit is set.
// Pass: src/passes/filter/discontinuity.rs.
// variants: POSITION=half|unorm16|depth|float
#version 460
#include "passes/gbuffer_read.glsl"

struct DiscontinuityParams {
    // Flagged where 1 - dot(n0, n1) is greater.
    float normal_threshold;
    // Flagged where a neighbour lies farther off the pixel's tangent plane, in metres.
    float position_threshold;
    uint row_pitch;
    // Pixels from one that is flagged to the next, in both directions.
    uint stride;
};

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;
// Pixels that a thread flags, so that it reads a neighbour once.
layout(constant_id = 2) const uint COLUMNS = 1;
layout(constant_id = 3) const uint ROWS = 1;

layout(push_constant) uniform Push { DiscontinuityParams params; };
layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 1) writeonly buffer Flags { uint flags[]; };

// What a pixel and its neighbours are compared by.
struct Point {
    vec3 position_ws;
    vec3 normal_ws;
    bool surface;
};

// `texel`: one of those that are flagged.
Point point_at(uvec2 texel) {
    uvec2 pixel = texel * params.stride;
    uvec2 bits = normal_words(pixel);
    return Point(unpack_position(frame, position_words(pixel), pixel), unpack_normal(bits), has_surface(bits));
}

bool differ(Point point, Point other) {
    vec3 away = other.position_ws - point.position_ws;
    bool apart = 1.0 - dot(point.normal_ws, other.normal_ws) > params.normal_threshold
        || abs(dot(point.normal_ws, away)) > params.position_threshold;
    return point.surface != other.surface || (point.surface && apart);
}

void main() {
    uvec2 first = gl_GlobalInvocationID.xy * uvec2(COLUMNS, ROWS);
    uvec2 last = (uvec2(frame.width_px, frame.height_px) - 1u) / params.stride;
    if (first.x > last.x || first.y > last.y) {
        return;
    }
    Point above[COLUMNS + 1u];
    for (uint x = 0u; x <= COLUMNS; x++) {
        above[x] = point_at(uvec2(min(first.x + x, last.x), first.y));
    }
    for (uint row = 0u; row < ROWS; row++) {
        uint y = first.y + row;
        uint below = min(y + 1u, last.y);
        Point under = point_at(uvec2(first.x, below));
        for (uint column = 0u; column < COLUMNS; column++) {
            uint x = first.x + column;
            Point across = point_at(uvec2(min(x + 1u, last.x), below));
            if (x <= last.x && y <= last.y) {
                flags[y * params.row_pitch + x] = (differ(above[column], above[column + 1u]) ? 1u : 0u)
                    | (differ(above[column], under) ? 2u : 0u) | (differ(above[column], across) ? 4u : 0u);
            }
            above[column] = under;
            under = across;
        }
        above[COLUMNS] = under;
    }
}
