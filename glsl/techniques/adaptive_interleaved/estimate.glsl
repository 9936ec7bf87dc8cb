// A texel's estimate of one component, iteration by iteration: the part of Listing 1 (Dubla 2009, section 3.1) that all
// components share. What differs is the component's own file (component.glsl).
//
// The including shader has the axes POSITION and COMPONENT.
#ifndef ADAPTIVE_INTERLEAVED_ESTIMATE_GLSL
#define ADAPTIVE_INTERLEAVED_ESTIMATE_GLSL

// The component's file has its samples.
#define ESTIMATES

#include "passes/gbuffer_read.glsl"
#include "bvh.glsl"
#include "loops.glsl"
#include "shading/light.glsl"
#include "techniques/adaptive_interleaved/tile.glsl"

layout(push_constant) uniform Push { AdaptiveParams params; };
layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 1) readonly buffer BvhNodes { BvhNodeBlock bvh_nodes[]; };
layout(std430, set = 0, binding = 2) readonly buffer BvhTriangles { BvhTriangleBlock bvh_triangles[]; };
// Shadow rays of a texel.
layout(std430, set = 0, binding = 4) buffer Rays { uint rays[]; };
// The mean of the iterations, as halves.
layout(std430, set = 0, binding = 5) writeonly buffer Irradiance { uvec2 irradiance[]; };

#include "bvh_walk.glsl"

// What the pixel of a texel shows.
struct Point {
    uvec2 pixel;
    vec3 position_ws;
    vec3 normal_ws;
    bool has_surface;
};

struct Estimate {
    vec3 sum;
    // What guides: the component's own, summed over the iterations.
    float information;
    // Lights that were met in any of them, and in all, a bit each.
    uint lit_any;
    uint lit_all;
    uint ray_count;
};

// Weights of Rec. 709's primaries.
const vec3 LUMINANCE = vec3(0.2126, 0.7152, 0.0722);

const Estimate NO_ESTIMATE = Estimate(vec3(0.0), 0.0, 0u, 0xffffffffu, 0u);

Point point_at(uvec2 texel) {
    uvec2 pixel = texel * params.scale;
    uvec2 bits = normal_words(pixel);
    return Point(pixel, unpack_position(frame, position_words(pixel), pixel), unpack_normal(bits), has_surface(bits));
}

#include "techniques/adaptive_interleaved/component.glsl"

// Iterations `from` to `end`, without it.
void iterate(Point point, uint slot, uint from, uint end, inout Estimate estimate) {
    uint iteration = from;
    for (; iteration < end; iteration++) {
        contribute(point, slot, iteration, estimate);
    }
    expect_done(iteration == max(from, end));
}

// The initial pass of a texel.
Estimate initial_estimate(Point point, uint slot) {
    Estimate estimate = NO_ESTIMATE;
    if (is_estimated(point)) {
        iterate(point, slot, 0u, params.base, estimate);
    }
    return estimate;
}

// What guidance.glsl reads of it.
uint found_by(Point point, uint slot, Estimate estimate) {
    if (!is_estimated(point)) {
        return NOT_ESTIMATED;
    }
    if (params.until_error > 0.0) {
        return floatBitsToUint(dot(estimate.sum, LUMINANCE) / float(params.base));
    }
    return found_word(slot, estimate);
}

void write_mean(uint index, Estimate estimate, uint iteration_count) {
    precise vec3 mean = nan_if_cut(estimate.sum / float(iteration_count));
    irradiance[index] = pack_halves(mean, 0u);
    rays[index] = estimate.ray_count;
}

#endif
