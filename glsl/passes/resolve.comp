// The mean of each pixel's samples (--msaa). Pass: src/passes/resolve.rs.
#version 460

layout(constant_id = 77) const uint SAMPLE_COUNT = 4;

layout(local_size_x = 64, local_size_y = 1) in;

layout(set = 0, binding = 0) uniform sampler2DMS drawn;
layout(set = 0, binding = 1, rgba32f) writeonly uniform image2D color;

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(pixel, imageSize(color)))) {
        return;
    }
    precise vec4 sum = vec4(0.0);
    for (uint index = 0u; index < SAMPLE_COUNT; index++) {
        sum += texelFetch(drawn, pixel, int(index));
    }
    imageStore(color, pixel, sum / float(SAMPLE_COUNT));
}
