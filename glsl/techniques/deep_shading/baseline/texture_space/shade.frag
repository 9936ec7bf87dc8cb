// A triangle's texels, each shaded by its owner alone. Pass: src/techniques/deep_shading/baseline/texture_space/shade.rs.
// variants: VERTEX=plain|extended SHADOWS=traced|mapped
#version 460
#include "techniques/deep_shading/scene_buffers.glsl"
#include "techniques/deep_shading/surface.glsl"
#include "techniques/deep_shading/counters.glsl"
#include "techniques/deep_shading/baseline/texture_space/atlas.glsl"
#include "techniques/deep_shading/baseline/texture_space/texel.glsl"

// As in ../../shade.frag.
layout(constant_id = 94) const uint IS_COUNTED = 0;

layout(std430, set = 0, binding = 26) buffer Counters { uint counters[]; };
layout(std430, set = 0, binding = 42) readonly buffer Owners { uint owners[]; };
layout(std430, set = 0, binding = 43) writeonly buffer Texels { uvec2 texels[]; };
// Which texels of the texture the frame's draws have shaded so far, whichever of them, and how many these are.
layout(std430, set = 0, binding = 44) buffer Touched {
    uint touched_count;
    uint touched_bits[];
};

// Textures of the material are read as coarsely as where the frame's pixels are shaded, unless texels lie farther apart: what is
// finer would be lost between them. `place` has rates of a texel. `canonical`: the triangle's corners.
void widen(inout Place place, Charted charted, vec4 canonical[3]) {
    vec4 at = place.weights.x * canonical[0] + place.weights.y * canonical[1] + place.weights.z * canonical[2];
    if (at.w <= 0.0) {
        return;
    }
    Place seen = place_at(canonical[0], canonical[1], canonical[2], at.xy / at.w);
    // Size of a pixel of the frame, not of a finer or coarser shading space.
    vec2 pixel = deep.scaled_px / vec2(frame.width_px, frame.height_px);
    vec3 right = seen.right * pixel.x;
    vec3 down = seen.down * pixel.y;
    mat3x2 atlas_texels = mat3x2(charted.corners[0], charted.corners[1], charted.corners[2]);
    if (max(length(atlas_texels * right), length(atlas_texels * down)) >= 1.0) {
        place.right = right;
        place.down = down;
    }
}

void main() {
    if (!is_texel()) {
        return;
    }
    uint index = texel_index(in_level, texel_at());
    if ((owners[index] & OWNER_TRIANGLE) != in_triangle + 1u) {
        return;
    }
    Charted charted = charted_at(in_triangle, in_level);
    Place place = texel_place(charted);
    uvec3 vertices = vertices_of(params.primitive_offset + in_triangle);
    Corner a = corner_at(vertices.x);
    Corner b = corner_at(vertices.y);
    Corner c = corner_at(vertices.z);
    widen(place, charted, vec4[3](a.canonical, b.canonical, c.canonical));
    // The side is not the atlas's but what the middle of the lens sees, as of the lists.
    place.is_front = spanned(a.canonical, b.canonical, c.canonical) < 0.0;
    stand_on(a, b, c, vertices, place);
    texels[index] = color_of_base(base_color_at(params.material));
    if (IS_COUNTED != 0u) {
        atomicAdd(counters[COUNTED_SHADED], 1u);
        uint bit = 1u << (index % 32u);
        if ((atomicOr(touched_bits[index / 32u], bit) & bit) == 0u) {
            atomicAdd(touched_count, 1u);
        }
    }
}
