// The loop over the punctual lights that may reach a pixel, in the order of the list: all of them, or with the axis
// CULL=tiled those of its tile's mask.
//
// The including shader declares `lights[]`, `light_masks[]` with CULL=tiled, and `add_light`, which takes one of them.
#ifndef SHADING_EACH_LIGHT_GLSL
#define SHADING_EACH_LIGHT_GLSL

#include "passes/cull.glsl"
#include "loops.glsl"

// `pixel`: of a frame of this extent, in it.
void add_each_light(FrameBlock frame, uvec2 pixel) {
#ifdef CULL_TILED
    uint word_count = (frame.light_count + 31u) / 32u;
    uint base = tile_of(pixel, frame.width_px) * word_count;
    uint bits = 0u;
    uint word = 0u;
    for (; word < word_count; word++) {
        bits = light_masks[base + word];
        while (bits != 0u) {
            uint light = word * 32u + uint(findLSB(bits));
            bits &= bits - 1u;
            add_light(lights[light]);
        }
    }
    expect_done(bits == 0u && word == word_count);
#else
    uint light = 0u;
    for (; light < frame.light_count; light++) {
        add_light(lights[light]);
    }
    expect_done(light == frame.light_count);
#endif
}

#endif
