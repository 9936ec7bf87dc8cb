// Owner of a texel: the triangle that comes nearest to its middle, and of several such the last in the index buffer.
// Pass: src/techniques/deep_shading/baseline/texture_space/claim.rs.
#version 460
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/place.glsl"
#include "techniques/deep_shading/baseline/texture_space/atlas.glsl"
#include "techniques/deep_shading/baseline/texture_space/texel.glsl"

layout(std430, set = 0, binding = 42) buffer Owners { uint owners[]; };

// Least distance between places that are distinguished, in texels; nearer to the middle than the least of them it lies
// inside.
const float RANK_STEP = 0.05;
const float RANK_INSIDE = 1.0 / 256.0;
// The texels that a look-up reads are no farther away: those of a hull that is a box may be.
const float FARTHEST_READ = 1.5;

void main() {
    if (!is_texel()) {
        return;
    }
    Charted charted = charted_at(in_triangle, in_level);
    Place place = texel_place(charted);
    vec2 at = place.weights.x * charted.corners[0] + place.weights.y * charted.corners[1] +
              place.weights.z * charted.corners[2];
    float far = distance(at, vec2(texel_at()) + 0.5);
    if (far > FARTHEST_READ) {
        return;
    }
    uint best = (1u << OWNER_RANK_BITS) - 1u;
    uint rank = far < RANK_INSIDE ? best : best - 1u - min(uint(far / RANK_STEP), best - 1u);
    atomicMax(owners[texel_index(in_level, texel_at())], rank << (32u - OWNER_RANK_BITS) | (in_triangle + 1u));
}
