// The light pass with a draw a light: what it adds to the texels that it may reach. Kircher 2009, section 2.2.
// Pass: src/techniques/inferred_lighting/light/volumes.rs.
// variants: EXTRAS=off|on TARGETS=one|two
#version 460
#include "frame.glsl"
#include "bvh.glsl"
#include "loops.glsl"
#include "techniques/inferred_lighting/light/volumes.glsl"

layout(std430, set = 0, binding = 0) readonly buffer Frame { FrameBlock frame; };

#include "techniques/inferred_lighting/surface.glsl"

layout(std430, set = 0, binding = 1) readonly buffer Lights { LightBlock lights[]; };
layout(std430, set = 0, binding = 2) readonly buffer BvhNodes { BvhNodeBlock bvh_nodes[]; };
layout(std430, set = 0, binding = 3) readonly buffer BvhTriangles { BvhTriangleBlock bvh_triangles[]; };

#include "bvh_walk.glsl"
#include "techniques/inferred_lighting/lighting.glsl"

// The first of the highlight's numbers is the fourth.
layout(location = 0) out vec4 out_lighting;
#ifdef TARGETS_TWO
layout(location = 1) out vec4 out_more;
#endif

void main() {
    uvec2 pixel = uvec2(gl_FragCoord.xy);
    Lighting lighting = no_lighting();
    if (has_surface_at(pixel)) {
        lighting = lighting_by(lights[params.light], surface_at(pixel));
        lighting.irradiance = nan_if_cut(lighting.irradiance);
    }
    out_lighting = vec4(lighting.irradiance, lighting.highlight.x);
#ifdef TARGETS_TWO
    out_more = vec4(lighting.highlight.yz, 0.0, 0.0);
#endif
}
