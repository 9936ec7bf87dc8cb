// The picture from few samples: each layer's colours are spread as far as its blur allows, and so is how much of what is
// behind it hides; layers are put over each other from front to back. What has no blur keeps the mean of its pixel's samples.
// Pass: src/techniques/deep_shading/reconstruct/filter.rs.
#version 460
#include "techniques/deep_shading/buffer_addresses.glsl"
#include "frame.glsl"
#include "techniques/deep_shading/space.glsl"
#include "techniques/deep_shading/reconstruct/blur.glsl"

// What a sharp sample of another pixel counts for, where a layer shows that none of the pixel's own samples see: nothing
// where there are own ones.
const float ELSEWHERE = 1e-5;

// In a tile all look as far.
layout(local_size_x = 16, local_size_y = 4) in;

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 2) readonly buffer Deep { DeepBlock deep; };
layout(std430, set = 0, binding = 34) readonly buffer SampleColors { uvec2 sample_colors[]; };
layout(std430, set = 0, binding = 35) readonly buffer SampleVectors { uvec2 sample_vectors[]; };
layout(std430, set = 0, binding = 36) readonly buffer Tiles { TileBlock tiles[]; };
layout(std430, set = 0, binding = 39) readonly buffer BufferAddresses { BufferAddressBlock buffer_addresses; };
layout(set = 0, binding = 29, rgba32f) readonly uniform image2D resolved;
layout(set = 0, binding = 30, rgba32f) writeonly uniform image2D color;

READS_PAIRS(colors_of, sample_colors)
READS_PAIRS(vectors_of, sample_vectors)

const uvec4 LAYERS = uvec4(0u, 1u, 2u, 3u);

Blur blur_at(uint entry) {
    return blur_of(colors_of(entry), vectors_of(entry));
}

// Supports of the pixel's layers: the mean of its own samples, or, where it has none, of the tile's. A layer of which the
// pixel's own samples see neither it nor anything behind it is looked for as far as the layer before it reaches.
mat4x3 supports_at(TileBlock tile, uvec2 frame_px, uvec2 pixel) {
    mat4x3 sums = mat4x3(0.0);
    uvec4 own = uvec4(0u);
    for (uint index = 0u; index < deep.sample_count; index++) {
        Blur blur = blur_at(entry_of(frame_px, pixel, index));
        vec3 support = support_of(blur);
        uint layer = layer_of(tile, blur.depth);
        for (uint each = 0u; each < LAYER_COUNT; each++) {
            sums[each] += layer == each ? support : vec3(0.0);
        }
        own += uvec4(equal(uvec4(layer), LAYERS));
    }
    mat4x3 supports = mat4x3(tile.first.xyz, tile.second.xyz, tile.third.xyz, tile.fourth.xyz);
    for (uint each = 0u; each < LAYER_COUNT; each++) {
        bool is_hidden = dot(vec4(own), vec4(greaterThanEqual(LAYERS, uvec4(each)))) == 0.0;
        if (own[each] > 0u) {
            supports[each] = sums[each] / float(own[each]);
        } else if (is_hidden) {
            vec3 before = supports[max(each, 1u) - 1u];
            supports[each] = before.x + before.z > supports[each].x + supports[each].z ? before : supports[each];
        }
    }
    return supports;
}

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    uvec2 frame_px = uvec2(frame.width_px, frame.height_px);
    if (pixel.x >= frame_px.x || pixel.y >= frame_px.y) {
        return;
    }
    uint tiles_across = (frame_px.x + TILE_PX - 1u) / TILE_PX;
    TileBlock tile = tiles[pixel.y / TILE_PX * tiles_across + pixel.x / TILE_PX];
    vec4 resolved_here = imageLoad(resolved, ivec2(pixel));
    if (tile.reach_x_px + tile.reach_y_px == 0u) {
        imageStore(color, ivec2(pixel), resolved_here);
        return;
    }
    mat4x3 supports = supports_at(tile, frame_px, pixel);
    vec4 areas;
    for (uint each = 0u; each < LAYER_COUNT; each++) {
        areas[each] = sqrt(determinant_of(supports[each]));
    }
    // For each layer: samples that see it, and those that see it or something behind it, as far as its filter reaches;
    // colours, and their weights.
    vec4 seen = vec4(0.0);
    vec4 unhidden = vec4(0.0);
    mat4 colors = mat4(0.0);
    ivec2 reach_px = ivec2(tile.reach_x_px, tile.reach_y_px);
    ivec2 least = max(ivec2(pixel) - reach_px, ivec2(0));
    ivec2 most = min(ivec2(pixel) + reach_px, ivec2(frame_px) - 1);
    for (int y = least.y; y <= most.y; y++) {
        for (int x = least.x; x <= most.x; x++) {
            vec2 d = vec2(x, y) - vec2(pixel);
            vec4 weights;
            for (uint each = 0u; each < LAYER_COUNT; each++) {
                weights[each] = weight_at(supports[each], d);
            }
            if (weights == vec4(0.0)) {
                continue;
            }
            for (uint index = 0u; index < deep.sample_count; index++) {
                uint entry = entry_of(frame_px, uvec2(x, y), index);
                Blur blur = blur_at(entry);
                uint layer = layer_of(tile, blur.depth);
                vec4 is_in = vec4(equal(uvec4(layer), LAYERS));
                float weight = dot(is_in, weights);
                seen += is_in * weight;
                unhidden += weights * vec4(greaterThanEqual(uvec4(layer), LAYERS));
                vec3 support = support_of(blur);
                float area = min(sqrt(determinant_of(support)), dot(is_in, areas));
                float spread = min(weight_at(support, d), weight) / area + ELSEWHERE * weight;
                vec3 radiance = blur.depth < NO_DEPTH ? radiance_of(colors_of(entry)) : frame.background.rgb;
                vec4 added = spread * vec4(radiance, 1.0);
                colors += mat4(is_in.x * added, is_in.y * added, is_in.z * added, is_in.w * added);
            }
        }
    }
    float through = 1.0;
    vec4 sum = vec4(0.0);
    bool is_sharp = true;
    for (uint each = 0u; each < LAYER_COUNT; each++) {
        float covered = unhidden[each] > 0.0 ? seen[each] / unhidden[each] : 0.0;
        if (through * covered > 0.0) {
            is_sharp = is_sharp && supports[each] == vec3(1.0, 0.0, 1.0);
            sum += through * covered * vec4(colors[each].rgb / colors[each].w, 1.0);
            through *= 1.0 - covered;
        }
    }
    imageStore(color, ivec2(pixel), is_sharp ? resolved_here : vec4(sum.rgb / sum.a, 1.0));
}
