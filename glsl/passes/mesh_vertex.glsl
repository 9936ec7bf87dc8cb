// A vertex of the scene, and what fragments get of it. Vertex stages only; the including shader has the axis VERTEX.
#ifndef PASSES_MESH_VERTEX_GLSL
#define PASSES_MESH_VERTEX_GLSL

#include "passes/mesh_position.glsl"

layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 tangent;
layout(location = 3) in vec2 uv;
#ifdef VERTEX_EXTENDED
layout(location = 4) in vec4 color;
layout(location = 5) in vec2 uv_1;
#endif

// xyz: place in the world; w: 1, by which shading/material.glsl sees how a driver has interpolated.
layout(location = 0) out vec4 out_position_ws;
layout(location = 1) out vec3 out_normal_ws;
layout(location = 2) out vec4 out_tangent_ws;
layout(location = 3) out vec2 out_uv;
// x: material; y: object id times 256 plus normal group (Kircher 2009, section 3.1).
layout(location = 4) flat out uvec2 out_ids;
#ifdef VERTEX_EXTENDED
layout(location = 5) out vec4 out_color;
layout(location = 6) out vec2 out_uv_1;
#endif

// All but the place in the picture. Returns the place in the world.
vec4 write_attributes() {
    DrawBlock draw = draws[gl_InstanceIndex];
    vec4 position_ws = vertex_position_ws();
    out_position_ws = vec4(position_ws.xyz, 1.0);
    out_normal_ws = draw.normal_x.xyz * normal.x + draw.normal_y.xyz * normal.y + draw.normal_z.xyz * normal.z;
    // w carries the normal group's id too.
    out_tangent_ws = vec4(mat3(draw.world_from_object) * tangent.xyz, sign(tangent.w));
    out_uv = uv;
    out_ids = uvec2(draw.material, draw.object_id << 8 | normal_group(tangent));
#ifdef VERTEX_EXTENDED
    out_color = color;
    out_uv_1 = uv_1;
#endif
    return position_ws;
}

void write_vertex() {
    gl_Position = frame.clip_from_world * write_attributes();
}

#endif
