// The Gaussian's walk along a line of texels, which stops at discontinuities: Segovia 2006, section 4.5. gauss.comp
// walks both ways; passes that are fused with it (--fuse) walk one of them. Twin: tests/passes/filter.rs.
//
// The including shader has TEXELS: texels that a thread filters, one after the other along the line, so that it reads once
// what they share.
#ifndef PASSES_FILTER_WALK_GLSL
#define PASSES_FILTER_WALK_GLSL

#include "passes/gbuffer.glsl"

struct WalkParams {
    // Weights of the taps 1 to 4 and 5 to 8 beside the middle, whose weight is 1.
    vec4 weights_near;
    vec4 weights_far;
    // Bits of the flags that end a walk in this direction.
    uint stop_bits;
    uint _unused[3];
};

// Taps on either side of the middle.
layout(constant_id = 8) const uint RADIUS = 2;

// Whether a walk leaves its loop where it ends (dynamic branching), or goes on with weights of 0 (a flag).
layout(constant_id = 115) const bool WALK_BRANCHES = false;

const uint WINDOW = TEXELS + 2u * RADIUS;

vec3 window_value[WINDOW];
// Whether a walk may continue from a texel to the one after it, and back: not where a flag says that the two differ,
// and not over the frame's edge.
bool window_open_after[WINDOW];

// Where the i-th texel of the window lies on a line of which the thread filters the texels from `first` on. It may lie
// beside the line: what stands in for it is never blended.
int window_place(uint first, uint i) {
    return int(first) + int(i) - int(RADIUS);
}

void set_window(WalkParams walk, uint i, int place, uint length, uvec2 words, uint flag_bits) {
    window_value[i] = unpack_halves(words);
    window_open_after[i] = place >= 0 && place + 1 < int(length) && (flag_bits & walk.stop_bits) == 0u;
}

float weight_of(WalkParams walk, uint tap) {
    return tap <= 4u ? walk.weights_near[tap - 1u] : walk.weights_far[tap - 5u];
}

// The i-th texel of the thread, blended, as packed halves.
uvec2 walked(WalkParams walk, uint i) {
    uint middle = i + RADIUS;
    precise vec3 sum = window_value[middle];
    precise float weights = 1.0;
    bool open = true;
    for (uint tap = 1u; tap <= RADIUS; tap++) {
        open = open && window_open_after[middle + tap - 1u];
        if (WALK_BRANCHES && !open) {
            break;
        }
        // A weight of 0 adds exactly nothing: irradiance is finite.
        float weight = open ? weight_of(walk, tap) : 0.0;
        sum += window_value[middle + tap] * weight;
        weights += weight;
    }
    open = true;
    for (uint tap = 1u; tap <= RADIUS; tap++) {
        open = open && window_open_after[middle - tap];
        if (WALK_BRANCHES && !open) {
            break;
        }
        float weight = open ? weight_of(walk, tap) : 0.0;
        sum += window_value[middle - tap] * weight;
        weights += weight;
    }
    return pack_halves(sum / weights, 0u);
}

#endif
