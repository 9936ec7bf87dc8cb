// Composite: albedo times the filtered irradiance, plus direct light by the full BRDF, plus emission (Segovia 2006,
// section 4.5: albedo only after the filter). Pass: src/techniques/interleaved_deferred/composite.rs.
// variants: POSITION=half|unorm16|depth|float EMISSIVE=off|on CULL=none|tiled
#version 460
#include "passes/composite.glsl"

struct CompositeParams {
    uint row_pitch;
    // 1: --direct full. 0: the punctual lights are in the irradiance, or left out.
    uint direct_full;
};

layout(push_constant) uniform Push { CompositeParams params; };
layout(std430, set = 0, binding = 6) readonly buffer Irradiance { uvec2 irradiance[]; };

void main() {
    bool direct_full = params.direct_full != 0u;
    for (uint i = 0u; i < TEXELS; i++) {
        set_point(i, direct_full);
    }
    if (direct_full) {
        shade_points();
    }
    for (uint i = 0u; i < TEXELS; i++) {
        uvec2 pixel = pixel_of_point(i);
        if (!is_in_frame(pixel)) {
            continue;
        }
        vec4 value = vec4(frame.background.rgb, 0.0);
        if (point_has_surface[i]) {
            Surface surface = point_surface[i];
            vec3 received = unpack_halves(irradiance[pixel.y * params.row_pitch + pixel.x]);
            precise vec3 radiance = emitted_at(pixel) + albedo_of(surface) * received / PI;
            radiance += ambient_of(i);
            if (direct_full) {
                radiance += point_direct[i];
            }
            value = vec4(radiance, 1.0);
        }
        imageStore(color, ivec2(pixel), value);
    }
}
