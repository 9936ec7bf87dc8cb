// Gather through workgroup memory: a workgroup reads a block's sub-blocks, one sub-buffer after the other, and writes
// the block row by row. Pass: src/techniques/interleaved_deferred/gather/tile.rs.
// variants: STORAGE=buffer|image
#version 460
#define READS_IRRADIANCE
#include "techniques/interleaved_deferred/sub_buffers.glsl"
#include "techniques/interleaved_deferred/gather/frame_order.glsl"

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;
// Texels of a block, and the threads that share them.
layout(constant_id = 2) const uint BLOCK_TEXELS = 256;
layout(constant_id = 3) const uint THREADS = 64;

layout(push_constant) uniform Push { MappingParams mapping; };

shared uvec2 block_irradiance[BLOCK_TEXELS];

// A workgroup a block.
void main() {
    uvec2 sub_block = sub_block_of(mapping);
    for (uint index = gl_LocalInvocationIndex; index < BLOCK_TEXELS; index += THREADS) {
        // Along the rows of a sub-block, sub-block after sub-block.
        uint row = index / sub_block.x;
        uvec3 moved = uvec3(index % sub_block.x, row % sub_block.y, row / sub_block.y);
        uvec3 texel = moved + uvec3(gl_WorkGroupID.xy * sub_block, 0u);
        uvec2 inside = pixel_of_texel(mapping, moved);
        block_irradiance[inside.y * mapping.block_x + inside.x] = load_irradiance(place_of_texel(mapping, texel));
    }
    barrier();
    uvec2 block_first = gl_WorkGroupID.xy * block_of(mapping);
    for (uint index = gl_LocalInvocationIndex; index < BLOCK_TEXELS; index += THREADS) {
        uvec2 inside = uvec2(index % mapping.block_x, index / mapping.block_x);
        store_pixel(mapping, block_first + inside, block_irradiance[index]);
    }
}
