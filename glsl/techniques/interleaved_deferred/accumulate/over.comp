// What blends over the picture of what is solid: the mean of the layers of all runs, or of a half of them.
// Pass: src/techniques/interleaved_deferred/accumulate/over.rs.
#version 460

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;

struct OverParams {
    // The frame, in pixels.
    uint width_px;
    uint height_px;
    // What the sums of even and of odd runs count; a half of weight 0 may hold anything.
    float even_weight;
    float odd_weight;
};

layout(push_constant) uniform Push { OverParams params; };
layout(std430, set = 0, binding = 0) readonly buffer LayerSums { vec4 sums[]; };
layout(set = 0, binding = 1, rgba32f) uniform image2D color;

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.width_px || pixel.y >= params.height_px) {
        return;
    }
    uint index = pixel.y * params.width_px + pixel.x;
    vec4 layer = vec4(0.0);
    if (params.even_weight > 0.0) {
        layer += sums[index] * params.even_weight;
    }
    if (params.odd_weight > 0.0) {
        layer += sums[params.width_px * params.height_px + index] * params.odd_weight;
    }
    vec4 solid = imageLoad(color, ivec2(pixel));
    imageStore(color, ivec2(pixel), vec4(solid.rgb * (1.0 - layer.a) + layer.rgb, solid.a));
}
