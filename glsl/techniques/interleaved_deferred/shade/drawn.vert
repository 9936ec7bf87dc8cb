// A quad on one of the sub-buffers that are tiled in an image (Segovia 2006, section 4.3); the draw's number, as its instance, says on
// which. Pass: src/techniques/interleaved_deferred/shade/drawn.rs.
#version 460
#include "techniques/interleaved_deferred/shade/params.glsl"

layout(push_constant) uniform Push { ShadeParams params; };

layout(location = 0) flat out uint out_instance;

void main() {
    // Two triangles: corners 0, 1, 2 and 1, 2, 3.
    uint index = uint(gl_VertexIndex < 3 ? gl_VertexIndex : gl_VertexIndex - 2);
    uvec2 corner = place_in_pattern(params.mapping, gl_InstanceIndex) + uvec2(index & 1u, index >> 1);
    uvec2 at = corner * uvec2(params.mapping.sub_width_px, params.mapping.sub_height_px);
    out_instance = gl_InstanceIndex;
    gl_Position = vec4(2.0 * vec2(at) / vec2(padded_of(params.mapping)) - 1.0, 0.0, 1.0);
}
