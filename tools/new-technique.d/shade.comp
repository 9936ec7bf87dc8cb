// new_technique: every punctual light on every pixel. Pass: src/techniques/new_technique/shade.rs.
// variants: POSITION=unorm16 EMISSIVE=off|on CULL=none
#version 460
#include "passes/composite.glsl"

// --light-scale. Numbers below 60 are each technique's own (glsl/README.md).
layout(constant_id = 5) const float LIGHT_SCALE = 1.0;

void main() {
    set_point(0u, true);
    shade_points();
    uvec2 pixel = pixel_of_point(0u);
    if (!is_in_frame(pixel)) {
        return;
    }
    vec4 value = vec4(frame.background.rgb, 0.0);
    if (point_is_shaded[0]) {
        precise vec3 radiance = emitted_at(pixel) + ambient_of(0u);
        radiance += LIGHT_SCALE * point_radiance[0];
        value = vec4(radiance, 1.0);
    }
    imageStore(color, ivec2(pixel), value);
}
