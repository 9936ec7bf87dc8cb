// Where on its triangle a fragment is that the rasteriser, or the device, gives the weights of. After place.glsl; the including
// fragment shader declares `params`. Differences between the pixels of a quad: called before any of them returns.
#ifndef DEEP_SHADING_DRAWN_PLACE_GLSL
#define DEEP_SHADING_DRAWN_PLACE_GLSL

// `weights`: of the corners, as they come; where the pixel's middle lies beside the triangle some are below 0.
Place drawn_place(vec3 weights) {
    Place place;
    place.weights = weights;
    place.right = dFdx(weights);
    place.down = dFdy(weights);
    place.is_front = gl_FrontFacing != ((params.flags & DRAWN_MIRRORED) != 0u);
    return place;
}

#endif
