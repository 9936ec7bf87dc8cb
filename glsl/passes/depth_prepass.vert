// Vertices of opaque surfaces in the depth pre-pass. Pass: src/passes/depth_prepass.rs.
// portable: yes
#version 460
#include "passes/mesh_position.glsl"

void main() {
    gl_Position = frame.clip_from_world * vertex_position_ws();
}
