// Composite: albedo times the filtered irradiance, plus direct light by the full BRDF, plus emission (Segovia 2006,
// section 4.5: albedo only after the filter). Pass: src/techniques/interleaved_deferred/composite.rs.
//
// FILTER: whole, the irradiance is what it will be; columns, it was filtered along its rows, and a thread filters its column.
// variants: POSITION=half|unorm16|depth|float EMISSIVE=off|on CULL=none|tiled FILTER=whole|columns
#version 460
#include "passes/composite.glsl"
#include "passes/filter/walk.glsl"
#include "techniques/interleaved_deferred/demodulation.glsl"

struct CompositeParams {
    // Read with FILTER=columns.
    WalkParams walk;
    uint row_pitch;
    // 1: --direct full. 0: the punctual lights are in the irradiance, or left out.
    uint direct_full;
    // Always 0, which compilers cannot know: one that sees halves packed and unpacked together rounds otherwise (Mesa
    // 25).
    uint opaque_zero;
    // 1: --vpl-brdf ggx.
    uint is_glossy;
};

layout(push_constant) uniform Push { CompositeParams params; };
layout(std430, set = 0, binding = 6) readonly buffer Irradiance { uvec2 irradiance[]; };
#ifdef FILTER_COLUMNS
layout(std430, set = 0, binding = 7) readonly buffer Flags { uint flags[]; };

// The first pixel of a thread lies in the frame's columns.
void read_column(uvec2 first) {
    for (uint i = 0u; i < WINDOW; i++) {
        int place = window_place(first.y, i);
        uint texel = uint(clamp(place, 0, int(frame.height_px) - 1)) * params.row_pitch + first.x;
        set_window(params.walk, i, place, frame.height_px, irradiance[texel], flags[texel]);
    }
}
#endif

uvec2 received_at(uint i, uvec2 pixel) {
#ifdef FILTER_COLUMNS
    return walked(params.walk, i) ^ params.opaque_zero;
#else
    return irradiance[pixel.y * params.row_pitch + pixel.x];
#endif
}

void main() {
    bool direct_full = params.direct_full != 0u;
    for (uint i = 0u; i < TEXELS; i++) {
        set_point(i, direct_full);
    }
    if (direct_full) {
        shade_points();
    }
#ifdef FILTER_COLUMNS
    read_column(min(pixel_of_point(0u), uvec2(frame.width_px, frame.height_px) - 1u));
#endif
    for (uint i = 0u; i < TEXELS; i++) {
        uvec2 pixel = pixel_of_point(i);
        if (!is_in_frame(pixel)) {
            continue;
        }
        vec4 value = vec4(frame.background.rgb, 0.0);
        if (point_is_shaded[i]) {
            Surface surface = point_surface[i];
            vec3 received = unpack_halves(received_at(i, pixel));
            vec3 color_of_received = params.is_glossy != 0u ? modulus_of(surface) : albedo_of(surface);
            precise vec3 radiance = emitted_at(pixel) + color_of_received * received / PI;
            radiance += ambient_of(i);
            if (direct_full) {
                radiance += point_radiance[i];
            }
            value = vec4(radiance, 1.0);
        }
        imageStore(color, ivec2(pixel), value);
    }
}
