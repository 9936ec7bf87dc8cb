// Sub-sampled irradiance back to the frame by bilinear interpolation between the pixels that were shaded (Segovia 2006,
// section 5.4).
// Pass: src/techniques/interleaved_deferred/upscale.rs.
#version 460
#include "passes/gbuffer.glsl"
#include "techniques/interleaved_deferred/mapping.glsl"

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;

layout(push_constant) uniform Push { MappingParams mapping; };
layout(std430, set = 0, binding = 0) readonly buffer Source { uvec2 source[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Irradiance { uvec2 irradiance[]; };

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= mapping.width_px || pixel.y >= mapping.height_px) {
        return;
    }
    uvec2 pattern = pattern_of(mapping);
    uvec2 last = (uvec2(mapping.width_px, mapping.height_px) - 1u) / pattern;
    // The cells whose middles the pixel lies between; one and the same before the first and behind the last.
    uvec2 low = (max(pixel, pattern / 2u) - pattern / 2u) / pattern;
    uvec2 high = min(low + 1u, last);
    uvec2 from = middle_of_cell(mapping, low);
    uvec2 stretch = max(middle_of_cell(mapping, high) - from, uvec2(1u));
    vec2 fraction = min(vec2(max(pixel, from) - from) / vec2(stretch), vec2(1.0));
    vec3 sum = vec3(0.0);
    for (uint corner = 0u; corner < 4u; corner++) {
        bvec2 is_high = bvec2((corner & 1u) != 0u, (corner & 2u) != 0u);
        uvec2 cell = mix(low, high, is_high);
        vec2 weight = mix(1.0 - fraction, fraction, is_high);
        sum += unpack_halves(source[cell.y * mapping.sub_width_px + cell.x]) * (weight.x * weight.y);
    }
    irradiance[pixel.y * row_pitch(mapping) + pixel.x] = pack_halves(sum, 0u);
}
