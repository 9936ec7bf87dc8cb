// What a pixel's samples of each of its tile's layers are together. Pass: src/techniques/deep_shading/reconstruct/means.rs.
#version 460
#include "techniques/deep_shading/buffer_addresses.glsl"
#include "frame.glsl"
#include "techniques/deep_shading/space.glsl"
#include "techniques/deep_shading/reconstruct/layer_mean.glsl"

layout(local_size_x = 16, local_size_y = 4) in;

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 2) readonly buffer Deep { DeepBlock deep; };
layout(std430, set = 0, binding = 34) readonly buffer SampleColors { uvec2 sample_colors[]; };
layout(std430, set = 0, binding = 35) readonly buffer SampleVectors { uvec2 sample_vectors[]; };
layout(std430, set = 0, binding = 36) readonly buffer Tiles { TileBlock tiles[]; };
layout(std430, set = 0, binding = 38) writeonly buffer LayerMeans { uvec2 layer_means[]; };
layout(std430, set = 0, binding = 39) readonly buffer BufferAddresses { BufferAddressBlock buffer_addresses; };

READS_PAIRS(colors_of, sample_colors)
READS_PAIRS(vectors_of, sample_vectors)
WRITES_PAIRS(set_means, layer_means)

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    uvec2 frame_px = uvec2(frame.width_px, frame.height_px);
    if (pixel.x >= frame_px.x || pixel.y >= frame_px.y) {
        return;
    }
    TileBlock tile = tiles[tile_under(frame_px, pixel)];
    Parts parts = parts_of(deep.sample_count);
    LayerMean sums[LAYER_COUNT];
    for (uint layer = 0u; layer < LAYER_COUNT; layer++) {
        sums[layer] = no_mean();
    }
    for (uint index = 0u; index < deep.sample_count; index++) {
        uint entry = entry_of(frame_px, pixel, index);
        uvec2 colors = colors_of(entry);
        Blur blur = blur_of(colors, vectors_of(entry));
        uint layer = layer_of(tile, blur.depth);
        sums[layer].count++;
        sums[layer].radiance += blur.depth < NO_DEPTH ? radiance_of(colors) : frame.background.rgb;
        sums[layer].support += support_of(blur, parts);
        sums[layer].depth = min(sums[layer].depth, blur.depth);
    }
    for (uint layer = 0u; layer < LAYER_COUNT; layer++) {
        LayerMean mean = sums[layer];
        float count = max(mean.count, 1.0);
        mean.radiance /= count;
        mean.support /= count;
        uvec2 pairs[MEAN_PAIRS] = packed_mean(mean);
        uint entry = mean_entry(frame_px, pixel, layer);
        for (uint part = 0u; part < MEAN_PAIRS; part++) {
            set_means(entry + part, pairs[part]);
        }
    }
}
