// One pass over the un-split G-buffer, each pixel looping over its own subset (Segovia 2006, section 3.1, dynamic
// branching).
// Pass: src/techniques/interleaved_deferred/shade/branch.rs.
// variants: POSITION=half|unorm16|depth|float VPL_SHADOW=none|tested VPL_BRDF=lambert|ggx
#version 460
#include "techniques/interleaved_deferred/shade/of_frame.glsl"

layout(local_size_x = 64, local_size_y = 1, local_size_x_id = 0, local_size_y_id = 1) in;

layout(std430, set = 0, binding = 6) writeonly buffer Irradiance { uvec2 irradiance[]; };

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= params.mapping.width_px || pixel.y >= params.mapping.height_px) {
        return;
    }
    // One pixel a thread: its neighbours have other lights, so there is nothing to share.
    set_point_of_frame(0u, true, pixel, place_of_pixel(pixel));
    shade_points(subsets[subset_of(params.mapping, pixel)]);
    irradiance[pixel.y * row_pitch(params.mapping) + pixel.x] = point_irradiance[0];
}
