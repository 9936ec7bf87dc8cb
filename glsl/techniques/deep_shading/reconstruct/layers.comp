// The depths at which the surfaces in and around a tile are parted into layers, each filtered by itself: between layers blur
// differs, within a layer as little as four allow. Pass: src/techniques/deep_shading/reconstruct/layers.rs.
#version 460
#include "techniques/deep_shading/buffer_addresses.glsl"
#include "frame.glsl"
#include "techniques/deep_shading/space.glsl"
#include "techniques/deep_shading/reconstruct/blur.glsl"

// Depths from the nearest to the farthest, evenly by their logarithms; and one for what is without end.
const uint DEPTH_COUNT = 32u;
const uint BIN_COUNT = DEPTH_COUNT + 1u;
// Sums are of whole numbers, so that the order of threads does not show: of these parts of a pixel, from pixels below these.
// 64 samples in each pixel of nine tiles stay below 2^30.
const float SUM_PARTS = 16.0;
const float MOST_SUMMED_PX = 256.0;
// Blur that differs by as much over all depths, where it is small, is worth one more layer.
const float LAYER_STEP_PX = 1.0;
// Where blur is wide the same difference shows less: it counts for one through 1 and this part of the blur.
const float WIDE_PART = 0.25;

layout(local_size_x = 64) in;

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 2) readonly buffer Deep { DeepBlock deep; };
layout(std430, set = 0, binding = 34) readonly buffer SampleColors { uvec2 sample_colors[]; };
layout(std430, set = 0, binding = 35) readonly buffer SampleVectors { uvec2 sample_vectors[]; };
layout(std430, set = 0, binding = 36) writeonly buffer Tiles { TileBlock tiles[]; };
layout(std430, set = 0, binding = 39) readonly buffer BufferAddresses { BufferAddressBlock buffer_addresses; };

READS_PAIRS(colors_of, sample_colors)
READS_PAIRS(vectors_of, sample_vectors)

// Bits of depths, which compare as these do.
shared uint nearest;
shared uint farthest;
shared uint reach_px[2];
shared int counts[BIN_COUNT];
shared int circles[BIN_COUNT];
shared int motions[BIN_COUNT][2];
shared int supports[BIN_COUNT][3];

int summed(float pixels) {
    return int(round(SUM_PARTS * clamp(pixels, -MOST_SUMMED_PX, MOST_SUMMED_PX)));
}

// The nearest depth, and how many bins a doubling of it takes.
vec2 depth_scale() {
    float from = uintBitsToFloat(nearest);
    float doublings = log2(max(uintBitsToFloat(farthest), from) / from);
    return vec2(from, float(DEPTH_COUNT) / max(doublings, 1e-3));
}

uint bin_of(float depth, vec2 scale) {
    return depth >= NO_DEPTH ? DEPTH_COUNT : min(uint(max(log2(depth / scale.x), 0.0) * scale.y), DEPTH_COUNT - 1u);
}

// A bin's mean circle of confusion and motion.
vec3 mean_blur(uint bin) {
    return vec3(circles[bin], motions[bin][0], motions[bin][1]) / (SUM_PARTS * float(counts[bin]));
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
        if (counts[bin] > 0) {
            vec3 blur = mean_blur(bin);
            whole += is_first ? 0.0 : difference_of(last, blur);
            last = blur;
            is_first = false;
        }
        walked[bin] = whole;
    }
    float layers = min(float(LAYER_COUNT), 1.0 + floor(whole / LAYER_STEP_PX));
    float begins[LAYER_COUNT - 1u] = float[](2.0 * NO_DEPTH, 2.0 * NO_DEPTH, 2.0 * NO_DEPTH);
    vec4 sums[LAYER_COUNT] = vec4[](vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
    uint layer = 0u;
    for (uint bin = 0u; bin < BIN_COUNT; bin++) {
        if (counts[bin] == 0) {
            continue;
        }
        // A step over several parts leaves layers empty between.
        while (layer + 1u < LAYER_COUNT && float(layer + 1u) < layers &&
               walked[bin] * layers >= whole * float(layer + 1u)) {
            begins[layer] = bin == DEPTH_COUNT ? NO_DEPTH : scale.x * exp2(float(bin) / scale.y);
            layer++;
        }
        sums[layer] += vec4(supports[bin][0], supports[bin][1], supports[bin][2], SUM_PARTS * float(counts[bin]));
    }
    for (layer = 0u; layer < LAYER_COUNT; layer++) {
        sums[layer] = sums[layer].w > 0.0 ? sums[layer] / sums[layer].w : vec4(1.0, 0.0, 1.0, 0.0);
    }
    return TileBlock(
        vec4(begins[0], begins[1], begins[2], 0.0), sums[0], sums[1], sums[2], sums[3], reach_px[0], reach_px[1], uint[](0u, 0u));
}

void main() {
    uvec2 tile = gl_WorkGroupID.xy;
    uint own = gl_LocalInvocationIndex;
    uvec2 frame_px = uvec2(frame.width_px, frame.height_px);
    // The tile and those around it: filters of theirs may reach into it.
    uvec2 begin = uvec2(max(ivec2(tile) - 1, ivec2(0))) * TILE_PX;
    uvec2 size = min((tile + 2u) * TILE_PX, frame_px) - begin;
    uint pixel_count = size.x * size.y;
    if (own == 0u) {
        nearest = floatBitsToUint(NO_DEPTH);
        farthest = 0u;
        reach_px[0] = 0u;
        reach_px[1] = 0u;
    }
    if (own < BIN_COUNT) {
        counts[own] = 0;
        circles[own] = 0;
        motions[own] = int[](0, 0);
        supports[own] = int[](0, 0, 0);
    }
    barrier();
    for (uint at = own; at < pixel_count; at += gl_WorkGroupSize.x) {
        uvec2 pixel = begin + uvec2(at % size.x, at / size.x);
        for (uint index = 0u; index < deep.sample_count; index++) {
            uint bits = vectors_of(entry_of(frame_px, pixel, index)).y;
            atomicMin(nearest, bits);
            if (uintBitsToFloat(bits) < NO_DEPTH) {
                atomicMax(farthest, bits);
            }
        }
    }
    barrier();
    vec2 scale = depth_scale();
    for (uint at = own; at < pixel_count; at += gl_WorkGroupSize.x) {
        uvec2 pixel = begin + uvec2(at % size.x, at / size.x);
        for (uint index = 0u; index < deep.sample_count; index++) {
            uint entry = entry_of(frame_px, pixel, index);
            Blur blur = blur_of(colors_of(entry), vectors_of(entry));
            uint bin = bin_of(blur.depth, scale);
            vec3 support = support_of(blur);
            atomicAdd(counts[bin], 1);
            atomicAdd(circles[bin], summed(blur.circle_px));
            atomicAdd(motions[bin][0], summed(blur.motion_px.x));
            atomicAdd(motions[bin][1], summed(blur.motion_px.y));
            for (uint part = 0u; part < 3u; part++) {
                atomicAdd(supports[bin][part], summed(support[part]));
            }
            // Pixels whose middles are inside.
            atomicMax(reach_px[0], uint(ceil(sqrt(support.x))) - 1u);
            atomicMax(reach_px[1], uint(ceil(sqrt(support.z))) - 1u);
        }
    }
    barrier();
    if (own == 0u) {
        tiles[tile.y * gl_NumWorkGroups.x + tile.x] = parted();
    }
}
