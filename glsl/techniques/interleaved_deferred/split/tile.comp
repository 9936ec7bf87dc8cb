// Split through workgroup memory: a workgroup loads a block of the G-buffer row by row and writes it out by sub-buffer,
// so that neither side is scattered (later practice; Segovia 2006, section 3.3 needs two passes for it).
// Pass: src/techniques/interleaved_deferred/split/tile.rs.
// variants: POSITION=half|unorm16|depth|float STORAGE=buffer|image COLOR=off|on
#version 460
#include "passes/gbuffer.glsl"
#define WRITES_SURFACE
#include "techniques/interleaved_deferred/sub_buffers.glsl"
#include "techniques/interleaved_deferred/split/surface_of_frame.glsl"

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;
// Texels of a block, and the threads that share them.
layout(constant_id = 2) const uint BLOCK_TEXELS = 256;
layout(constant_id = 3) const uint THREADS = 64;

layout(push_constant) uniform Push { MappingParams mapping; };

shared POSITION_WORDS block_position[BLOCK_TEXELS];
shared uvec2 block_normal[BLOCK_TEXELS];
#ifdef HAS_COLOR
shared uvec2 block_color[BLOCK_TEXELS];
#endif

// A workgroup a block.
void main() {
    uvec2 block_first = gl_WorkGroupID.xy * block_of(mapping);
    for (uint index = gl_LocalInvocationIndex; index < BLOCK_TEXELS; index += THREADS) {
        uvec2 inside = uvec2(index % mapping.block_x, index / mapping.block_x);
        SurfaceTexel texel = surface_of_frame(mapping, block_first + inside);
        block_position[index] = texel.position;
        block_normal[index] = texel.normal;
#ifdef HAS_COLOR
        block_color[index] = texel.color;
#endif
    }
    barrier();
    uvec2 sub_block = sub_block_of(mapping);
    for (uint index = gl_LocalInvocationIndex; index < BLOCK_TEXELS; index += THREADS) {
        // Along the rows of a sub-block, sub-block after sub-block.
        uint row = index / sub_block.x;
        uvec3 moved = uvec3(index % sub_block.x, row % sub_block.y, row / sub_block.y);
        PLACE place = place_of_texel(mapping, moved + uvec3(gl_WorkGroupID.xy * sub_block, 0u));
        uvec2 inside = pixel_of_texel(mapping, moved);
        uint from = inside.y * mapping.block_x + inside.x;
        SurfaceTexel texel;
        texel.position = block_position[from];
        texel.normal = block_normal[from];
#ifdef HAS_COLOR
        texel.color = block_color[from];
#endif
        store_surface(place, texel);
    }
}
