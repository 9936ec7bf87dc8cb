// One-pass split: G-buffer to n x m sub-buffers, pulled: a thread per two texels written. Segovia 2006, section 3.2.
// Pass: src/techniques/interleaved_deferred/split/one_pass.rs.
// variants: POSITION=half|unorm16|depth|float
#version 460
#include "passes/gbuffer_read.glsl"
#include "techniques/interleaved_deferred/mapping.glsl"

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;

layout(push_constant) uniform Push { MappingParams mapping; };
layout(std430, set = 0, binding = 1) writeonly buffer SplitPosition { POSITION_WORDS split_position[]; };
layout(std430, set = 0, binding = 2) writeonly buffer SplitNormal { uvec4 split_normal[]; };

// x: pairs along a row of a sub-buffer, y: its rows, z: sub-buffers.
void main() {
    uvec3 id = gl_GlobalInvocationID;
    if (id.x * 2u >= mapping.sub_width_px || id.y >= mapping.sub_height_px) {
        return;
    }
    uvec2 first = pixel_of(mapping, id.z, uvec2(id.x * 2u, id.y));
    uvec2 second = uvec2(first.x + mapping.pattern_x, first.y);
    uvec2 last = uvec2(mapping.width_px, mapping.height_px) - 1u;
    uint texel = (id.z * mapping.sub_height_px + id.y) * mapping.sub_width_px + id.x * 2u;
    // Padding holds no surface: all bits 0.
    bool first_inside = all(lessThanEqual(first, last));
    bool second_inside = all(lessThanEqual(second, last));
    uvec2 first_pixel = min(first, last);
    uvec2 second_pixel = min(second, last);
    split_position[texel] = position_words(first_pixel);
    split_position[texel + 1u] = position_words(second_pixel);
    uvec2 first_normal = first_inside ? normal_words(first_pixel) : uvec2(0u);
    uvec2 second_normal = second_inside ? normal_words(second_pixel) : uvec2(0u);
    split_normal[texel / 2u] = uvec4(first_normal, second_normal);
}
