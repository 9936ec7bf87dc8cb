// Planes through a volume, farthest first, an instance each: the polygon in which one cuts the volume's box, as four
// triangles. Keller and Heidrich 2001, section 3.3. Pass: src/techniques/interleaved_sampling/slices.rs.
#version 460
#include "techniques/interleaved_sampling/slices.glsl"

// How far behind the beginning of its step a plane of each member lies, in steps.
layout(std430, set = 0, binding = 1) readonly buffer Offsets { float offsets[]; };

// x: depth of the plane; y: from one plane to the next, metres.
layout(location = 0) flat out vec2 out_plane;

// A plane cuts a box in six edges at most.
const uint MOST_CORNERS = 6u;

void main() {
    vec3 corners[8];
    float depths[8];
    vec4 near_ws = frame.world_from_clip * vec4(0.0, 0.0, 1.0, 1.0);
    float first = 1e30;
    float last = -1e30;
    for (uint corner = 0u; corner < 8u; corner++) {
        vec3 at = vec3(corner & 1u, corner >> 1 & 1u, corner >> 2 & 1u);
        corners[corner] = (volume.world_from_box * vec4(at, 1.0)).xyz;
        depths[corner] = depth_of(corners[corner]);
        first = min(first, depths[corner]);
        last = max(last, depths[corner]);
    }
    // What lies before the near plane is not seen.
    first = max(first, depth_of(near_ws.xyz / near_ws.w));
    float step_m = (last - first) / float(params.plane_count);
    float plane = float(params.plane_count - 1u - uint(gl_InstanceIndex)) + offsets[frame.sample_index];
    float depth = first + plane * step_m;
    out_plane = vec2(depth, step_m);

    vec3 cut[MOST_CORNERS];
    uint count = 0u;
    vec3 sum = vec3(0.0);
    for (uint edge = 0u; edge < 24u; edge++) {
        uint from = edge & 7u;
        uint to = from | 1u << (edge >> 3);
        if (to != from && (depths[from] < depth) != (depths[to] < depth) && count < MOST_CORNERS) {
            float part = (depth - depths[from]) / (depths[to] - depths[from]);
            cut[count] = mix(corners[from], corners[to], part);
            sum += cut[count];
            count++;
        }
    }
    // Around their middle, so that the fan of triangles is the convex polygon.
    vec3 middle = sum / float(max(count, 1u));
    float turns[MOST_CORNERS];
    for (uint i = 0u; i < count; i++) {
        vec3 aside = cut[i] - middle;
        turns[i] = atan(dot(aside, frame.up_ws.xyz), dot(aside, frame.right_ws.xyz));
    }
    uint of_triangle = uint(gl_VertexIndex) % 3u;
    uint wanted = of_triangle == 0u ? 0u : uint(gl_VertexIndex) / 3u + of_triangle;
    // Triangles that a smaller polygon has not become points.
    wanted = min(wanted, max(count, 1u) - 1u);
    vec3 place_ws = middle;
    for (uint i = 0u; i < count; i++) {
        uint before = 0u;
        for (uint j = 0u; j < count; j++) {
            before += uint(turns[j] < turns[i] || (turns[j] == turns[i] && j < i));
        }
        if (before == wanted) {
            place_ws = cut[i];
        }
    }
    gl_Position = frame.clip_from_world * vec4(place_ws, 1.0);
}
