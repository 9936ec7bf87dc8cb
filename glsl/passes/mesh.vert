// Vertex stage that every pass over the scene's triangles shares. Draws: src/passes/mesh.rs.
// portable: yes
// variants: VERTEX=plain|extended
#version 460
#include "passes/mesh_vertex.glsl"

void main() {
    write_vertex();
}
