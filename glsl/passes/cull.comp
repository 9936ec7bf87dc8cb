// Light masks for the tiles of a G-buffer. Pass: src/passes/cull.rs.
// variants: POSITION=half|unorm16|depth|float BY=invocation|workgroup
#version 460
#include "passes/gbuffer_read.glsl"

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };

bool has_surface_at(uvec2 pixel) {
    return has_surface(normal_words(pixel));
}

vec3 position_at(uvec2 pixel) {
    return unpack_position(frame, position_words(pixel), pixel);
}

#include "passes/tile_masks.glsl"

void main() {
    write_masks();
}
