// The samples of members into the sums of the pixels that they lie in. Keller and Heidrich 2001, section 3.1.
// Pass: src/techniques/interleaved_sampling/combine.rs.
// variants: PICTURE=grid|frame|samples
#version 460
#include "techniques/interleaved_sampling/combine.glsl"

layout(local_size_x = 64, local_size_y = 1) in;

#ifdef PICTURE_SAMPLES
// A sample of each pixel for each member that the run draws.
layout(set = 0, binding = 3) uniform sampler2DMS drawn;

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= frame.width_px || pixel.y >= frame.height_px) {
        return;
    }
    uint count = min(params.members_at_once, params.members - first_of_run());
    for (uint index = 0; index < count; index++) {
        uint member = first_of_run() + index;
        if (has_sample(member, pixel)) {
            add_sample(member, pixel, texelFetch(drawn, ivec2(pixel), int(index)).rgb);
        }
    }
}
#else
// A texel for each sample of the member, or for each pixel of the frame.
layout(set = 0, binding = 3, rgba32f) readonly uniform image2D drawn;

void main() {
    uvec2 place = gl_GlobalInvocationID.xy;
    if (place.x >= params.grid_width || place.y >= params.grid_height) {
        return;
    }
    uint member = first_of_run();
    uvec2 pixel = pixel_of(member, place);
    if (pixel.x >= frame.width_px || pixel.y >= frame.height_px) {
        return;
    }
#ifdef PICTURE_GRID
    uvec2 texel = place;
#else
    uvec2 texel = pixel;
#endif
    add_sample(member, pixel, imageLoad(drawn, ivec2(texel)).rgb);
}
#endif
