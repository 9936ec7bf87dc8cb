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
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= frame.width_px || pixel.y >= frame.height_px) {
        return;
    }
    uvec2 normal_bits = normal_words(pixel);
    if (!has_surface(normal_bits)) {
        imageStore(color, ivec2(pixel), vec4(frame.background.rgb, 0.0));
        return;
    }
    vec2 roughness_metallic = unpack_roughness_metallic(normal_bits);
    vec3 base_color = unpack_halves(texelFetch(gbuffer_color, ivec2(pixel), 0).rg);
    Surface surface = Surface(base_color, roughness_metallic.y, roughness_metallic.x);
    vec3 received = unpack_halves(irradiance[pixel.y * params.row_pitch + pixel.x]);
    precise vec3 radiance = emitted_at(pixel) + albedo_of(surface) * received / PI;
    radiance += ambient_reflectance(BRDF_KIND, surface) * frame.ambient.rgb;
    if (params.direct_full != 0u) {
        vec3 position_ws = unpack_position(frame, position_words(pixel), pixel);
        radiance += direct_light(pixel, surface, position_ws, unpack_normal(normal_bits));
    }
    imageStore(color, ivec2(pixel), vec4(radiance, 1.0));
}
