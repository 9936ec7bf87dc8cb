// The components' filtered irradiance, summed, times albedo, plus emission and ambient light. Dubla 2009, section 3:
// albedo is left out of what is filtered. Pass: src/techniques/adaptive_interleaved/composite.rs.
// variants: EMISSIVE=off|on
#version 460
#include "frame.glsl"
#include "passes/gbuffer.glsl"
#include "shading/brdf.glsl"
#include "shading/extras.glsl"

struct ComposeParams {
    // Texels of one component, and how many components there are.
    uint texel_count;
    uint component_count;
};

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;

layout(push_constant) uniform Push { ComposeParams params; };
layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
// One component behind the other, each in frame order.
layout(std430, set = 0, binding = 1) readonly buffer Irradiance { uvec2 irradiance[]; };
layout(set = 0, binding = 2, rgba32f) writeonly uniform image2D color;
layout(set = 0, binding = 41) uniform usampler2D gbuffer_normal;
layout(set = 0, binding = 42) uniform usampler2D gbuffer_color;
#ifdef EMISSIVE_ON
layout(set = 0, binding = 43) uniform usampler2D gbuffer_emissive;
#endif

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= int(frame.width_px) || pixel.y >= int(frame.height_px)) {
        return;
    }
    uvec2 normal_bits = texelFetch(gbuffer_normal, pixel, 0).rg;
    vec4 value = vec4(frame.background.rgb, 0.0);
    if (has_surface(normal_bits)) {
        vec2 roughness_metallic = unpack_roughness_metallic(normal_bits);
        vec3 base_color = unpack_halves(texelFetch(gbuffer_color, pixel, 0).rg);
        Surface surface = Surface(base_color, roughness_metallic.y, roughness_metallic.x, DEFAULT_DIELECTRIC_F0);
        precise vec3 received = vec3(0.0);
        uint texel = uint(pixel.y) * frame.width_px + uint(pixel.x);
        for (uint component = 0u; component < params.component_count; component++) {
            received += unpack_halves(irradiance[component * params.texel_count + texel]);
        }
        float openness = 1.0;
        vec3 emitted = vec3(0.0);
#ifdef EMISSIVE_ON
        uvec2 emissive = texelFetch(gbuffer_emissive, pixel, 0).rg;
        emitted = unpack_halves(emissive);
        if (SURFACE_EXTRAS != 0u) {
            openness = openness_of_extras(last16(emissive));
        }
#endif
        precise vec3 radiance = emitted + albedo_of(surface) * received / PI;
        radiance += ambient_reflectance(BRDF_LAMBERT, surface) * frame.ambient.rgb * openness;
        value = vec4(radiance, 1.0);
    }
    imageStore(color, pixel, value);
}
