// A mask of lights for each tile: those whose sphere touches the box around the tile's surface points.
//
// The including shader has `has_surface_at(pixel)` and `position_at(pixel)`, world space, of a frame's surface, declares
// `frame`, and has the axis BY: what a tile's box and mask are made by.
#ifndef LIGHTS_TILE_MASKS_GLSL
#define LIGHTS_TILE_MASKS_GLSL

#include "passes/cull.glsl"
#include "shading/light.glsl"
#include "shading/light_box.glsl"

const uint THREADS = 64u;
layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 1) readonly buffer Lights { LightBlock lights[]; };
layout(std430, set = 0, binding = 4) writeonly buffer LightMasks { uint light_masks[]; };

void include_pixel(inout Box box, uvec2 pixel) {
    if (has_surface_at(pixel)) {
        include_point(box, position_at(pixel));
    }
}

#ifdef BY_INVOCATION
// No shared memory, which costs most on a processor.
void write_masks() {
    uint tile = gl_GlobalInvocationID.x;
    uint tiles_x = (frame.width_px + TILE_PX - 1u) / TILE_PX;
    uint tiles_y = (frame.height_px + TILE_PX - 1u) / TILE_PX;
    if (tile >= tiles_x * tiles_y) {
        return;
    }
    uvec2 first = uvec2(tile % tiles_x, tile / tiles_x) * TILE_PX;
    uvec2 end = min(first + TILE_PX, uvec2(frame.width_px, frame.height_px));
    Box box = NO_BOX;
    for (uint y = first.y; y < end.y; y++) {
        for (uint x = first.x; x < end.x; x++) {
            include_pixel(box, uvec2(x, y));
        }
    }
    uint word_count = (frame.light_count + 31u) / 32u;
    for (uint word = 0u; word < word_count; word++) {
        uint bits = 0u;
        uint count = min(32u, frame.light_count - word * 32u);
        for (uint bit = 0u; bit < count; bit++) {
            if (is_touched(box, lights[word * 32u + bit])) {
                bits |= 1u << bit;
            }
        }
        light_masks[tile * word_count + word] = bits;
    }
}
#else
shared vec3 least_of[THREADS];
shared vec3 greatest_of[THREADS];
// Bits of as many lights as there are threads.
shared uint found[THREADS / 32u];

// A tile's pixels are read side by side and its lights tried so: one thread alone leaves most of a GPU without work.
void write_masks() {
    uint thread = gl_LocalInvocationIndex;
    uvec2 first = gl_WorkGroupID.xy * TILE_PX;
    uint tiles_x = (frame.width_px + TILE_PX - 1u) / TILE_PX;
    uint tile = gl_WorkGroupID.y * tiles_x + gl_WorkGroupID.x;
    Box box = NO_BOX;
    for (uint index = thread; index < TILE_PX * TILE_PX; index += THREADS) {
        uvec2 pixel = first + uvec2(index % TILE_PX, index / TILE_PX);
        if (pixel.x < frame.width_px && pixel.y < frame.height_px) {
            include_pixel(box, pixel);
        }
    }
    least_of[thread] = box.least;
    greatest_of[thread] = box.greatest;
    for (uint half_count = THREADS / 2u; half_count > 0u; half_count /= 2u) {
        barrier();
        if (thread < half_count) {
            least_of[thread] = min(least_of[thread], least_of[thread + half_count]);
            greatest_of[thread] = max(greatest_of[thread], greatest_of[thread + half_count]);
        }
    }
    barrier();
    box = Box(least_of[0], greatest_of[0]);
    uint word_count = (frame.light_count + 31u) / 32u;
    for (uint word = 0u; word < word_count; word += THREADS / 32u) {
        // The thread that clears a word is the one that has written it out before.
        if (thread < THREADS / 32u) {
            found[thread] = 0u;
        }
        barrier();
        uint index = word * 32u + thread;
        if (index < frame.light_count && is_touched(box, lights[index])) {
            atomicOr(found[thread / 32u], 1u << thread % 32u);
        }
        barrier();
        if (thread < THREADS / 32u && word + thread < word_count) {
            light_masks[tile * word_count + word + thread] = found[thread];
        }
    }
}
#endif

#endif
