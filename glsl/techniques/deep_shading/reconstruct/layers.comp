// The depths at which the surfaces in and around a tile are parted into layers, each filtered by itself: between layers blur
// differs, within a layer as little as four allow. Pass: src/techniques/deep_shading/reconstruct/layers.rs.
#version 460
#include "frame.glsl"
#include "techniques/deep_shading/reconstruct/depth_bins.glsl"

// Blur that differs by as much over all depths, where it is small, is worth one more layer.
const float LAYER_STEP_PX = 1.0;
// Where blur is wide the same difference shows less: it counts for one through 1 and this part of the blur.
const float WIDE_PART = 0.25;

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 36) writeonly buffer Tiles { TileBlock tiles[]; };
layout(std430, set = 0, binding = 37) readonly buffer Bins { BinBlock bins[]; };

// A bin's mean circle of confusion and motion.
vec3 mean_blur(uint bin) {
    return vec3(sums[bin].circle, sums[bin].motion[0], sums[bin].motion[1]) / (SUM_PARTS * float(sums[bin].count));
}

// How much two blurs differ as it shows.
float difference_of(vec3 from, vec3 to) {
    vec2 sizes = vec2(abs(from.x) + 0.5 * length(from.yz), abs(to.x) + 0.5 * length(to.yz));
    vec3 change = to - from;
    return (abs(change.x) + 0.5 * length(change.yz)) / (1.0 + WIDE_PART * min(sizes.x, sizes.y));
}

// By one thread: layers begin where a walk through all depths has gone its equal parts of the differences.
TileBlock parted() {
    vec2 scale = depth_scale();
    float whole = 0.0;
    float walked[BIN_COUNT];
    vec3 last = vec3(0.0);
    bool is_first = true;
    for (uint bin = 0u; bin < BIN_COUNT; bin++) {
        if (sums[bin].count > 0u) {
            vec3 blur = mean_blur(bin);
            whole += is_first ? 0.0 : difference_of(last, blur);
            last = blur;
            is_first = false;
        }
        walked[bin] = whole;
    }
    float layers = min(float(LAYER_COUNT), 1.0 + floor(whole / LAYER_STEP_PX));
    float begins[LAYER_COUNT - 1u] = float[](2.0 * NO_DEPTH, 2.0 * NO_DEPTH, 2.0 * NO_DEPTH);
    vec4 means[LAYER_COUNT] = vec4[](vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
    uvec2 reach_px = uvec2(0u);
    uint layer = 0u;
    for (uint bin = 0u; bin < BIN_COUNT; bin++) {
        if (sums[bin].count == 0u) {
            continue;
        }
        // A step over several parts leaves layers empty between.
        while (layer + 1u < LAYER_COUNT && float(layer + 1u) < layers &&
               walked[bin] * layers >= whole * float(layer + 1u)) {
            begins[layer] = bin == DEPTH_COUNT ? NO_DEPTH : scale.x * exp2(float(bin) / scale.y);
            layer++;
        }
        BinBlock sum = sums[bin];
        means[layer] += vec4(sum.support[0], sum.support[1], sum.support[2], SUM_PARTS * float(sum.count));
        reach_px = max(reach_px, uvec2(sum.reach_px[0], sum.reach_px[1]));
    }
    for (layer = 0u; layer < LAYER_COUNT; layer++) {
        means[layer] = means[layer].w > 0.0 ? means[layer] / means[layer].w : vec4(1.0, 0.0, 1.0, 0.0);
    }
    vec4 first_begins = vec4(begins[0], begins[1], begins[2], 0.0);
    return TileBlock(first_begins, means[0], means[1], means[2], means[3], reach_px.x, reach_px.y, uint[](0u, 0u));
}

// One of the bins of tiles from `begin` on, `width` of them in a row, of a frame that is so many tiles across.
BinBlock bin_around(uvec2 begin, uint width, uint tiles_across, uint at) {
    uint around = at / BIN_COUNT;
    uvec2 tile = begin + uvec2(around % width, around / width);
    return bins[(tile.y * tiles_across + tile.x) * BIN_COUNT + at % BIN_COUNT];
}

void main() {
    uvec2 tile = gl_WorkGroupID.xy;
    uint own = gl_LocalInvocationIndex;
    // A band of the frame has fewer workgroups.
    uvec2 tile_counts = (uvec2(frame.width_px, frame.height_px) + TILE_PX - 1u) / TILE_PX;
    // The tile and those around it: filters of theirs may reach into it.
    uvec2 begin = uvec2(max(ivec2(tile) - 1, ivec2(0)));
    uvec2 size = min(tile + 2u, tile_counts) - begin;
    uint bin_count = size.x * size.y * BIN_COUNT;
    clear_bins(own);
    for (uint at = own; at < bin_count; at += gl_WorkGroupSize.x) {
        BinBlock bin = bin_around(begin, size.x, tile_counts.x, at);
        if (bin.count > 0u) {
            atomicMin(nearest, bin.nearest);
            atomicMax(farthest, at % BIN_COUNT < DEPTH_COUNT ? bin.farthest : 0u);
        }
    }
    barrier();
    // Each tile has bins of its own depths, which come into the bins of all nine by where they begin.
    vec2 scale = depth_scale();
    for (uint at = own; at < bin_count; at += gl_WorkGroupSize.x) {
        BinBlock bin = bin_around(begin, size.x, tile_counts.x, at);
        if (bin.count > 0u) {
            add_to_bin(bin_of(uintBitsToFloat(bin.nearest), scale), bin);
        }
    }
    barrier();
    if (own == 0u) {
        tiles[tile.y * tile_counts.x + tile.x] = parted();
    }
}
