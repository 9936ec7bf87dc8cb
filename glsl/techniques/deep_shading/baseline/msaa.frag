// Stochastic multisampling: a pixel tests its samples against a triangle, each at its own place, time and place on the lens,
// and is shaded once for all that see it (section 6, "MSAA"; McGuire et al. 2010).
// Pass: src/techniques/deep_shading/baseline/msaa.rs.
// variants: ALPHA=opaque|tested VERTEX=plain|extended SHADOWS=traced|mapped COUNT=off|on
#version 460
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/surface.glsl"
#include "techniques/deep_shading/counting.glsl"

// Samples a pixel of the attachments.
layout(constant_id = 98) const uint PASS_SAMPLES = 1;

// As in msaa.vert.
layout(location = 10) flat in vec2 in_along;
layout(location = 11) flat in vec4 in_range;

// surface.glsl calls the middle of the exposure `frame`.
layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock run; };
layout(std430, set = 0, binding = 4) readonly buffer Tuples { TupleBlock tuples[]; };

#include "techniques/deep_shading/visibility/seen.glsl"
#include "techniques/deep_shading/visibility/triangle.glsl"
#include "techniques/deep_shading/visibility/polygon_in.glsl"
#include "techniques/deep_shading/own_samples.glsl"
#include "techniques/deep_shading/visibility/covers.glsl"
#include "techniques/deep_shading/visibility/hit.glsl"
#include "techniques/deep_shading/baseline/box.glsl"
#ifdef ALPHA_TESTED
#include "techniques/deep_shading/alpha.glsl"
#endif

layout(location = 0) out vec4 out_color;

const uint MOST_PASS_SAMPLES = 8u;

void main() {
    // Half of the triangle around a box is not the box.
    if (!may_touch(Box(in_along, in_range.xy, in_range.zw), gl_FragCoord.xy)) {
        discard;
    }
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    uvec2 table = uvec2(deep.table_width_px, deep.table_height_px);
    uvec2 layer_px = pixel / table;
    uvec2 cell = pixel % table;
    // `params.tuple`: of the pass, its first in each cell.
    uint first = run.sample_index * deep.tuple_count + (cell.y * table.x + cell.x) * deep.sample_count + params.tuple;
    uint covered = 0u;
    float depths[MOST_PASS_SAMPLES];
    Place shaded;
    Turns turns = turns_of(pixel);
    Swept swept = swept_triangle(run.width_px, run.height_px);
    for (uint index = 0u; index < PASS_SAMPLES; index++) {
        TupleBlock tuple = turned_tuple(tuples[first + index], turns);
        vec2 at = vec2(layer_px) + 0.5;
        vec3 weights;
        // A driver may have cut what it draws into pieces, each of which runs the pixel with samples of its own.
        bool is_own = (gl_SampleMaskIn[0] & (1 << index)) != 0;
        if (!is_own || !is_hit(swept, tuple, pixel, at, weights, depths[index])) {
            continue;
        }
        if (covered == 0u) {
            shaded = hit_place(tuple, at, weights);
        }
        covered |= 1u << index;
    }
    count_tests();
    if (covered == 0u) {
        discard;
    }
    // A layer's pixels are a table apart.
    shaded.right /= float(table.x);
    shaded.down /= float(table.y);
    stand_at(in_primitive, shaded);
    vec4 base_color = base_color_at(params.material);
#ifdef ALPHA_TESTED
    for (uint index = 0u; index < PASS_SAMPLES; index++) {
        if (!is_seen(base_color.a, layer_px, first + index)) {
            covered &= ~(1u << index);
        }
    }
    if (covered == 0u) {
        discard;
    }
#endif
    float depth = 0.0;
    for (uint index = 0u; index < PASS_SAMPLES; index++) {
        depth += (covered & (1u << index)) != 0u ? depths[index] : 0.0;
    }
    gl_FragDepth = depth / float(bitCount(covered));
    gl_SampleMask[0] = int(covered);
    out_color = attached_color(color_of_base(base_color));
    count(COUNTED_SHADED);
}
