// What the reconstruction reads of each sample: its colour, how far the lens spreads what it sees, how far that moves on the
// screen, and its depth (section 4.5). Found from its SPID and its tuple: whichever kind of visibility there was.
// Pass: src/techniques/deep_shading/reconstruct/samples.rs.
// variants: FETCH=own|address|linked|compact
#version 460
#define DRAW_OF_TRIANGLE
#include "techniques/deep_shading/buffer_addresses.glsl"
#include "frame.glsl"
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/place.glsl"
#include "techniques/deep_shading/ranges.glsl"
#include "techniques/deep_shading/visibility/seen.glsl"
#include "techniques/deep_shading/visibility/triangle.glsl"
#include "techniques/deep_shading/own_samples.glsl"
#include "techniques/deep_shading/reconstruct/blur.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 4) readonly buffer Tuples { TupleBlock tuples[]; };
layout(std430, set = 0, binding = 34) writeonly buffer SampleColors { uvec2 sample_colors[]; };
layout(std430, set = 0, binding = 35) writeonly buffer SampleVectors { uvec2 sample_vectors[]; };

#include "techniques/deep_shading/fetch.glsl"

WRITES_PAIRS(set_colors, sample_colors)
WRITES_PAIRS(set_vectors, sample_vectors)

// Pixels of the frame that a place `depth` metres before the eye is spread over, with this w of clip space.
float circle_at(float depth, float w) {
    return HAS_LENS != 0u ? 0.5 * float(frame.height_px) * deep.lens.y * lens_part(depth) / w : 0.0;
}

// Where nothing is: without end, and as the eye sees the farthest of it. All of it has one colour.
Blur blur_of_nothing() {
    // Far away w grows as depth does, and without perspective not at all.
    float farthest = 1.0 / max(deep.inverse_focus, 1e-6) * 1e4;
    float circle = circle_at(farthest, frame.eye_ws.w > 0.0 ? farthest : 1.0);
    return Blur(min(circle, MOST_BLUR_PX), vec2(0.0), NO_DEPTH);
}

// `layer_px`: in the tuple's layer.
Blur blur_of_sample(uint primitive, uvec2 layer_px, TupleBlock tuple) {
    Seen seen[6];
    see_triangle(find_draw(primitive), seen);
    vec4 corners[3];
    for (uint corner = 0u; corner < 3u; corner++) {
        corners[corner] = layer_corner(seen[corner], seen[corner + 3u], tuple);
    }
    vec3 weights = place_at(corners[0], corners[1], corners[2], vec2(layer_px) + 0.5).weights;
    mat3x4 open_clip = mat3x4(seen[0].clip, seen[1].clip, seen[2].clip);
    mat3x4 close_clip = mat3x4(seen[3].clip, seen[4].clip, seen[5].clip);
    vec4 open = open_clip * weights;
    vec4 change = close_clip * weights - open;
    vec4 clip = open + tuple.time * change;
    vec3 depths = mix(vec3(seen[0].depth, seen[1].depth, seen[2].depth),
        vec3(seen[3].depth, seen[4].depth, seen[5].depth), tuple.time);
    float depth = dot(depths, weights);
    // Seen at this moment, it is before the eye; at the shutter's ends it need not be.
    float w = max(clip.w, 1e-6);
    vec2 half_frame = 0.5 * vec2(frame.width_px, frame.height_px);
    vec2 motion = half_frame * (change.xy - clip.xy / w * change.w) / w;
    float most = MOST_BLUR_PX;
    return Blur(clamp(circle_at(depth, w), -most, most), clamp(motion, -most, most), max(depth, 1e-6));
}

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    uvec2 frame_px = uvec2(frame.width_px, frame.height_px);
    if (pixel.x >= frame_px.x || pixel.y >= frame_px.y) {
        return;
    }
    uvec2 table = uvec2(deep.table_width_px, deep.table_height_px);
    uvec2 cell = pixel % table;
    uint first = (cell.y * table.x + cell.x) * deep.sample_count;
    for (uint index = 0u; index < deep.sample_count; index++) {
        vec4 fetched = sample_at(pixel, first, index);
        Blur blur = blur_of_nothing();
        if (fetched.a >= 0.0) {
            uvec3 at = uvec3(pixel / table, first + index);
            uint primitive = texelFetch(spids, ivec3(at), 0).x;
            TupleBlock tuple = tuples[frame.sample_index * deep.tuple_count + at.z];
            blur = blur_of_sample(primitive, at.xy, turned_tuple(tuple, turns_of(pixel)));
        }
        uint entry = entry_of(frame_px, pixel, index);
        set_colors(entry, packed_colors(fetched.rgb, blur));
        set_vectors(entry, packed_vectors(blur));
    }
}
