// Points that a split has moved into sub-buffers.
#ifndef INTERLEAVED_DEFERRED_OF_SUB_BUFFER_GLSL
#define INTERLEAVED_DEFERRED_OF_SUB_BUFFER_GLSL

#include "techniques/interleaved_deferred/sub_buffers.glsl"
#include "techniques/interleaved_deferred/shade/irradiance.glsl"

// The i-th point is the surface of a texel, which lies at `place`; none where `exists` is false.
void set_point_of_sub_buffer(uint i, bool exists, PLACE place, uvec3 texel) {
    uvec2 pixel = pixel_of_texel(params.mapping, texel);
    SurfaceTexel surface = load_surface(place);
    set_point(i, exists, surface.normal, surface.position, pixel, linear_of(params.mapping, texel));
#ifdef VPL_BRDF_GGX
    set_material(i, surface.normal, surface.color);
#endif
}

#endif
