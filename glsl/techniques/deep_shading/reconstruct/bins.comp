// A tile's samples by depth: how many lie where, and how far they are blurred. Pass:
// src/techniques/deep_shading/reconstruct/bins.rs.
#version 460
#include "techniques/deep_shading/buffer_addresses.glsl"
#include "frame.glsl"
#include "techniques/deep_shading/space.glsl"
#include "techniques/deep_shading/reconstruct/depth_bins.glsl"

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 2) readonly buffer Deep { DeepBlock deep; };
layout(std430, set = 0, binding = 34) readonly buffer SampleColors { uvec2 sample_colors[]; };
layout(std430, set = 0, binding = 35) readonly buffer SampleVectors { uvec2 sample_vectors[]; };
layout(std430, set = 0, binding = 37) writeonly buffer Bins { BinBlock bins[]; };
layout(std430, set = 0, binding = 39) readonly buffer BufferAddresses { BufferAddressBlock buffer_addresses; };

READS_PAIRS(colors_of, sample_colors)
READS_PAIRS(vectors_of, sample_vectors)

void main() {
    uint own = gl_LocalInvocationIndex;
    uvec2 frame_px = uvec2(frame.width_px, frame.height_px);
    uvec2 begin = gl_WorkGroupID.xy * TILE_PX;
    uvec2 size = min(begin + TILE_PX, frame_px) - begin;
    uint pixel_count = size.x * size.y;
    clear_bins(own);
    uint own_nearest = floatBitsToUint(NO_DEPTH);
    uint own_farthest = 0u;
    for (uint at = own; at < pixel_count; at += gl_WorkGroupSize.x) {
        uvec2 pixel = begin + uvec2(at % size.x, at / size.x);
        for (uint index = 0u; index < deep.sample_count; index++) {
            uint bits = vectors_of(entry_of(frame_px, pixel, index)).y;
            own_nearest = min(own_nearest, bits);
            own_farthest = max(own_farthest, uintBitsToFloat(bits) < NO_DEPTH ? bits : 0u);
        }
    }
    atomicMin(nearest, own_nearest);
    atomicMax(farthest, own_farthest);
    barrier();
    vec2 scale = depth_scale();
    Parts parts = parts_of(deep.sample_count);
    for (uint at = own; at < pixel_count; at += gl_WorkGroupSize.x) {
        uvec2 pixel = begin + uvec2(at % size.x, at / size.x);
        // Most samples of a pixel follow others into the same bin, and are summed up first.
        uint last = BIN_COUNT;
        BinBlock sum = no_bin();
        for (uint index = 0u; index < deep.sample_count; index++) {
            uint entry = entry_of(frame_px, pixel, index);
            Blur blur = blur_of(colors_of(entry), vectors_of(entry));
            uint bin = bin_of(blur.depth, scale);
            if (bin != last) {
                if (last < BIN_COUNT) {
                    add_to_bin(last, sum);
                }
                last = bin;
                sum = no_bin();
            }
            vec3 support = support_of(blur, parts);
            sum.count++;
            sum.circle += summed(blur.circle_px);
            sum.motion[0] += summed(blur.motion_px.x);
            sum.motion[1] += summed(blur.motion_px.y);
            for (uint part = 0u; part < 3u; part++) {
                sum.support[part] += summed(support[part]);
            }
            sum.nearest = min(sum.nearest, floatBitsToUint(blur.depth));
            sum.farthest = max(sum.farthest, floatBitsToUint(blur.depth));
            // Pixels whose middles are inside.
            sum.reach_px[0] = max(sum.reach_px[0], uint(ceil(sqrt(support.x))) - 1u);
            sum.reach_px[1] = max(sum.reach_px[1], uint(ceil(sqrt(support.z))) - 1u);
        }
        add_to_bin(last, sum);
    }
    barrier();
    uint tile = gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x;
    if (own < BIN_COUNT) {
        bins[tile * BIN_COUNT + own] = sums[own];
    }
}
