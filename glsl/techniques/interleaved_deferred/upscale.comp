// Sub-sampled irradiance back to the frame by bilinear interpolation (Segovia 2006, section 5.4).
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
    vec2 pattern = vec2(mapping.pattern_x, mapping.pattern_y);
    ivec2 last = ivec2((uvec2(mapping.width_px, mapping.height_px) - 1u) / uvec2(mapping.pattern_x, mapping.pattern_y));
    // Where the pixel lies between the middles of the cells.
    vec2 at = (vec2(pixel) - floor(pattern * 0.5)) / pattern;
    ivec2 low = ivec2(floor(at));
    vec2 fraction = at - vec2(low);
    vec3 sum = vec3(0.0);
    for (int corner = 0; corner < 4; corner++) {
        ivec2 step = ivec2(corner & 1, corner >> 1);
        ivec2 cell = clamp(low + step, ivec2(0), last);
        vec2 weight = mix(1.0 - fraction, fraction, vec2(step));
        sum += unpack_halves(source[uint(cell.y) * mapping.sub_width_px + uint(cell.x)]) * (weight.x * weight.y);
    }
    irradiance[pixel.y * row_pitch(mapping) + pixel.x] = pack_halves(sum, 0u);
}
