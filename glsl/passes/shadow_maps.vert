// Vertices as a light sees them: of MASK surfaces with all that their holes are read by, of others places alone.
// Pass: src/passes/shadow_maps/mod.rs.
// variants: ALPHA=opaque|mask VERTEX=plain|extended
#version 460
#ifdef ALPHA_MASK
#include "passes/mesh_vertex.glsl"
#else
#include "passes/mesh_position.glsl"
#endif
#include "passes/shadow_maps_params.glsl"

// Clip space of each map, depth reversed: in a buffer, because maps of a light that moves are drawn from another place in each
// run.
layout(std430, set = 0, binding = 9) readonly buffer ShadowMapViews { mat4 clip_from_world[]; };

void main() {
#ifdef ALPHA_MASK
    vec4 position_ws = write_attributes();
#else
    vec4 position_ws = vertex_position_ws();
#endif
    gl_Position = clip_from_world[params.layer] * position_ws;
}
