// Gather and the filter's walk along the rows in one (--fuse on): the walk reads sub-buffers where gauss.comp reads what a
// gather has written. The columns are walked by the composite. Segovia 2006, sections 3.4 and 4.5.
// Pass: src/techniques/interleaved_deferred/gather/filtered.rs.
// variants: STORAGE=buffer|image|layers
#version 460
#define READS_IRRADIANCE
#include "techniques/interleaved_deferred/sub_buffers.glsl"

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;
layout(constant_id = 2) const uint TEXELS = 1;

#include "passes/filter/walk.glsl"

struct GatherFilteredParams {
    WalkParams walk;
    MappingParams mapping;
};

layout(push_constant) uniform Push { GatherFilteredParams params; };
layout(std430, set = 0, binding = 16) readonly buffer Flags { uint flags[]; };
layout(std430, set = 0, binding = 17) writeonly buffer Rows { uvec2 rows[]; };

// x: runs of TEXELS pixels along a row, y: rows of the frame.
void main() {
    MappingParams mapping = params.mapping;
    uvec2 first = gl_GlobalInvocationID.xy * uvec2(TEXELS, 1u);
    if (!is_in_frame(mapping, first)) {
        return;
    }
    uint row = first.y * row_pitch(mapping);
    // One division for the whole run: the texels of a row come in the order of the pattern.
    uint start = uint(max(window_place(first.x, 0u), 0));
    uvec3 texel = texel_of_pixel(mapping, uvec2(start, first.y));
    uint in_pattern = start % mapping.pattern_x;
    uint row_subset = texel.z - in_pattern;
    for (uint i = 0u; i < WINDOW; i++) {
        int place = window_place(first.x, i);
        uint x = uint(clamp(place, 0, int(mapping.width_px) - 1));
        uvec2 words = load_irradiance(place_of_texel(mapping, texel));
        set_window(params.walk, i, place, mapping.width_px, words, flags[row + x]);
        if (place >= 0 && place + 1 < int(mapping.width_px)) {
            bool wraps = in_pattern + 1u == mapping.pattern_x;
            in_pattern = wraps ? 0u : in_pattern + 1u;
            texel.x += wraps ? 1u : 0u;
            texel.z = row_subset + in_pattern;
        }
    }
    for (uint i = 0u; i < TEXELS; i++) {
        if (first.x + i < mapping.width_px) {
            rows[row + first.x + i] = walked(params.walk, i);
        }
    }
}
