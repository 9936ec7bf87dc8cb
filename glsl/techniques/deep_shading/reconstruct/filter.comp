// The picture from few samples: each layer's colours are spread as far as its blur allows, and so is how much of what is
// behind it hides; layers are put over each other from front to back. What has no blur keeps the mean of its pixel's samples.
// Pass: src/techniques/deep_shading/reconstruct/filter.rs.
#version 460
#include "techniques/deep_shading/buffer_addresses.glsl"
#include "frame.glsl"
#include "techniques/deep_shading/space.glsl"
#include "techniques/deep_shading/reconstruct/layer_mean.glsl"

// What a sharp sample of another pixel counts for, where a layer shows that none of the pixel's own samples see: nothing
// where there are own ones.
const float ELSEWHERE = 1e-5;
// Filters are widened in full where the squares of their axes are by as much over a pixel's, both together, ...
const float WIDENED_AFTER = 0.5;
// ... and a tenth to nine tenths of a pixel's samples see the layer: one through the product of these parts.
const float MIXED = 12.0;

// In a tile all look as far.
layout(local_size_x = 16, local_size_y = 4) in;

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
layout(std430, set = 0, binding = 2) readonly buffer Deep { DeepBlock deep; };
layout(std430, set = 0, binding = 36) readonly buffer Tiles { TileBlock tiles[]; };
layout(std430, set = 0, binding = 38) readonly buffer LayerMeans { uvec2 layer_means[]; };
layout(std430, set = 0, binding = 39) readonly buffer BufferAddresses { BufferAddressBlock buffer_addresses; };
layout(set = 0, binding = 29, rgba32f) readonly uniform image2D resolved;
layout(set = 0, binding = 30, rgba32f) writeonly uniform image2D color;

READS_PAIRS(means_of, layer_means)

const uvec4 LAYERS = uvec4(0u, 1u, 2u, 3u);

// The part of a pixel's samples that sees one of its layers.
LayerMean mean_at(uvec2 frame_px, uvec2 pixel, uint layer) {
    uint entry = mean_entry(frame_px, pixel, layer);
    uvec2 first = means_of(entry);
    return count_of_mean(first) > 0.0 ? unpacked_mean(first, means_of(entry + 1u), means_of(entry + 2u)) : no_mean();
}

// The filters of a pixel's layers.
struct Supports {
    mat4x3 all;
    // By how much each is widened over the table of tuples.
    mat4x3 widened;
};

// Supports are the mean of a pixel's own samples, or, where it has none, of the tile's. A layer of which the pixel's own samples
// see neither it nor anything behind it is looked for as far as the layer before it reaches.
//
// A layer that some of the pixel's samples see and others see past is seen in a pattern by the tuples of different pixels, which
// the filter is then wide enough for; one that all see or none is not, so that edges along a way stay sharp.
Supports supports_at(TileBlock tile, uvec2 frame_px, uvec2 pixel) {
    Supports supports = Supports(mat4x3(tile.first.xyz, tile.second.xyz, tile.third.xyz, tile.fourth.xyz), mat4x3(0.0));
    vec2 table_px = vec2(deep.table_width_px, deep.table_height_px);
    vec3 over_table = vec3(table_px.x * table_px.x - 1.0, 0.0, table_px.y * table_px.y - 1.0);
    vec4 own;
    mat4x3 owned;
    for (uint each = 0u; each < LAYER_COUNT; each++) {
        LayerMean mean = mean_at(frame_px, pixel, each);
        own[each] = mean.count;
        owned[each] = mean.support;
    }
    for (uint each = 0u; each < LAYER_COUNT; each++) {
        float unhidden = dot(own, vec4(greaterThanEqual(LAYERS, uvec4(each))));
        if (own[each] > 0.0) {
            float part = own[each] / unhidden;
            float blurred = clamp((owned[each].x + owned[each].z - 2.0) / WIDENED_AFTER, 0.0, 1.0);
            supports.widened[each] = blurred * min(MIXED * part * (1.0 - part), 1.0) * over_table;
            supports.all[each] = owned[each] + supports.widened[each];
        } else if (unhidden == 0.0) {
            vec3 before = supports.all[max(each, 1u) - 1u];
            vec3 own_support = supports.all[each];
            supports.all[each] = before.x + before.z > own_support.x + own_support.z ? before : own_support;
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
    TileBlock tile = tiles[tile_under(frame_px, pixel)];
    vec4 resolved_here = imageLoad(resolved, ivec2(pixel));
    if (tile.reach_x_px + tile.reach_y_px == 0u) {
        imageStore(color, ivec2(pixel), resolved_here);
        return;
    }
    Supports supports = supports_at(tile, frame_px, pixel);
    vec4 areas;
    for (uint each = 0u; each < LAYER_COUNT; each++) {
        areas[each] = sqrt(determinant_of(supports.all[each]));
    }
    // For each layer: samples that see it, and those that see it or something behind it, as far as its filter reaches, and among
    // the tuples of the pixel's own table; colours, and their weights.
    vec4 seen = vec4(0.0);
    vec4 unhidden = vec4(0.0);
    vec4 own_seen = vec4(0.0);
    vec4 own_unhidden = vec4(0.0);
    mat4 colors = mat4(0.0);
    ivec2 table_px = ivec2(deep.table_width_px, deep.table_height_px);
    ivec2 reach_px = max(ivec2(tile.reach_x_px, tile.reach_y_px), min(table_px, ivec2(MOST_RADIUS_PX)) - 1);
    ivec2 least = max(ivec2(pixel) - reach_px, ivec2(0));
    ivec2 most = min(ivec2(pixel) + reach_px, ivec2(frame_px) - 1);
    for (int y = least.y; y <= most.y; y++) {
        for (int x = least.x; x <= most.x; x++) {
            ivec2 away = ivec2(x, y) - ivec2(pixel);
            vec2 d = vec2(away);
            float is_own = all(lessThanEqual(abs(away), table_px / 2)) ? 1.0 : 0.0;
            vec4 weights;
            for (uint each = 0u; each < LAYER_COUNT; each++) {
                weights[each] = weight_at(supports.all[each], d);
            }
            if (weights == vec4(0.0) && is_own == 0.0) {
                continue;
            }
            for (uint each = 0u; each < LAYER_COUNT; each++) {
                LayerMean mean = mean_at(frame_px, uvec2(x, y), each);
                if (mean.count == 0.0) {
                    continue;
                }
                // A pixel of another tile has that one's layers.
                uint layer = layer_of(tile, mean.depth);
                vec4 is_in = vec4(equal(uvec4(layer), LAYERS));
                vec4 is_before = vec4(greaterThanEqual(uvec4(layer), LAYERS));
                float weight = dot(is_in, weights);
                seen += mean.count * weight * is_in;
                unhidden += mean.count * weights * is_before;
                own_seen += is_own * mean.count * is_in;
                own_unhidden += is_own * mean.count * is_before;
                vec3 support = mean.support + supports.widened * is_in;
                float area = min(sqrt(determinant_of(support)), dot(is_in, areas));
                float spread = min(weight_at(support, d), weight) / area + ELSEWHERE * weight;
                vec4 added = mean.count * spread * vec4(mean.radiance, 1.0);
                colors += mat4(is_in.x * added, is_in.y * added, is_in.z * added, is_in.w * added);
            }
        }
    }
    float through = 1.0;
    vec4 sum = vec4(0.0);
    bool is_sharp = true;
    for (uint each = 0u; each < LAYER_COUNT; each++) {
        float covered = unhidden[each] > 0.0 ? seen[each] / unhidden[each] : 0.0;
        // A layer ends where none of the tuples see it any more: filters do not draw it any longer.
        covered = own_unhidden[each] > 0.0 && own_seen[each] == 0.0 ? 0.0 : covered;
        if (through * covered > 0.0) {
            is_sharp = is_sharp && supports.all[each] == vec3(1.0, 0.0, 1.0);
            sum += through * covered * vec4(colors[each].rgb / colors[each].w, 1.0);
            through *= 1.0 - covered;
        }
    }
    imageStore(color, ivec2(pixel), is_sharp ? resolved_here : vec4(sum.rgb / sum.a, 1.0));
}
