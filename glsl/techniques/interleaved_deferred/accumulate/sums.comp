// A run's irradiance, added to the sums of its half of the runs (Segovia 2006, section 6.3), and the layer of what blends.
// Pass: src/techniques/interleaved_deferred/accumulate/sums.rs.
// variants: LAYER=off|on
#version 460
#include "passes/gbuffer.glsl"
#include "techniques/interleaved_deferred/mapping.glsl"

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;

struct RunSumsParams {
    MappingParams mapping;
    // Where the half's sums begin, in pixels.
    uint first_px;
    // Whether it is the first run of its half: sums begin with it.
    uint is_first;
};

layout(push_constant) uniform Push { RunSumsParams params; };
layout(std430, set = 0, binding = 0) readonly buffer Irradiance { uvec2 irradiance[]; };
layout(std430, set = 0, binding = 1) buffer Sums { vec4 sums[]; };
#ifdef LAYER_ON
layout(std430, set = 0, binding = 2) buffer LayerSums { vec4 layer_sums[]; };
layout(set = 0, binding = 3, rgba32f) readonly uniform image2D layer;
#endif

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.mapping.width_px || pixel.y >= params.mapping.height_px) {
        return;
    }
    vec4 sum = vec4(unpack_halves(irradiance[pixel.y * row_pitch(params.mapping) + pixel.x]), 0.0);
    uint index = params.first_px + pixel.y * params.mapping.width_px + pixel.x;
    if (params.is_first == 0u) {
        sum += sums[index];
    }
    sums[index] = sum;
#ifdef LAYER_ON
    vec4 layer_sum = imageLoad(layer, ivec2(pixel));
    if (params.is_first == 0u) {
        layer_sum += layer_sums[index];
    }
    layer_sums[index] = layer_sum;
#endif
}
