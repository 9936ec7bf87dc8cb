// Plain deferred shading: every punctual light on every pixel. Pass: src/techniques/deferred/shade.rs.
// variants: POSITION=half|unorm16|depth|float EMISSIVE=off|on CULL=none|tiled
#version 460
#include "passes/composite.glsl"

void main() {
    for (uint i = 0u; i < TEXELS; i++) {
        set_point(i, true);
    }
    shade_points();
    for (uint i = 0u; i < TEXELS; i++) {
        uvec2 pixel = pixel_of_point(i);
        if (!is_in_frame(pixel)) {
            continue;
        }
        vec4 value = vec4(frame.background.rgb, 0.0);
        if (point_is_shaded[i]) {
            precise vec3 radiance = emitted_at(pixel) + ambient_of(i);
            radiance += point_radiance[i];
            value = vec4(radiance, 1.0);
        }
        imageStore(color, ivec2(pixel), value);
    }
}
