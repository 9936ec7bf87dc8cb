// The samples of a member into the sums of the pixels that they lie in. Keller and Heidrich 2001, section 3.1.
// Pass: src/techniques/interleaved_sampling/combine.rs.
// variants: PICTURE=grid|frame
#version 460
#include "techniques/interleaved_sampling/combine.glsl"

layout(local_size_x = 64, local_size_y = 1) in;

// A texel for each sample of the member, or for each pixel of the frame.
layout(set = 0, binding = 3, rgba32f) readonly uniform image2D drawn;

void main() {
    uvec2 place = gl_GlobalInvocationID.xy;
    if (place.x >= params.grid_width || place.y >= params.grid_height) {
        return;
    }
    uvec2 pixel = pixel_of(place);
    if (pixel.x >= frame.width_px || pixel.y >= frame.height_px) {
        return;
    }
#ifdef PICTURE_GRID
    uvec2 texel = place;
#else
    uvec2 texel = pixel;
#endif
    add_sample(pixel, imageLoad(drawn, ivec2(texel)).rgb);
}
