// The components' filtered irradiance, summed, times albedo, plus emission and ambient light; through the medium, which
// adds its own. Dubla 2009, section 3: albedo is left out of what is filtered.
// Pass: src/techniques/adaptive_interleaved/composite.rs.
// variants: POSITION=half|unorm16|depth|float EMISSIVE=off|on
#version 460
#include "frame.glsl"
#include "passes/gbuffer_read.glsl"
#include "shading/brdf.glsl"
#include "shading/extras.glsl"
#include "shading/medium_box.glsl"

struct ComposeParams {
    MediumBlock medium;
    // Texels of one component, and how many components there are.
    uint texel_count;
    uint component_count;
    // Which of them is no irradiance but what the medium scatters to the eye; none where it is as many as there are.
    uint airlight;
    // 1: all of --ambient reaches every surface; 0: it is among the components.
    uint adds_ambient;
};

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;

layout(push_constant) uniform Push { ComposeParams params; };
layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };
// One component behind the other, each in frame order.
layout(std430, set = 0, binding = 1) readonly buffer Irradiance { uvec2 irradiance[]; };
layout(set = 0, binding = 2, rgba32f) writeonly uniform image2D color;
layout(set = 0, binding = 42) uniform usampler2D gbuffer_color;
#ifdef EMISSIVE_ON
layout(set = 0, binding = 43) uniform usampler2D gbuffer_emissive;
#endif

// What arrives at the eye of what the pixel shows.
vec3 through_medium(uvec2 pixel, bool has_surface, vec3 radiance) {
    ViewRay ray = view_ray(frame, vec2(pixel) + 0.5);
    float seen = ray.limit;
    if (has_surface) {
        seen = dot(unpack_position(frame, position_words(pixel), pixel) - ray.origin, ray.direction);
    }
    return radiance * passed_by(params.medium, in_medium(params.medium, ray.origin, ray.direction, -ray.behind, seen));
}

void main() {
    ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
    if (pixel.x >= int(frame.width_px) || pixel.y >= int(frame.height_px)) {
        return;
    }
    uvec2 normal_bits = normal_words(uvec2(pixel));
    uint texel = uint(pixel.y) * frame.width_px + uint(pixel.x);
    vec4 value = vec4(frame.background.rgb, 0.0);
    if (has_surface(normal_bits)) {
        vec2 roughness_metallic = unpack_roughness_metallic(normal_bits);
        vec3 base_color = unpack_halves(texelFetch(gbuffer_color, pixel, 0).rg);
        Surface surface = Surface(base_color, roughness_metallic.y, roughness_metallic.x, DEFAULT_DIELECTRIC_F0);
        precise vec3 received = vec3(0.0);
        for (uint component = 0u; component < params.component_count; component++) {
            if (component != params.airlight) {
                received += unpack_halves(irradiance[component * params.texel_count + texel]);
            }
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
        if (params.adds_ambient != 0u) {
            radiance += ambient_reflectance(BRDF_LAMBERT, surface) * frame.ambient.rgb * openness;
        }
        value = vec4(radiance, 1.0);
    }
    if (params.medium.extinction > 0.0) {
        value.rgb = through_medium(uvec2(pixel), has_surface(normal_bits), value.rgb);
        if (params.airlight < params.component_count) {
            value.rgb += unpack_halves(irradiance[params.airlight * params.texel_count + texel]);
        }
    }
    imageStore(color, pixel, value);
}
