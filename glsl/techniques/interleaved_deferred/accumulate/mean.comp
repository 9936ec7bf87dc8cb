// The mean irradiance of all runs, or of a half of them, from their sums (Segovia 2006, section 6.3).
// Pass: src/techniques/interleaved_deferred/accumulate/mean.rs.
#version 460
#include "passes/gbuffer.glsl"
#include "techniques/interleaved_deferred/mapping.glsl"

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;

struct RunMeanParams {
    MappingParams mapping;
    // What the sums of even and of odd runs count; a half of weight 0 may hold anything.
    float even_weight;
    float odd_weight;
};

layout(push_constant) uniform Push { RunMeanParams params; };
layout(std430, set = 0, binding = 0) readonly buffer Sums { vec4 sums[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Irradiance { uvec2 irradiance[]; };

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    uvec2 extent = uvec2(params.mapping.width_px, params.mapping.height_px);
    if (pixel.x >= extent.x || pixel.y >= extent.y) {
        return;
    }
    uint index = pixel.y * extent.x + pixel.x;
    vec3 mean = vec3(0.0);
    if (params.even_weight > 0.0) {
        mean += sums[index].rgb * params.even_weight;
    }
    if (params.odd_weight > 0.0) {
        mean += sums[extent.x * extent.y + index].rgb * params.odd_weight;
    }
    irradiance[pixel.y * row_pitch(params.mapping) + pixel.x] = pack_halves(mean, 0u);
}
