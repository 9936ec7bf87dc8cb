// One of n x m draws over the whole frame, which only the pixels of its subset pass, by stencil or by depth test (Segovia
// 2006, section 3.1). The draw's number comes as its instance. Pass: src/techniques/interleaved_deferred/shade/masked.rs.
// variants: POSITION=half|unorm16|depth|float VPL_SHADOW=none|tested VPL_BRDF=lambert|ggx
#version 460
#include "techniques/interleaved_deferred/shade/of_frame.glsl"

// A pixel that fails is not shaded: what the paper calls early fragment culling.
layout(early_fragment_tests) in;

layout(location = 0) flat in uint in_instance;
layout(location = 0) out uvec2 out_irradiance;

void main() {
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    set_point_of_frame(0u, true, pixel, place_of_pixel(pixel));
    // The draw's subset, not the pixel's: a mask that lets others pass would show.
    shade_points(subsets[in_instance]);
    out_irradiance = point_irradiance[0];
}
