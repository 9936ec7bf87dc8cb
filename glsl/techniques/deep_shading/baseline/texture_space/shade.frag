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

void main() {
    if (!is_texel()) {
        return;
    }
    uint index = texel_index(in_level, texel_at());
    if ((owners[index] & OWNER_TRIANGLE) != in_triangle + 1u) {
        return;
    }
    // Textures of the material are read as coarsely as texels lie: finer ones would be lost between them.
    Place place = texel_place(charted_at(in_triangle, in_level));
    uvec3 vertices = vertices_of(params.primitive_offset + in_triangle);
    Corner a = corner_at(vertices.x);
    Corner b = corner_at(vertices.y);
    Corner c = corner_at(vertices.z);
    // The side is not the atlas's but what the middle of the lens sees, as of the lists.
    place.is_front = spanned(a.canonical, b.canonical, c.canonical) < 0.0;
    stand_on(a, b, c, vertices, place);
    texels[index] = color_of_base(base_color_at(params.material));
    if (IS_COUNTED != 0u) {
        atomicAdd(counters[COUNTED_SHADED], 1u);
    }
}
