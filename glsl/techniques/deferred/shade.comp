// Plain deferred shading: every punctual light on every pixel. Pass: src/techniques/deferred/shade.rs.
// variants: POSITION=half|unorm16|depth|float EMISSIVE=off|on CULL=none|tiled
#version 460
#include "passes/composite.glsl"

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
    vec3 position_ws = unpack_position(frame, position_words(pixel), pixel);
    vec3 normal_ws = unpack_normal(normal_bits);
    vec2 roughness_metallic = unpack_roughness_metallic(normal_bits);
    vec3 base_color = unpack_halves(texelFetch(gbuffer_color, ivec2(pixel), 0).rg);
    Surface surface = Surface(base_color, roughness_metallic.y, roughness_metallic.x);
    precise vec3 radiance = emitted_at(pixel) + ambient_reflectance(BRDF_KIND, surface) * frame.ambient.rgb;
    radiance += direct_light(pixel, surface, position_ws, normal_ws);
    imageStore(color, ivec2(pixel), vec4(radiance, 1.0));
}
