// Samples sorted into bins of like depth, and sums over each bin, by the threads of a workgroup together.
#ifndef DEEP_SHADING_RECONSTRUCT_DEPTH_BINS_GLSL
#define DEEP_SHADING_RECONSTRUCT_DEPTH_BINS_GLSL

#include "techniques/deep_shading/reconstruct/blur.glsl"

// Bins of a tile's samples: depths from its nearest to its farthest, evenly by their logarithms; and one for what is without end.
const uint DEPTH_COUNT = 32u;
const uint BIN_COUNT = 33u;
// Sums over bins are of whole numbers, so that the order of threads does not show: of these parts of a pixel, from pixels below
// these. 64 samples in each pixel of nine tiles stay below 2^30.
const float SUM_PARTS = 16.0;
const float MOST_SUMMED_PX = 256.0;

// Sums over samples of like depth, in parts of pixels.
struct BinBlock {
    uint count;
    int circle;
    int motion[2];
    int support[3];
    // Bits of depths, which compare as these do.
    uint nearest;
    uint farthest;
    // How far filters of any of them reach.
    uint reach_px[2];
    uint _unused;
};

// Bits of the nearest and farthest depths that have an end, from which bins are made.
shared uint nearest;
shared uint farthest;
shared BinBlock sums[BIN_COUNT];

BinBlock no_bin() {
    return BinBlock(0u, 0, int[](0, 0), int[](0, 0, 0), floatBitsToUint(NO_DEPTH), 0u, uint[](0u, 0u), 0u);
}

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

// By all threads.
void clear_bins(uint thread) {
    if (thread == 0u) {
        nearest = floatBitsToUint(NO_DEPTH);
        farthest = 0u;
    }
    if (thread < BIN_COUNT) {
        sums[thread] = no_bin();
    }
    barrier();
}

void add_to_bin(uint bin, BinBlock sum) {
    atomicAdd(sums[bin].count, sum.count);
    atomicAdd(sums[bin].circle, sum.circle);
    for (uint axis = 0u; axis < 2u; axis++) {
        atomicAdd(sums[bin].motion[axis], sum.motion[axis]);
        atomicMax(sums[bin].reach_px[axis], sum.reach_px[axis]);
    }
    for (uint part = 0u; part < 3u; part++) {
        atomicAdd(sums[bin].support[part], sum.support[part]);
    }
    atomicMin(sums[bin].nearest, sum.nearest);
    atomicMax(sums[bin].farthest, sum.farthest);
}

#endif
