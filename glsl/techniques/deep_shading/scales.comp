// How coarse each triangle may be in shading space: along each axis a pixel of it is at most a stated part of the least width that
// anything of the triangle is blurred by (section 6; Vaidyanathan et al. 2012 have shading by the width of blur). A thread a
// triangle. Pass: src/techniques/deep_shading/scales.rs.
#version 460
#define DRAW_OF_TRIANGLE
#include "frame.glsl"
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/ranges.glsl"
#include "techniques/deep_shading/visibility/seen.glsl"
#include "techniques/deep_shading/visibility/triangle.glsl"

layout(local_size_x = 64) in;

// Triangles of a row of the dispatch.
const uint SCALES_ROW = 65536u;

struct ScalesParams {
    uint triangle_count;
    // Pixels of shading space that there are across a blur, at least.
    float blur_pixels;
};

layout(push_constant) uniform Push { ScalesParams own; };
layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 4) readonly buffer Tuples { TupleBlock tuples[]; };
layout(std430, set = 0, binding = 19) writeonly buffer Scales { uvec2 scales[]; };

// The coarsest: a pixel as wide as sixteen.
const float COARSEST_SCALE = 0.0625;

// Least size of what goes from `low` to `high`.
float least_size(float low, float high) {
    return low * high > 0.0 ? min(abs(low), abs(high)) : 0.0;
}

// Widths of the box that everything of the triangle is blurred by at least, in pixels of even shading space: what the lens
// shows a point as, and the way of a corner as far as it goes along an axis. 0 before the near plane.
vec2 least_blur_px(Seen seen[6]) {
    vec2 low_way = vec2(3.0e38);
    vec2 high_way = vec2(-3.0e38);
    // By how much of the lens's shear a point moves.
    vec2 parts = vec2(3.0e38, -3.0e38);
    bool is_placed = true;
    for (uint corner = 0u; corner < 3u; corner++) {
        Seen open = seen[corner];
        Seen close = seen[corner + 3u];
        is_placed = is_placed && open.clip.w > open.clip.z && close.clip.w > close.clip.z;
        vec2 way = 0.5 * deep.scaled_px * (close.clip.xy / close.clip.w - open.clip.xy / open.clip.w);
        low_way = min(low_way, way);
        high_way = max(high_way, way);
        vec2 ends = vec2(lens_part(open.depth) / open.clip.w, lens_part(close.depth) / close.clip.w);
        parts = vec2(min(parts.x, min(ends.x, ends.y)), max(parts.y, max(ends.x, ends.y)));
    }
    if (!is_placed) {
        return vec2(0.0);
    }
    vec2 blur = vec2(0.0);
    if (HAS_LENS != 0u) {
        // Each of two eyes has a part of the disk.
        float part = (1.0 - abs(tuples[0].eye)) * least_size(parts.x, parts.y);
        blur = abs(deep.lens) * part * deep.scaled_px;
    }
    if (IS_MOVING != 0u) {
        vec2 across = max(abs(low_way), abs(high_way)).yx;
        vec2 along = vec2(least_size(low_way.x, high_way.x), least_size(low_way.y, high_way.y));
        blur += max(along - across, 0.0);
    }
    return blur;
}

void main() {
    uint primitive = gl_GlobalInvocationID.y * SCALES_ROW + gl_GlobalInvocationID.x;
    if (primitive >= own.triangle_count) {
        return;
    }
    Seen seen[6];
    see_triangle(find_draw(primitive), seen);
    vec2 scale = clamp(own.blur_pixels / max(least_blur_px(seen), 1e-3), COARSEST_SCALE, 1.0);
    // The least pixel that it touches stays where it is: what is near each other mostly stays so, and what becomes smaller than a
    // pixel mostly lies in one.
    vec2 low = vec2(3.0e38);
    for (uint corner = 0u; corner < 3u; corner++) {
        vec4 canonical = canonical_of(seen[corner], seen[corner + 3u]);
        low = min(low, canonical.w > 0.0 ? canonical.xy / canonical.w : vec2(0.0));
    }
    uvec2 still = uvec2(clamp(low, vec2(0.0), min(2.0 * even_half_px(deep), vec2(65535.0))));
    scales[primitive] = uvec2(packHalf2x16(scale), still.x | still.y << 16);
}
