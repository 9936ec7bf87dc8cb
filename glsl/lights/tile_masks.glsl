// A mask of lights for each tile: those whose sphere touches the box around the tile's surface points.
//
// The including shader has `has_surface_at(pixel)` and `position_at(pixel)`, world space, of a frame's surface, and declares
// `frame`.
#ifndef LIGHTS_TILE_MASKS_GLSL
#define LIGHTS_TILE_MASKS_GLSL

#include "lights/cull.glsl"
#include "shading/light.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 1) readonly buffer Lights { LightBlock lights[]; };
layout(std430, set = 0, binding = 4) writeonly buffer LightMasks { uint light_masks[]; };

// One invocation a tile: no shared memory, which costs most on a processor.
void write_masks() {
    uint tile = gl_GlobalInvocationID.x;
    uint tiles_x = (frame.width_px + TILE_PX - 1u) / TILE_PX;
    uint tiles_y = (frame.height_px + TILE_PX - 1u) / TILE_PX;
    if (tile >= tiles_x * tiles_y) {
        return;
    }
    uvec2 first = uvec2(tile % tiles_x, tile / tiles_x) * TILE_PX;
    uvec2 end = min(first + TILE_PX, uvec2(frame.width_px, frame.height_px));
    vec3 box_min = vec3(1e30);
    vec3 box_max = vec3(-1e30);
    for (uint y = first.y; y < end.y; y++) {
        for (uint x = first.x; x < end.x; x++) {
            uvec2 pixel = uvec2(x, y);
            if (has_surface_at(pixel)) {
                vec3 position_ws = position_at(pixel);
                box_min = min(box_min, position_ws);
                box_max = max(box_max, position_ws);
            }
        }
    }
    uint word_count = (frame.light_count + 31u) / 32u;
    for (uint word = 0u; word < word_count; word++) {
        uint bits = 0u;
        uint count = min(32u, frame.light_count - word * 32u);
        for (uint bit = 0u; bit < count; bit++) {
            LightBlock light = lights[word * 32u + bit];
            vec3 center = light.position_ws.xyz;
            vec3 away = max(max(box_min - center, center - box_max), vec3(0.0));
            float range = light.intensity.w;
            // A hair more than the range: rounding must never drop a light that the window still lets through.
            bool touches = dot(away, away) <= range * range * 1.0001;
            bool endless = light.kind == LIGHT_DIRECTIONAL || range == 0.0;
            if (box_min.x <= box_max.x && (endless || touches)) {
                bits |= 1u << bit;
            }
        }
        light_masks[tile * word_count + word] = bits;
    }
}

#endif
