// A polygon around all that a triangle covers while the shutter is open, drawn once over the frame: each of a pixel's samples is
// tested in turn, and keeps what is nearest by an atomic maximum of depth and triangle (section 4.2).
// Pass: src/techniques/deep_shading/visibility/looped.rs.
// variants: ALPHA=opaque|tested VERTEX=plain|extended COUNT=off|on
#version 460
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require
#include "frame.glsl"
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/place.glsl"
#include "techniques/deep_shading/counting.glsl"
#include "techniques/deep_shading/visibility/covers.glsl"
#include "techniques/deep_shading/visibility/seen.glsl"
#include "techniques/deep_shading/visibility/triangle.glsl"
#include "techniques/deep_shading/visibility/nearest.glsl"
#include "techniques/deep_shading/visibility/polygon_in.glsl"
#include "techniques/deep_shading/own_samples.glsl"

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 4) readonly buffer Tuples { TupleBlock tuples[]; };
layout(std430, set = 0, binding = 20) buffer Nearest { uint64_t nearest[]; };

#include "techniques/deep_shading/visibility/hit.glsl"
#include "techniques/deep_shading/visibility/place_alpha.glsl"

void main() {
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    uvec2 table = uvec2(deep.table_width_px, deep.table_height_px);
    uvec2 layer_px = pixel / table;
    uvec2 cell = pixel % table;
    uint triangle = in_primitive - params.primitive_offset;
    // A sample is the middle of its layer's pixel: the tuple's shift has put it there.
    vec2 at = vec2(layer_px) + 0.5;
    // `params.tuple`: the first of the eye.
    uint first = params.tuple + (cell.y * table.x + cell.x) * deep.sample_count;
    Turns turns = turns_of(pixel);
    Swept swept = swept_triangle(frame.width_px, frame.height_px);
    for (uint index = 0u; index < deep.sample_count; index++) {
        uint own = first + index;
        TupleBlock tuple = turned_tuple(tuples[frame.sample_index * deep.tuple_count + own], turns);
        vec3 weights;
        float depth;
        if (!is_hit(swept, tuple, pixel, at, weights, depth)) {
            continue;
        }
#ifdef ALPHA_TESTED
        place_alpha(hit_place(tuple, at, weights), 3u * triangle);
        if (!is_seen(base_color_at(params.material).a, layer_px, tuple_number(deep, frame.sample_index, own))) {
            continue;
        }
#endif
        if (depth > 0.0) {
            uvec2 words = nearest_words(depth, triangle + params.order_offset);
            atomicMax(nearest[sample_index(deep, uvec3(layer_px, own))], packUint2x32(words));
        }
    }
    count_tests();
}
