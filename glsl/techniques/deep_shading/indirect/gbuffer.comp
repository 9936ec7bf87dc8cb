// What a material says of its entries, into the compact geometry buffer. Pass: src/techniques/deep_shading/indirect/gbuffer.rs.
// variants: VERTEX=plain|extended
#version 460
#define DRAW_OF_TRIANGLE
#include "techniques/deep_shading/buffer_addresses.glsl"
#include "techniques/deep_shading/entries/entry.glsl"

layout(std430, set = 0, binding = 22) readonly buffer Colors { uvec2 colors[]; };
READS_PAIRS(waiting_at, colors)

#define ENTRY_ACCESS writeonly
#define ENTRY_FUNCTION WRITES_QUADS
#include "techniques/deep_shading/indirect/entries.glsl"

void main() {
    uint entry = own_place(0u);
    if (entry == NO_PLACE) {
        return;
    }
    stand_on_entry(waiting_at(entry));
    vec3 base_color = base_color_at(params.material).rgb;
    Lit dark = dark_at(params.material, base_color);
    entry_place(entry, vec4(in_position_ws, dark.surface.dielectric_f0));
    entry_normal(entry, vec4(dark.normal_ws, dark.surface.roughness));
    entry_base_color(entry, vec4(base_color, dark.surface.metallic));
    entry_radiance(entry, is_unlit() ? vec4(base_color, 1.0) : vec4(dark.radiance, 0.0));
}
