// Light masks for the tiles of the light buffer. Pass: src/techniques/inferred_lighting/cull.rs.
// variants: BY=invocation|workgroup
#version 460
#include "frame.glsl"
#include "bvh.glsl"

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };

#include "techniques/inferred_lighting/surface.glsl"
#include "passes/tile_masks.glsl"

void main() {
    write_masks();
}
