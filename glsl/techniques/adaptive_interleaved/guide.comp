// Adaptive guidance of one component, a tile a thread. Dubla 2009, Listing 1, lines 8 to 13.
// Pass: src/techniques/adaptive_interleaved/guide.rs.
// variants: COMPONENT=id|ss|pm|ao
#version 460
#include "techniques/adaptive_interleaved/bins.glsl"
#include "techniques/adaptive_interleaved/guidance.glsl"

layout(local_size_x = 64) in;

layout(push_constant) uniform Push { AdaptiveParams params; };
layout(std430, set = 0, binding = 3) readonly buffer Estimates { uvec4 estimates[]; };
// Further iterations of each tile.
layout(std430, set = 0, binding = 8) writeonly buffer Guidance { uint guidance[]; };
layout(std430, set = 0, binding = 9) buffer Bins { BinsBlock bins; };

void main() {
    uint tile = gl_GlobalInvocationID.x;
    if (tile >= params.tile_count) {
        return;
    }
    TileFound found = TILE_UNKNOWN;
    for (uint slot = 0u; slot < tile_size(params); slot++) {
        uvec2 texel = texel_of(params, tile, slot);
        if (has_texel(params, texel)) {
            add_word(params, estimates[index_of(params, texel)].w, found);
        }
    }
    uint further = further_iterations(params, found);
    guidance[tile] = further;
    if (further > 0u) {
        atomicAdd(bins.counts[further], 1u);
    }
}
