// Where on its triangle a fragment is that the rasteriser, or the device, gives the weights of. After place.glsl; the including
// fragment shader has declared `params` and the input `in_weights`. Differences between the pixels of a quad: called before any
// of them returns.
#ifndef DEEP_SHADING_DRAWN_PLACE_GLSL
#define DEEP_SHADING_DRAWN_PLACE_GLSL

// Weights of the corners are as they come: some are below 0 where the pixel's middle lies beside the triangle.
Place drawn_place() {
    Place place;
    place.weights = in_weights;
    place.right = dFdx(in_weights);
    place.down = dFdy(in_weights);
    place.is_front = gl_FrontFacing != ((params.flags & DRAWN_MIRRORED) != 0u);
    return place;
}

#endif
